// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts outlines of views along a box: the parts within a room and those beyond.
#pragma once

#include <span>
#include <vector>

#include "geom/curve.h"

namespace ispace {

/// Curves cut along the sides of a box.
struct CutCurves {
    std::vector<Curve> inside, outside;
};

/// Cuts closed curves (outlines and holes, with the area on their left) along the sides of a box:
/// one side after another (I. E. Sutherland, G. W. Hodgman, Reentrant polygon clipping, 1974), arcs
/// in closed form. Cut points lie exactly on the sides, rounded along them. Parts of one curve may
/// be joined by edges that run along a side in both directions: their areas cancel out in
/// signedArea() and in an overlay. Curves within the box are returned unchanged. The areas inside
/// and outside add up to the whole, up to rounding. O(n)
///
///     const CutCurves cut = cutAlong(view, {{0, 0}, {8, 5}});
///     const double in_room = signedArea(cut.inside);
CutCurves cutAlong(std::span<const Curve> curves, const Box2& box);

}  // namespace ispace
