// SPDX-License-Identifier: GPL-3.0-or-later
// Lets views leave out cells that no figure counts, such as those outside of the rooms: fewer rays,
// and fewer runs to store.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/cell_set.h"

namespace ispace {

/// The cells of a grid that count: views hold those of them that they see, and arbitrary others.
///
/// Runs may span gaps between counted cells, so that views take fewer of them, and cells that do
/// not count need no ray. Any figure must be taken over counted cells alone. Eight bytes a cell;
/// O(cells) to build, next() O(1); const members are thread-safe.
///
///     const CountedCells counted(target.indoor);
///     cellsByView(grid, mesh, views, height, parts, {.counted = &counted});
///
/// \pre fewer than 2^32 - 1 cells
class CountedCells {
  public:
    /// The set may change afterwards.
    explicit CountedCells(const CellSet& cells) : next_(cells.size() + 1), end_(cells.size() + 1) {
        const auto size = static_cast<std::uint32_t>(cells.size());
        next_[size] = size;
        for (std::uint32_t i = size; i-- > 0;) next_[i] = cells.test(i) ? i : next_[i + 1];
        end_[0] = 0;
        for (std::uint32_t i = 0; i < size; ++i) end_[i + 1] = cells.test(i) ? i + 1 : end_[i];
    }
    /// Returns the first counted cell from this one on; the number of all cells if there is none.
    [[nodiscard]] std::uint32_t next(std::uint32_t cell) const { return next_[cell]; }
    /// Clips all runs so that they begin and end with counted cells; runs without any are removed.
    /// In place, O(runs).
    void keepIn(CellParts& parts) const {
        std::uint32_t count = 0, begin = 0;
        for (std::size_t part = 0; part < parts.size(); ++part) {
            const std::uint32_t end = parts.first[part + 1];
            for (std::uint32_t i = begin; i < end; ++i) {
                const CellRun run{next_[parts.runs[i].first], end_[parts.runs[i].end]};
                if (run.first < run.end) parts.runs[count++] = run;
            }
            begin = end;
            parts.first[part + 1] = count;
        }
        parts.runs.resize(count);
    }

  private:
    std::vector<std::uint32_t> next_;  // [i]: the first counted cell from i on
    std::vector<std::uint32_t> end_;   // [i]: the end of the last counted cell before i
};

}  // namespace ispace
