// SPDX-License-Identifier: GPL-3.0-or-later
// The rooms that walls enclose: chosen among the faces of the plan by points that records give, by
// the origin, or by size. An error names the gap that keeps a room open, and its two walls.
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

/// Finds the indoor region among the faces of the wall lines; faces joined by open doors count as
/// one.
///
/// With `inside` records, returns the faces that contain their points; without, the face that
/// contains the origin strictly inside, else the largest. Without a record, a face within other
/// wall lines that would enclose it but for a gap is rejected, and the gap is the error (e.g. a
/// closed pillar in a room that leaks). If any face exists, only gaps of at most half the plan's
/// shorter side count as leaks.
/// O(n) for each inside point; the search for a gap finds faces up to 16 times, see findGap().
/// \throws FormatError if there is no such face: a gap in the lines, or an inside point on a
///         wall or outside of all faces
Enclosure enclose(const WallPlan& plan, std::span<const Region> faces, const Box2& limits,
                  std::span<const Element> elements, std::span<const Record* const> inside);

}  // namespace ispace
