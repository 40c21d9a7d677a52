// SPDX-License-Identifier: GPL-3.0-or-later
// Schemas of the environment records, and the bodies of furniture. Metres; bodies are in the frame
// of the room.
//
//     const Schemas schemas(environmentSchemas());
//     const PlacementFrame desk = standingOf(record);
//     const double floor = signedArea(desk.rectangle());  // m2
#pragma once

#include <vector>

#include "env/body.h"
#include "geom/pose.h"
#include "record/schema.h"

namespace ispace {

/// Frame and extents of a record that has `at`, `heading`, `size` and perhaps `height`.
struct PlacementFrame {
    Pose2 world_from_body;
    double length = 0, width = 0;
    double bottom = 0, top = 0;

    [[nodiscard]] double height() const { return top - bottom; }
    /// Returns the rectangle between two corners given in the body's frame, `low` left-below of
    /// `high`.
    [[nodiscard]] Polygon box(Point2 low, Point2 high) const;
    [[nodiscard]] Polygon rectangle() const;
    /// Returns the ellipse in the rectangle, scaled by `share` about the centre.
    [[nodiscard]] Ellipse ellipse(double share = 1) const;
};

/// Reads the frame of a record. One number in `size` stands for length and width. The height is the
/// third number of `size`, else `height`, else the length.
PlacementFrame standingOf(const Record& record);

/// Returns true if `at` and `heading` only move the record's body: furniture, pillars and floors;
/// not walls, and not meshes, which have a separate frame.
bool standsByItself(const Record& record);

Body tableBody(const Record& record);
Body deskBody(const Record& record);
Body chairBody(const Record& record);
Body infraBody(const Record& record);
Body boxesBody(const Record& record);
Body screenBody(const Record& record);

/// Default height of walls and fences, in metres.
constexpr double kWallHeight = 2.5;

/// Creates the key `tag` of records that carry a tag for sensors.
KeySpec tagKey();

/// Returns the schemas of ispace, inside, zone, floor, wall, fence, pillar, table, desk, chair,
/// barrier, cube, cylinder and the other elements.
std::vector<Schema> environmentSchemas();

}  // namespace ispace
