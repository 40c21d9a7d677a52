// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/coverage: the area where a smooth function of a plane is at least 0.
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
