// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange/search: bounds of the weight that any candidate of a site sees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "arrange/search/problem.h"

namespace ispace {

/// Bounds the weight that the candidates of each site see by blocks of cells: in a block, a
/// candidate sees at most the weight of the block, and at most that of all cells that its site sees
/// there. Takes a few operations a block and a site, a fraction of CandidateSet::weighSite() for
/// each, since most blocks of a nearly covered room have no weight left. Bounds are never too low:
/// the views of sites are rounded up. bound() is thread-safe.
class SiteBlocks {
  public:
    /// Blocks are those of the problem, joined in pairs until the table takes at most kMaxBytes.
    /// O(blocks * sites + runs)
    /// \param candidates of a kind of the problem
    SiteBlocks(const Problem& problem, const CandidateSet& candidates);

    /// Computes an upper bound for each site.
    /// \param gains by cell, at most the weights of the problem \param bounds one for each site
    void bound(std::span<const std::uint32_t> gains, std::span<std::uint32_t> bounds) const;

    static constexpr std::size_t kMaxBytes = std::size_t{32} << 20U;

  private:
    void addViews(const Problem& problem, const CandidateSet& candidates);

    std::size_t sites_, blocks_ = 0;
    std::vector<std::uint32_t> block_of_;  ///< by cell
    unsigned shift_ = 0;                   ///< seen_ holds weights over 2^shift_, rounded up
    std::vector<std::int16_t> seen_;       ///< by block, by site
};

}  // namespace ispace
