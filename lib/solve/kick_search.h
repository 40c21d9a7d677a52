// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <limits>

#include "base/progress.h"
#include "solve/problem.h"

namespace ispace {

struct KickOptions {
    std::uint64_t seed = 0;
    int rounds = 40;   ///< at most
    int patience = 4;  ///< it ends after so many rounds in a row that have gained nothing
    /// It ends once it reaches this value.
    std::uint64_t enough = std::numeric_limits<std::uint64_t>::max();
};

/// Goes on from a good solution: takes out a few sensors that see much of the same, puts others in,
/// and moves all to a local optimum, again and again (iterated local search; Lourenço, Martin &
/// Stützle 2003). Chains run side by side for a round of a dozen kicks each, from the best so far.
/// Never worse than `start`. The same for any number of threads unless progress says stop.
/// \pre start is feasible
Solution improveByKicks(const Problem& problem, const Solution& start, const KickOptions& options,
                        Progress& progress);

}  // namespace ispace
