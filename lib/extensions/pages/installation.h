// SPDX-License-Identifier: GPL-3.0-or-later
// The sheet of the installer: positions of sensors, a plan with distances, and pictures.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.h"
#include "coverage/coverage.h"
#include "extensions/pages/cables.h"
#include "extensions/pages/wall_distance.h"
#include "report/page.h"
#include "scene/scene.h"

namespace ispace::pages {

/// Returns the name of a sensor's device, or the keyword of a bare one.
std::string deviceText(const Sensor& sensor);

/// Returns a row for each sensor: id, device, position, height, directions, field of view,
/// distances to walls, its cable if there are panels, zones to be seen.
PageTable installationTable(const Scene& scene, const Coverage& coverage,
                            const std::vector<Installation>& installations,
                            const std::vector<Cable>& cables);

/// Lists the ends of the faces from which the measures count, each face once.
PageTable wallFacesTable(const std::vector<Installation>& installations);

/// Draws a plan in millimetres, at the largest usual scale that fits on A4, with the distances to
/// walls, and each sensor in its colour.
PageFigure installationPlan(const Scene& scene, const Coverage& coverage,
                            const std::vector<Installation>& installations);

/// Returns the pixels a metre of a camera at a point, see LensResolution; 0 behind a pinhole.
double lensDensity(const Sensor& sensor, Point3 place);

/// Draws the picture that a camera takes, or the floor that another sensor sees, for each sensor
/// that stands still.
/// \param progress advances by one for each sensor; may be null
std::vector<PageFigure> sensorPictures(const Scene& scene, const Coverage& coverage,
                                       Progress* progress = nullptr);

/// Draws the floor that a sensor sees. \param index in Coverage::sensors
PageFigure floorFigure(const Scene& scene, const Coverage& coverage, std::size_t index);

/// Builds a section for each camera that stands still, on a new sheet: its row of the
/// installation, one value a row, the zones that it sees, its picture and the floor that it sees.
/// \param installation as installationTable() returns it \param pictures as of sensorPictures(), of
/// which those of cameras are taken out
std::vector<PageSection> cameraSheets(const Scene& scene, const Coverage& coverage,
                                      const PageTable& installation,
                                      std::vector<PageFigure>& pictures);

}  // namespace ispace::pages
