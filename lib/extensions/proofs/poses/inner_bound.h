// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: the points that every pose of a box sees.
#pragma once

#include <cstdint>
#include <vector>

#include "extensions/proofs/poses/outer_bound.h"

namespace ispace::proofs::poses {

/// Computes parts of cells that every pose of the box on the floor sees, rounded down: those seen
/// from all of the rectangle through the same portals of the triangulation, within range of all its
/// corners and in the field of view at all headings. Empty: none, or the rectangle meets more than
/// a few triangles.
std::vector<std::uint8_t> innerBoundOf(const PoseFloor& floor, const Sector& sector,
                                       const PoseBox& box);

}  // namespace ispace::proofs::poses
