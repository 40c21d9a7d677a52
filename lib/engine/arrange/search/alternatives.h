// SPDX-License-Identifier: GPL-3.0-or-later
// Further layouts beside the best one, for people to choose from.
//
//     const NearChoices same = [](const Choice& a, const Choice& b) { return a == b; };
//     const auto others = alternativesTo(problem, result.best, same, 3, options, progress);
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "arrange/search/problem.h"
#include "arrange/search/search.h"
#include "base/error.h"

namespace ispace {

/// Returns true for choices that count as the same sensor; symmetric, and true for equal choices.
using NearChoices = std::function<bool(const Choice&, const Choice&)>;

/// Returns true if one of these sensors has no sensor near it in the other solution.
bool differs(const Solution& solution, const Solution& other, const NearChoices& are_near);

/// Finds up to `count` further solutions, the best first: each differs from `best` and from those
/// before it, which differ from it in a sensor of theirs.
///
/// Splits the solutions as E. L. Lawler does for the K best (A procedure for computing the K best
/// solutions to discrete optimization problems, 1972): one differs from another if, for some
/// sensor of that, it has none near it, so a search without the candidates near each sensor in turn
/// finds the best that differs, and each solution found is split further. With Optimizer::Exact no
/// solution that differs from all before has a larger value, unless a kind has no candidate left
/// in a part of the split, which is skipped. Runs one search for each sensor of each solution, and
/// again where a solution repeats an earlier one. Returns those found if progress says stop.
/// Deterministic for any number of threads otherwise.
std::vector<Solution> alternativesTo(const Problem& problem, const Solution& best,
                                     const NearChoices& are_near, std::size_t count,
                                     const SearchOptions& options, Progress& progress);

}  // namespace ispace
