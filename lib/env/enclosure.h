// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "env/environment.h"
#include "env/walls.h"

namespace ispace {

/// The region that the wall lines enclose.
struct Enclosure {
    Regions indoor;
    Point2 inside;
};

/// Finds the indoor region among the faces of the wall lines, those that open doors join being one.
///
/// With `inside` records it is the faces that hold their points; without, the face that
/// holds the origin strictly inside, else the largest. A face that lies within other wall lines
/// which would enclose it but for a gap is not taken without a record: the gap is the error (as
/// with a closed pillar in a room that leaks). Where something is enclosed, only gaps of at most
/// half the plan's shorter side count as such.
/// \throws FormatError where there is no such face: a gap in the lines, or a point out of place
Enclosure enclose(const WallPlan& plan, std::span<const Region> faces, const Box2& limits,
                  std::span<const Element> elements, std::span<const Record* const> inside);

}  // namespace ispace
