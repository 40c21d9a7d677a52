// SPDX-License-Identifier: GPL-3.0-or-later
// Ways between two zones over the cells of a problem: shortest paths by two lengths, the seen one
// first (E. W. Dijkstra, A note on two problems in connexion with graphs, 1959). Lengths are whole
// numbers, so sums are exact and of equal ways the same is found on every machine. Const members
// are thread-safe.
//
//     const CellPath path = paths.leastSeen([&](std::uint32_t cell) { return seen.test(cell); });
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "arrange/search/worst_case.h"
#include "base/cell_set.h"

namespace ispace::goals {

/// A step from any cell to another one.
struct CellStep {
    std::int32_t to = 0;                ///< index of its end, less that of its begin
    std::uint32_t length = 0;           ///< of all pieces
    std::vector<PathCell> pieces = {};  ///< `cell` less that of its begin, modulo 2^32
};

/// The cells of a floor, from `first` to those of the next one, and the steps between them.
struct CellFloor {
    std::uint32_t first = 0;
    std::vector<CellStep> steps;
};

/// The ways between two zones over the cells of floors.
struct CellPaths final : CellWays {
    std::vector<CellFloor> floors;
    std::vector<std::uint32_t> open;  ///< by cell: bit k if step k of its floor may be taken
    CellSet from, to;
    /// Each joins floors: a way leads from any of its cells to any other one.
    std::vector<CellSet> passages;

    /// Cells of the zones and of passages do not count, and passages have no length. Dijkstra;
    /// O(cells log cells + passages * cells)
    /// \pre there is a way, and its length is below 2^32
    [[nodiscard]] CellPath leastSeen(
        const std::function<bool(std::uint32_t)>& is_seen) const override;
    /// Returns true if there is a way.
    [[nodiscard]] bool exist() const;

  private:
    struct Tree;
    [[nodiscard]] const CellFloor& floorOf(std::uint32_t cell) const;
    /// Returns the cells that do not count.
    [[nodiscard]] CellSet free() const;
    [[nodiscard]] Tree search(const std::function<bool(std::uint32_t)>& is_seen) const;
};

}  // namespace ispace::goals
