// SPDX-License-Identifier: GPL-3.0-or-later
// What tests compare faces and differences with: an arrangement of CGAL, in exact numbers, rounded
// to doubles at the end. Its code is in arrangement_cgal_test.cc.
#pragma once

#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace::test {

/// What boundedFaces() finds.
std::vector<Region> exactFaces(std::span<const Segment2> lines,
                               std::span<const Segment2> passages = {});

/// The open connected pieces where the winding number of `added` is positive and that of `removed`
/// is zero.
std::vector<Region> exactDifference(std::span<const Segment2> added,
                                    std::span<const Segment2> removed);

}  // namespace ispace::test
