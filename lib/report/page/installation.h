// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "report/page/page.h"
#include "scene/scene.h"

namespace ispace {

/// The distance of a sensor from a wall, at right angles to it, seen from above.
struct WallDistance {
    std::string wall;  ///< id of the wall or fence
    double distance = 0;
    Point2 foot;  ///< on the wall's face
};

/// The measures by which a person mounts a sensor.
struct Installation {
    std::size_t sensor = 0;           ///< index in Scene::sensors
    std::vector<WallDistance> walls;  ///< the nearest, and the nearest at 45 degrees or more to it
};

/// Returns the name of a sensor's device, or the keyword of a bare one.
std::string deviceText(const Sensor& sensor);

/// Finds the measures of all sensors that stand still, in the order of the scene. Walls count at
/// the height of the sensor, or below it if all end there, if no other wall hides them from the
/// sensor. O(sensors * walls).
std::vector<Installation> installationsOf(const Scene& scene);

/// Returns a row for each sensor: id, device, position, height, directions, field of view,
/// distances to walls, zones to be seen.
PageTable installationTable(const Scene& scene, const Coverage& coverage,
                            const std::vector<Installation>& installations);

/// Counts devices, with their costs if records have them.
PageTable materialTable(const Scene& scene);

/// Draws a plan in millimetres, at the largest usual scale that fits on A4, with the distances to
/// walls.
PageFigure installationPlan(const Scene& scene, const std::vector<Installation>& installations);

/// Draws the picture that a camera takes, or the floor that another sensor sees, for each sensor
/// that stands still.
std::vector<PageFigure> sensorPictures(const Scene& scene, const Coverage& coverage);

}  // namespace ispace
