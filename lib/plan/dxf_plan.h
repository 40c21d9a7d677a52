// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "draw/dxf_writer.h"
#include "layout/scene.h"

namespace ispace {

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
