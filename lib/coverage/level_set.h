// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/coverage: the area where a smooth function of a plane is at least 0.
#pragma once

#include <functional>
#include <vector>

#include "geom/curve.h"
#include "geom/point.h"

namespace ispace {

/// Returns a corner of the side - 1 by side - 1 cells of a box.
Point2 levelPlace(const Box2& box, int side, int column, int row);

/// Traces the area in a box where `value` is 0 or more, with the area on the left of the curves:
/// arcs between points of its boundary, within kConicError of it. Within a quarter of a cell of the
/// box's border the area ends. Pieces and holes that lie between all samples are not found.
/// \param samples of `value` at levelPlace(), row by row, as many rows as columns
std::vector<Curve> levelSet(const std::function<double(Point2)>& value, const Box2& box,
                            std::vector<double> samples);
/// Likewise from `side` x `side` samples.
std::vector<Curve> levelSet(const std::function<double(Point2)>& value, const Box2& box,
                            int side = 128);

}  // namespace ispace
