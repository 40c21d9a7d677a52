// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// Square cells over a part of the floor; column 0 is the left one, row 0 the bottom row.
struct CellFrame {
    Point2 origin;    ///< lower left corner of cell (0, 0)
    double size = 1;  ///< metres a cell
    int columns = 0, rows = 0;

    /// A place in cells; whole numbers are the middles of cells.
    [[nodiscard]] Point2 toCells(Point2 p) const {
        return {(p.x - origin.x) / size - 0.5, (p.y - origin.y) / size - 0.5};
    }
};

/// A run of cells of one row, ends included.
struct CellRun {
    int row = 0, first = 0, last = 0;
    friend bool operator==(const CellRun&, const CellRun&) = default;
};

/// The runs of cells whose middles lie inside the curves by the even-odd rule, by ascending rows;
/// cells outside the frame are left out. A middle on a curve itself may be in or out.
/// O(edges log edges + crossings of edges and rows); memory O(edges) besides the runs.
std::vector<CellRun> insideRuns(std::span<const Polygon> curves, const CellFrame& frame);

/// Two cells above each other or side by side; may lie outside the frame.
struct CellPair {
    std::int64_t near_column = 0, near_row = 0;
    std::int64_t far_column = 0, far_row = 0;
    friend bool operator==(const CellPair&, const CellPair&) = default;
};

/// The pairs of neighbours with the closed segment between their middles, the cell in which it
/// passes there first; a middle on the segment makes a pair of that cell with itself. Only those
/// with a column, or a row, of the frame. O(columns + rows along the segment).
void appendCrossings(const Segment2& segment, const CellFrame& frame, std::vector<CellPair>& pairs);

}  // namespace ispace
