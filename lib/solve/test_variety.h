// SPDX-License-Identifier: GPL-3.0-or-later
// Small random problems of all sorts for the tests of bounds and searches.
#pragma once

#include "solve/test_problems.h"

namespace ispace {

/// Round 0, 1, 2, ... goes through what problems can have, in all sorts of combinations.
inline RandomProblemOptions variedOptions(std::uint64_t round) {
    RandomProblemOptions options;
    options.columns = 9;
    options.rows = 7;
    options.max_range = 4;
    options.kinds = round % 3 == 2 ? 2 : 1;
    options.sites = options.kinds == 2 ? 3 : 6;
    options.most = options.kinds == 2 ? 2 : 3;
    options.headings = options.kinds == 2 ? 3 : 4;
    options.max_weight = round % 5 == 4 ? 9 : 1;
    options.demand = round % 4 == 3 ? 2 : 1;
    options.max_met = round % 4 >= 2 ? 1 : 0;
    if (round % 8 == 7) {
        options.demand = 8;
        options.max_met = 6;
        options.shares = options.kinds == 2 ? std::vector<int>{4, 1} : std::vector<int>{4};
    }
    options.has_costs = round % 6 == 5;
    options.has_standing = round % 10 == 9;
    return options;
}

inline RandomProblem variedProblem(std::uint64_t round) {
    return randomProblem(1000 + round, variedOptions(round));
}

}  // namespace ispace
