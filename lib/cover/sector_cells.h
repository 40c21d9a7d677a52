// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cover/slice_sight.h"
#include "raster/grid.h"

namespace ispace {

/// Cells next to each other, in the order of the grid: first, first + 1, ..., end - 1. A run may
/// go on from the end of a row to the beginning of the next.
struct CellRun {
    std::uint32_t first = 0, end = 0;
    friend bool operator==(const CellRun&, const CellRun&) = default;
};

/// Cells in parts, each part a list of disjoint runs, ascending.
struct CellParts {
    std::vector<CellRun> runs;
    std::vector<std::uint32_t> first;  ///< part k: runs [first[k], first[k + 1])

    [[nodiscard]] std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
};

/// The runs of a set, one part. O(cells / 64 + runs)
CellParts partOf(const CellSet& cells);

/// Sets `parts` to what a level sensor sees from a place up to max_range, if it may face anywhere,
/// in cells by their direction, which is directionOf() to the bit. Part i holds cells in directions
/// from limits[i] counter-clockwise to before limits[i + 1] (the last one: to before limits[0]),
/// and one more part, limits.size(), the cell whose centre is the place, if there is one: it is in
/// every direction. A fan whose fanArc() goes from limits[i] to limits[j] then sees parts i to j -
/// 1 (around the end of the list where j < i) and that one: the same cells as cellsSeen(), always.
/// Without limits that part is all that is seen.
///
/// The memory of `parts` is used again. O(look + rows * limits + runs), mostly no arc tangent.
/// \pre limits are in (-180, 180] degrees, ascending, all different
void cellsBySector(const Grid& grid, const SliceSight& sight, Point2 place, double max_range,
                   std::span<const Angle> limits, CellParts& parts);

}  // namespace ispace
