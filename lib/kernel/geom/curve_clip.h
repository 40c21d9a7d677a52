// SPDX-License-Identifier: GPL-3.0-or-later
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
/// one side after another (Sutherland and Hodgman, 1974), arcs in closed form. Cut points lie
/// exactly on the sides. Parts of one curve may be joined by edges that run along a side in both
/// directions: their areas cancel out in signedArea() and in an overlay. Curves within the box are
/// returned unchanged. O(n)
CutCurves cutAlong(std::span<const Curve> curves, const Box2& box);

}  // namespace ispace
