// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of sites by blocks of cells: the weight seen of each block, as numbers of 16 bits in rows
// of sites, so that a bound of all sites is a sum of minima by vector instructions. Weights are
// shifted and rounded up; a cell in several parts of a site counts several times: bounds are never
// too low.
#include "arrange/search/site_blocks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "base/per_thread.h"
#include "base/simd.h"

namespace ispace {

namespace {

/// Consecutive cells in a block of a problem that names none.
constexpr std::uint32_t kCellsInBlock = 16;
constexpr std::size_t kMaxBlocks = std::size_t{1} << 16U;  // sums of seen_ fit into 32 bits
constexpr std::uint32_t kMaxSeen = std::numeric_limits<std::int16_t>::max();

std::uint32_t scaledUp(std::uint32_t weight, unsigned shift) {
    const std::uint64_t one = std::uint64_t{1} << shift;
    return static_cast<std::uint32_t>((weight + one - 1) >> shift);
}

}  // namespace

SiteBlocks::SiteBlocks(const Problem& problem, const CandidateSet& candidates)
    : sites_(candidates.sites()), block_of_(problem.blocks) {
    if (block_of_.size() != problem.cells()) {
        block_of_.resize(problem.cells());
        for (std::size_t cell = 0; cell < block_of_.size(); ++cell)
            block_of_[cell] = static_cast<std::uint32_t>(cell / kCellsInBlock);
    }
    if (block_of_.empty() || sites_ == 0) return;
    blocks_ = std::size_t{*std::max_element(block_of_.begin(), block_of_.end())} + 1;
    const std::size_t most =
        std::min(kMaxBlocks, std::max<std::size_t>(1, kMaxBytes / (sizeof(std::int16_t) * sites_)));
    unsigned halvings = 0;
    while (blocks_ > most) {
        blocks_ = (blocks_ + 1) / 2;
        ++halvings;
    }
    std::vector<std::uint32_t> weights(blocks_);
    for (std::size_t cell = 0; cell < block_of_.size(); ++cell)
        weights[block_of_[cell] >>= halvings] += problem.weights[cell];
    const std::uint32_t heaviest = *std::max_element(weights.begin(), weights.end());
    while (scaledUp(heaviest, shift_) > kMaxSeen) ++shift_;
    addViews(problem, candidates);
}

void SiteBlocks::addViews(const Problem& problem, const CandidateSet& candidates) {
    const std::size_t cells = block_of_.size();
    const WeightSums weights(problem.weights);
    std::vector<std::uint32_t> ends(cells);  // of the stretch of cells in one block
    for (std::size_t cell = cells; cell-- > 0;)
        ends[cell] = cell + 1 < cells && block_of_[cell + 1] == block_of_[cell]
                         ? ends[cell + 1]
                         : static_cast<std::uint32_t>(cell + 1);
    seen_.resize(blocks_ * sites_);
    tbb::parallel_for(std::size_t{0}, sites_, [&](std::size_t site) {
        auto& seen = perThread<std::vector<std::uint64_t>, struct SeenOfBlocks>();
        seen.assign(blocks_, 0);
        candidates.forEachRunOfSite(site, [&](const CellRun& run) {
            for (std::uint32_t first = run.first; first < run.end;) {
                const std::uint32_t end = std::min(ends[first], run.end);
                seen[block_of_[first]] += weights.of({first, end});
                first = end;
            }
        });
        // A cell may be in several parts of a site, and so counted several times.
        for (std::size_t block = 0; block < blocks_; ++block)
            seen_[block * sites_ + site] = static_cast<std::int16_t>(std::min(
                kMaxSeen, scaledUp(static_cast<std::uint32_t>(std::min<std::uint64_t>(
                                       seen[block], std::numeric_limits<std::uint32_t>::max())),
                                   shift_)));
    });
}

namespace {

/// Adds the weight that each site sees of a block, at most `most`, to the sums.
ISPACE_SIMD_CLONES void addSeen(const std::int16_t* seen, std::int16_t most, std::size_t sites,
                                std::uint32_t* sums) {
    for (std::size_t site = 0; site < sites; ++site)
        sums[site] += static_cast<std::uint16_t>(std::min(most, seen[site]));
}

}  // namespace

void SiteBlocks::bound(std::span<const std::uint32_t> gains,
                       std::span<std::uint32_t> bounds) const {
    auto& left = perThread<std::vector<std::uint32_t>, struct LeftOfBlocks>();
    left.assign(blocks_, 0);
    for (std::size_t cell = 0; cell < gains.size(); ++cell) left[block_of_[cell]] += gains[cell];
    std::fill(bounds.begin(), bounds.end(), 0U);
    for (std::size_t block = 0; block < blocks_; ++block) {
        if (left[block] == 0) continue;
        const auto most = static_cast<std::int16_t>(scaledUp(left[block], shift_));
        addSeen(seen_.data() + block * sites_, most, sites_, bounds.data());
    }
    if (shift_ == 0) return;
    const std::uint32_t most = std::numeric_limits<std::uint32_t>::max() >> shift_;
    for (std::uint32_t& sum : bounds)
        sum = sum > most ? std::numeric_limits<std::uint32_t>::max() : sum << shift_;
}

}  // namespace ispace
