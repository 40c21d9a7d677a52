// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json_writer.h"
#include "drawing/dxf_writer.h"
#include "scene/scene.h"

namespace ispace {

/// The fixed part of a plan (floor, zones, things, walls, openings, what hangs from the ceiling) as
/// a JSON object for programs that draw it themselves, at any size:
///
///     {"box":[x0,y0,x1,y1],"layers":[{"name","groups":[{"id","title","shapes":[SHAPE…]}…]}…]}
///
/// Shapes in the order of drawing have one of `area` (closed curves, even-odd rule), `lines` (open
/// curves) and `arc` ([x, y, radius, from, to], degrees), then `inks`: {"fill"} or {"line","width"}
/// with "dash" if it is not solid. A curve is [x,y,x,y,…] in metres to the millimetre; widths and
/// dashes are pixels; colours are CSS's. The page's edge cuts nothing, and hatches are left out.
/// Equal scenes give equal bytes. O(n log n).
void writePlan(JsonWriter& json, const Scene& scene);

/// The layers that a room is drawn on: walls, doors, windows, objects.
std::vector<DxfLayer> dxfRoomLayers();
/// Draws it: the mid-lines of walls as polylines as wide as the walls are thick, doors and windows
/// as lines on them, shut doors 4 cm wide, and the outline of each solid part of a thing; all with
/// elevation and thickness. readDxf() knows the layers and makes the same room of it.
void addRoomToDxf(DxfWriter& out, const Environment& environment);

/// The layers of what is placed: sensors, robots.
std::vector<DxfLayer> dxfPlacedLayers();
/// Draws a mark of a sensor: a circle, a line along its heading, its id.
void addSensorToDxf(DxfWriter& out, const std::string& id, const Pose3& pose);

/// The plan as DXF in metres: room and placed things, zones, floor coverings, names, and the fields
/// of view of sensors as sectors, out to their range but no farther than the plan is wide, each on
/// a layer of its own. With a height only what stands there: free floor and obstacles.
std::string writeDxf(const Scene& scene, std::optional<double> slice_height);

}  // namespace ispace
