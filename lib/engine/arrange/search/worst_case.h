// SPDX-License-Identifier: GPL-3.0-or-later
// Layouts that are best in the worst of several cases: blocks of cells, failures of sensors, ways
// over the cells. Each kind of case is a max-min problem, bounded by means of cases, for any
// weights of these.
//
//     const SearchResult result = searchWorstCase(cases, options, progress);
//     const CaseValue worst = worstCase(cases, result.best.chosen);  // worst.value == best.value
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "arrange/search/problem.h"
#include "arrange/search/search.h"
#include "base/cell_set.h"
#include "base/error.h"

namespace ispace {

/// Consecutive cells of a problem.
struct CellBlock {
    std::size_t first = 0, end = 0;
};

/// Length of a way in a cell.
struct PathCell {
    std::uint32_t cell = 0, length = 0;
};

/// A way, and the cells in which it counts.
struct CellPath {
    std::uint64_t seen = 0, length = 0;
    std::vector<PathCell> cells;  ///< ascending
};

/// Ways over the cells of a problem, with lengths in whole units. Const members are thread-safe.
class CellWays {
  public:
    virtual ~CellWays() = default;
    /// Finds a way of which the least length lies in cells that are seen; of these a shortest one.
    [[nodiscard]] virtual CellPath leastSeen(
        const std::function<bool(std::uint32_t)>& is_seen) const = 0;

  protected:
    CellWays() = default;
    CellWays(const CellWays&) = default;
    CellWays& operator=(const CellWays&) = default;
};

/// A problem whose cells hold several cases. A layout has a value in each of them, and the least
/// counts.
///
/// With failures = 0 each block is a case.
/// With failures = K there is one block, and each set of K sensors that may fail, standing ones
/// included, is a case. Then one sensor covers a cell of the block, and `problem` is that of
/// failureProblem(), with copy 1 as the block.
///
/// With ways there is one block, and each way is a case: its value is the length that covered cells
/// hold.
struct WorstCaseProblem {
    const Problem* problem = nullptr;
    std::vector<CellBlock> blocks;
    int failures = 0;
    std::vector<CellSet> standing = {};  ///< with failures: cells of each standing sensor
    std::uint64_t least_total = 0;       ///< with failures: see FailureProblem
    const CellWays* ways = nullptr;
    std::uint64_t shortest = 0;  ///< with ways: the least seen way if all cells are covered

    /// Returns the weight of a block; with ways the length of the shortest one.
    [[nodiscard]] std::uint64_t totalOf(std::size_t block) const;
};

/// A problem whose value stands for the mean over failures.
struct FailureProblem {
    Problem problem;
    /// Value / least_total is at least the mean share over all failures; equal, and least_total the
    /// total weight, unless binomials are too large for weights.
    std::uint64_t least_total = 0;
};

/// Multiplies the cells of a plain problem (one sensor covers a cell), so that its value is
/// proportional to the mean over the failures of any K of n sensors. Copy m = 1 ... K + 1 of a cell
/// is covered by m sensors. A cell that m sensors see survives with the probability 1 - C(n - m, K
/// - m) / C(n, K), which grows by C(n - m, K - m + 1) / C(n, K) from m - 1 to m: the weights of the
/// copies. Candidates are those of cells * (K + 1) cells: copy m of cell i is (m - 1) * cells + i.
/// \param seen number of standing sensors that see each cell
/// \pre 0 <= failures < sensors; weights below 2^25 in sum
FailureProblem failureProblem(const Problem& plain, const std::vector<std::uint16_t>& seen,
                              std::size_t sensors, std::size_t failures);

/// The value of one case, in units of the first block: v * totalOf(0) / totalOf(block), rounded
/// down.
struct CaseValue {
    std::size_t block = 0;
    std::vector<std::size_t> failed = {};  ///< standing sensors first, then the chosen ones
    std::uint64_t value = 0;
    std::vector<PathCell> way = {};  ///< with ways: its cells
};

/// Cells of a problem that a placed sensor sees.
struct SensorCells {
    const CellSet* cells = nullptr;
    int multiplicity = 1;
};

/// Returns the case with the least value, the first among equals. Repeated choices count once. With
/// failures at least as many as there are sensors, all fail.
CaseValue worstCase(const WorstCaseProblem& of, const std::vector<Choice>& chosen);

/// Searches for the layout whose worst case is best; values and bound are those of worstCase().
///
/// Blocks: the worst case is at most any weighted mean of the cases, so a search() for a mean
/// bounds it, and its solution is a start. The weights of the cases follow by multiplicative
/// updates towards those in which the solutions found are poor (Freund and Schapire, Adaptive game
/// playing using multiplicative weights, 1999). Failures: the mean over all failures is a bound,
/// and so is the plain value of the best layout of as many sensors less. Starts are improved by
/// moves of single sensors, which a few of the worst cases choose and all cases judge. Exact goes
/// on with a depth-first tree: an upper bound of a node adds to each of these means the largest
/// gains of as many candidates as are left; it ends with value == bound unless it is stopped.
///
/// Ways: any mean of the seen lengths of some ways bounds the least. The first ones avoid the cells
/// of those before, as far as they can; each further one is the least seen way in the layout found
/// for the mean of the ways so far (Brown, Iterative solution of games by fictitious play, 1951).
///
/// \pre no budget, and no connection is required
SearchResult searchWorstCase(const WorstCaseProblem& of, const SearchOptions& options,
                             Progress& progress);

}  // namespace ispace
