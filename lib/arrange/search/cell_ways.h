// SPDX-License-Identifier: GPL-3.0-or-later
// Ways over the cells of a problem.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/cell_set.h"

namespace ispace {

/// Length of a way in a cell.
struct WayCell {
    std::uint32_t cell = 0, length = 0;
};

/// A step from any cell to another one.
struct CellStep {
    std::int32_t to = 0;               ///< index of its end, less that of its begin
    std::uint32_t length = 0;          ///< of all pieces
    std::vector<WayCell> pieces = {};  ///< `cell` less that of its begin, modulo 2^32
};

/// A way, and the cells in which it counts.
struct CellWay {
    std::uint64_t seen = 0, length = 0;
    std::vector<WayCell> cells;  ///< ascending; without those of the zones
};

/// The ways between two zones over cells, with lengths in whole units.
struct CellWays {
    std::vector<CellStep> steps;
    std::vector<std::uint32_t> open;  ///< by cell: bit k if step k may be taken
    CellSet from, to;

    /// Finds a way of which the least length lies in cells that are seen; of these a shortest one.
    /// Cells of the zones do not count. Dijkstra; O(cells log cells)
    /// \pre there is a way, and its length is below 2^32
    [[nodiscard]] CellWay leastSeen(const std::function<bool(std::uint32_t)>& is_seen) const;
    /// Returns true if there is a way.
    [[nodiscard]] bool exist() const;

  private:
    struct Tree;
    [[nodiscard]] Tree search(const std::function<bool(std::uint32_t)>& is_seen) const;
};

}  // namespace ispace
