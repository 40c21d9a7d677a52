// SPDX-License-Identifier: GPL-3.0-or-later
// The values of a layout in the cases of a WorstCaseProblem: whole numbers, exact in units of a
// block, and rounded down to those of the first. Failures are judged by the distinct sets of
// sensors that see floor, of which there are far fewer than cells.
//
//     const CaseValues values(of, solution.chosen);
//     const CaseValue worst = values.worst();
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "arrange/search/problem.h"
#include "arrange/search/worst_case.h"

namespace ispace {

/// Values of one layout in all cases.
class CaseValues {
  public:
    /// O(cells + cells that the sensors see)
    CaseValues(const WorstCaseProblem& of, const std::vector<Choice>& chosen);
    /// The same for sensors with these cells of the problem.
    CaseValues(const WorstCaseProblem& of, std::span<const SensorCells> sensors);

    [[nodiscard]] CaseValue worst() const;
    /// Returns the values of the blocks without failures, in units of the first block.
    [[nodiscard]] std::vector<std::uint64_t> ofBlocks() const;
    /// Returns the value in a case, in units of its block.
    [[nodiscard]] std::uint64_t valueIn(const CaseValue& of) const;
    /// Returns the worst case if this many of the sensors fail, instead of all failures.
    [[nodiscard]] CaseValue worstOf(std::size_t failures) const;
    /// Computes the gain of each cell if one more sensor of this kind sees it in this case; 0 in
    /// other blocks.
    void gains(const CaseValue& in, std::size_t kind, std::vector<std::uint32_t>& gains) const;
    /// Converts a value of a block to units of the first block, rounded down.
    [[nodiscard]] std::uint64_t scaled(std::size_t block, std::uint64_t value) const;

  private:
    /// Weight by the sensors that see it, ascending; floor that more sensors see than may fail is
    /// left out.
    using Shared = std::map<std::vector<std::uint32_t>, std::uint64_t>;
    [[nodiscard]] std::uint32_t required() const;
    void countStanding();
    void countBlocks();
    void collectShared();
    [[nodiscard]] std::vector<std::uint32_t> sensorsAt(std::size_t cell) const;
    [[nodiscard]] std::uint64_t lostWithout(const std::vector<std::size_t>& failed) const;

    const WorstCaseProblem* of_;
    std::vector<std::uint64_t> totals_;  // of the blocks
    std::vector<std::uint64_t> values_;  // of the blocks, without failures
    std::vector<std::uint32_t> counts_;  // multiplicity of each cell
    std::vector<CellSet> views_;         // with failures: of standing and chosen sensors
    Shared shared_;
};

}  // namespace ispace
