// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "io/plan_lines.h"

namespace ispace {

/// The paths with fewer points, and moved by no more than `tolerance` metres: between
/// joints by Douglas and Peucker. Joints stay: ends of open paths, points that several paths share,
/// both ends of a piece that another one meets, and those of the pieces in `fixed`. No path crosses
/// another, or itself, that did not before, and none changes sides; a closed path keeps three
/// corners. \param fixed indices of pieces as in piecesOf
std::vector<PlanPath> simplifiedPaths(const std::vector<PlanPath>& paths, double tolerance,
                                      std::span<const std::size_t> fixed = {});

}  // namespace ispace
