// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>

#include "solve/search.h"

namespace ispace {

struct LagrangeLimits {
    /// Only what is worth more than this matters: the bound need not be lower. Something that is
    /// worth this need not exist.
    std::uint64_t cut = 0;
    double gap = 0;   ///< ends where the bound is within that of the cut
    int rounds = 24;  ///< at most, in which all candidates are looked at
};

/// boundByLagrange() with limits. \param near multipliers start from those that suit these choices
Bound boundWithin(const Problem& problem, const std::vector<Choice>& near,
                  const LagrangeLimits& limits, Progress& progress);

}  // namespace ispace
