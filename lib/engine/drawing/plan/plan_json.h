// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json_writer.h"
#include "drawing/dxf_writer.h"
#include "scene/scene.h"

namespace ispace {

/// Writes the fixed part of a plan (floor, zones, things, walls, openings, overhead things) as a
/// JSON object for programs that draw it themselves, at any size:
///
///     {"box":[x0,y0,x1,y1],"layers":[{"name","groups":[{"id","title","shapes":[SHAPE…]}…]}…]}
///
/// Shapes in drawing order have one of `area` (closed curves, even-odd rule), `lines` (open curves)
/// and `arc` ([x, y, radius, from, to], degrees), then `inks`: {"fill"} or {"line","width"} with
/// "dash" if it is not solid. A curve is [x,y,x,y,…] in metres to the millimetre; widths and dashes
/// are in pixels; colours are CSS's. Shapes are not clipped to the page, and hatches are skipped.
/// Equal scenes give equal bytes. O(n log n).
void writePlan(JsonWriter& json, const Scene& scene);

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

}  // namespace ispace
