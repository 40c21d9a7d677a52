// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/parity.h"

#include "geom/predicates.h"

namespace ispace {

namespace {

/// Which side of line a-b the point lies on; on the line counts as left.
bool isLeft(const Segment2& line, Point2 p) {
    return orientation(line.a, line.b, p) != Turn::Right;
}

bool crosses(const Segment2& path, const Segment2& wall) {
    return isLeft(path, wall.a) != isLeft(path, wall.b) &&
           isLeft(wall, path.a) != isLeft(wall, path.b);
}

}  // namespace

bool insideByParity(Point2 p, Point2 known_inside, std::span<const Segment2> walls) {
    const Segment2 path{p, known_inside};
    bool inside = true;
    for (const Segment2& wall : walls) {
        if (crosses(path, wall)) inside = !inside;
    }
    return inside;
}

}  // namespace ispace
