// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The closed curves with fewer vertices: none moves by more than `tolerance` metres, no two
/// curves that were apart meet or cross, and none is lost (Polyline_simplification_2 of CGAL).
/// Vertices where curves touch stay, and those of `kept`. Result i belongs to curve i.
std::vector<Polygon> simplified(const std::vector<Polygon>& curves, double tolerance,
                                std::vector<Point2> kept = {});

}  // namespace ispace
