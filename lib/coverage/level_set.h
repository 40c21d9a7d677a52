// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/coverage: the area where a smooth function of a plane is at least 0.
#pragma once

#include <functional>
#include <vector>

#include "geom/curve.h"
#include "geom/point.h"

namespace ispace {

/// Samples a level set along each side of its box.
constexpr int kLevelSamples = 128;

/// Traces the area in a box where `value` is 0 or more, with the area on the left of the curves:
/// arcs between points of its boundary, within kConicError of it. Pieces and holes that lie between
/// all of kLevelSamples x kLevelSamples samples are not found.
/// \pre `value` is negative on the border of the box
std::vector<Curve> levelSet(const std::function<double(Point2)>& value, const Box2& box);

}  // namespace ispace
