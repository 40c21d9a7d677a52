// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms, and the floor that sensors cover, drawn as DXF.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "extensions/cad/dxf_writer.h"
#include "io/exporters.h"
#include "report/coverage_formats.h"
#include "scene/scene.h"

namespace ispace::cad {

/// Returns the layers of a room: walls, doors, windows, objects, inside.
std::vector<DxfLayer> dxfRoomLayers();
/// Draws the room: the mid-lines of walls as polylines as wide as the walls are thick, doors and
/// windows as lines on them, shut doors 4 cm wide, with their depth through the wall as extended
/// data, and the outline of each solid part of a thing, all with elevation and thickness; circles
/// about inside points. readDxf() reads these layers and builds the same room.
void addRoomToDxf(DxfWriter& out, const Environment& environment);

/// Returns the layers of placed records: sensors, robots.
std::vector<DxfLayer> dxfPlacedLayers();
/// Draws the mark of a sensor: a circle, a line along its heading, its id.
void addSensorToDxf(DxfWriter& out, const std::string& id, const Pose3& pose);

/// Writes the plan as DXF in metres: room and placed records, zones, floor coverings, names, and
/// the fields of view of sensors as sectors, out to their range but at most the plan's width, each
/// on a separate layer. With a height writes only the obstacle map there: free floor and obstacles.
std::string writeDxf(const Scene& scene, std::optional<double> slice_height);

/// Writes the plan as DXF in metres: walls, doors, windows and objects, sensors, their views
/// ("views", closed polylines with true arcs), and solid fillings of the indoor floor seen by
/// exactly 1, 2, ... sensors ("seen-1", ...) and of the unseen floor ("unseen"), each on a separate
/// layer. In fillings, polygons of the same area replace arcs.
std::string coverageDxf(const Scene& scene, const Coverage& coverage);

/// Adds DXF to the formats of rooms and of coverage.
void addDxfFormats();

}  // namespace ispace::cad
