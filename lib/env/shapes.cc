// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "env/body.h"
#include "geom/pose.h"

namespace ispace {

namespace {

/// Chords of an ellipse with this longer half axis: a multiple of four, so that the ends of both
/// axes are vertices and the bounding box is that of the curve.
int chordCount(double half_axis) {
    // An ellipse cut at equal steps of its parameter is a regular polygon stretched, so its
    // chords stray at most as far as those of the circle about the longer axis.
    const double half_step = std::acos(std::max(0.0, 1 - kCurveTolerance / half_axis));
    const int quarter = static_cast<int>(std::ceil(std::numbers::pi / half_step / 4));
    return 4 * std::max(quarter, 2);
}

}  // namespace

Polygon ellipse(Point2 center, double length, double width, Angle heading) {
    const Pose2 world_from_body{center, heading};
    const int count = chordCount(std::max(length, width) / 2);
    Polygon polygon;
    polygon.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const Angle t = Angle::degrees(360.0 * i / count);
        polygon.push_back(world_from_body * Point2{length / 2 * cos(t), width / 2 * sin(t)});
    }
    return polygon;
}

Polygon rectangle(Point2 center, double length, double width, Angle heading) {
    const Pose2 world_from_body{center, heading};
    const double x = length / 2, y = width / 2;
    return {world_from_body * Point2{-x, -y}, world_from_body * Point2{x, -y},
            world_from_body * Point2{x, y}, world_from_body * Point2{-x, y}};
}

}  // namespace ispace
