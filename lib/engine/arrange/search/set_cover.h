// SPDX-License-Identifier: GPL-3.0-or-later
// Minimum-cost set cover with a proven bound: fewest sensors that see every cell.
//
//     SilentProgress progress;
//     const SetCover problem{3, {{0, 1}, {1, 2}, {0, 2}}, {1, 1, 1}};
//     const SetCoverResult result = minimumSetCover(problem, {}, progress);  // cost 2, bound 2
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/error.h"

namespace ispace {

/// Share of the floor that a cover of all of it may miss by rounding: the measure of
/// `--target 100%`.
constexpr double kMissedShare = 1e-9;

/// A set cover problem: choose columns of least total cost that cover every row.
struct SetCover {
    std::size_t rows = 0;
    std::vector<std::vector<std::uint32_t>> columns;  ///< rows of each, ascending, distinct
    std::vector<std::uint32_t> costs;                 ///< of each, positive; sum below 2^31
};

/// Effort of a set cover.
struct SetCoverOptions {
    std::uint64_t steps = 100'000;  ///< of local search, for each try
    int tries = 2;                  ///< of local search, in parallel
    bool proves = true;             ///< false: no branching, the bound is that of the root
};

struct SetCoverResult {
    std::vector<std::uint32_t> chosen;  ///< ascending
    std::uint64_t cost = 0;
    std::uint64_t bound = 0;    ///< no cover costs less
    bool is_coverable = false;  ///< false: some row is in no column, and no column is chosen
};

/// Finds a minimum-cost cover. Removes dominated rows and columns, and solves each component by
/// itself, here and in branches; improves a greedy cover by local search with weights of rows (C.
/// Gao, T. Weise, J. Li, An efficient local search heuristic with row weighting for the unicost set
/// covering problem, 2015); raises Lagrangian multipliers by subgradients, and excludes columns by
/// their reduced costs (J. E. Beasley, A Lagrangian heuristic for set-covering problems, 1990; A.
/// Caprara, M. Fischetti, P. Toth, A heuristic method for the set covering problem, 1999); adds
/// Chvatal-Gomory cuts; and branches on the columns of the shortest row. Multipliers are multiples
/// of 2^-20, so all sums of them are exact and bounds hold in spite of rounding. Deterministic for
/// any number of threads unless `progress` says stop; cost and bound are valid even then.
SetCoverResult minimumSetCover(const SetCover& problem, const SetCoverOptions& options,
                               Progress& progress);

}  // namespace ispace
