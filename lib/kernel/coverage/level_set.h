// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/coverage: the area where a smooth function of a plane is at least 0.
//
// Marching squares (the plane's case of W. E. Lorensen, H. E. Cline, Marching cubes, 1987) over a
// grid of samples; roots on the sides of cells by regula falsi in its Illinois variant (M. Dowell,
// P. Jarratt, A modified regula falsi method for computing the root of an equation, 1971), until
// they are known to 1e-10 m, or for 60 steps. Roots are joined by arcs, which are divided until
// points of the boundary at their quarters lie within kConicError, eight times at most. O(side^2)
// samples, with bounds those near the boundary alone.
//
//     const auto disc = levelSet([](Point2 p) { return 1 - dot(p - Point2(), p - Point2()); },
//                                {{-2, -2}, {2, 2}});
#pragma once

#include <functional>
#include <vector>

#include "geom/curve.h"
#include "geom/interval.h"
#include "geom/point.h"

namespace ispace {

/// Returns a corner of the side - 1 by side - 1 cells of a box.
Point2 levelPlace(const Box2& box, int side, int column, int row);

/// A smooth function of a plane.
struct LevelFunction {
    std::function<double(Point2)> value;
    /// Returns `value` at levelPlace(), for instance of a table.
    std::function<double(int column, int row)> sample;
    /// Returns bounds of `value` in a box.
    std::function<Interval(const Box2&)> bounds;
};

/// Traces the area in a box where `value` is 0 or more, with the area on the left of the curves:
/// arcs between points of its boundary, within kConicError of it. Within a quarter of a cell of the
/// box's border the area ends. Pieces and holes that lie between all of the `side` x `side` samples
/// are not found. Evaluates no samples where `bounds` has one sign.
std::vector<Curve> levelSet(const LevelFunction& function, const Box2& box, int side);
/// Likewise without bounds.
std::vector<Curve> levelSet(const std::function<double(Point2)>& value, const Box2& box,
                            int side = 128);

}  // namespace ispace
