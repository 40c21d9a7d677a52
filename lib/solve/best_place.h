// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "solve/candidate_set.h"

namespace ispace {

/// What a candidate adds: the first price in the upper half, the second, which decides among
/// equals, in the lower half.
using Score = std::uint64_t;

/// A candidate and what it adds.
struct BestPlace {
    std::size_t candidate = 0;
    Score score = 0;
    bool is_found = false;
};

/// By what candidates are compared.
struct PlacePrices {
    const CandidateSet* candidates = nullptr;
    const CellPrices* first = nullptr;
    const CellPrices* second = nullptr;  ///< may be missing
};

/// Finds the best candidate, lazily: sites in descending order of an upper bound, until no bound is
/// more than the best found (Minoux 1978). Keeps its memory from call to call; not thread-safe.
class PlaceFinder {
  public:
    /// The best candidate that `allows` accepts (missing: any), the first among equals.
    /// Once progress says stop, what is found first is taken.
    /// \param bounds per site, no first price of its candidates is more; those looked at get exact
    /// \param known a candidate to begin with, allowed, or none; with one the same is found earlier
    BestPlace find(const PlacePrices& prices, std::span<std::uint32_t> bounds,
                   const BestPlace& known, const std::function<bool(std::size_t)>& allows,
                   const Progress& progress);

  private:
    void lookAt(std::size_t site, const PlacePrices& prices, std::span<std::uint32_t> bounds,
                const std::function<bool(std::size_t)>& allows, BestPlace& best);

    std::vector<std::uint64_t> queue_;  // a heap: bound, and the complement of the site
    std::vector<std::uint32_t> values_, more_;
};

/// The most that a candidate of each site has of `values` (per candidate).
std::vector<std::uint32_t> mostOfSites(const CandidateSet& candidates,
                                       std::span<const std::uint32_t> values);

}  // namespace ispace
