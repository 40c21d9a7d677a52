// SPDX-License-Identifier: GPL-3.0-or-later
// Candidate sets in memory: a run of cells is one word of 32 bits, its first cell above its length;
// runs too long for that are cut in pieces. Words lie in blocks that never move. A site is weighed
// by one pass over its runs, after which each candidate takes two differences of prefix sums.
#include "arrange/search/cover_sets.h"
#include "base/per_thread.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cassert>

namespace ispace {

CellRuns runsOf(const CandidateSet& set, std::uint32_t candidate) {
    CellRuns runs, joined;
    set.forEachRun(candidate, [&runs](const CellRun& run) { runs.push_back(run); });
    std::sort(runs.begin(), runs.end(),
              [](const CellRun& a, const CellRun& b) { return a.first < b.first; });
    for (const CellRun& run : runs) {
        if (!joined.empty() && joined.back().end == run.first)
            joined.back().end = run.end;
        else
            joined.push_back(run);
    }
    return joined;
}

CellRuns commonOf(const CellRuns& a, const CellRuns& b) {
    CellRuns both;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        const CellRun run{std::max(a[i].first, b[j].first), std::min(a[i].end, b[j].end)};
        if (run.first < run.end) both.push_back(run);
        if (a[i].end < b[j].end)
            ++i;
        else
            ++j;
    }
    return both;
}

void MaskedSums::assign(const CellRuns& runs, const std::uint32_t* weights) {
    std::uint32_t sum = 0;
    std::size_t cell = 0;
    const auto at = [this](std::size_t i) {
        return sums_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    for (const CellRun& run : runs) {
        std::fill(at(cell), at(run.first), sum);
        for (cell = run.first; cell < run.end; ++cell) {
            sums_[cell] = sum;
            sum += weights[cell];
        }
    }
    std::fill(at(cell), sums_.end(), sum);
}

namespace {

/// Sets before[i] to the weight of all runs before run i, for i from 0 to `count`.
///
/// Gathers do not pay here: a run is two reads, mostly from the nearest cache, and plain reads were
/// half as fast again.
void sumRuns(const std::uint32_t* runs, std::size_t count, std::uint32_t length_bits,
             const std::uint32_t* sums, std::uint32_t* before) {
    const std::uint32_t length_mask = (std::uint32_t{1} << length_bits) - 1;
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        before[i] = sum;
        const std::uint32_t* first = sums + (runs[i] >> length_bits);
        sum += first[runs[i] & length_mask] - first[0];
    }
    before[count] = sum;
}

}  // namespace

void WeightSums::assign(std::span<const std::uint32_t> weights) {
    sums_.resize(weights.size() + 1);
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sums_[i] = sum;
        sum += weights[i];
    }
    sums_[weights.size()] = sum;
}

bool isWhole(const CellParts& parts, std::size_t cells) {
    const std::vector<std::uint32_t>& first = parts.first;
    return parts.size() > 0 && first.front() == 0 && first.back() == parts.runs.size() &&
           std::is_sorted(first.begin(), first.end()) &&
           std::all_of(parts.runs.begin(), parts.runs.end(), [cells](const CellRun& run) {
               return run.first < run.end && run.end <= cells;
           });
}

CandidateSet::CandidateSet(std::size_t cells)
    : cells_(cells),
      length_bits_(32 - std::max(1U, static_cast<std::uint32_t>(std::bit_width(cells)))) {
    assert(cells < std::size_t{1} << 31U);
}

void CandidateSet::addSite(std::span<const PartRange> ranges, const CellParts& parts) {
    assert(!ranges.empty() && parts.size() > 0);
    Site site{.first_candidate = size()};
    addRuns(parts, site);
    ranges_.insert(ranges_.end(), ranges.begin(), ranges.end());
    site_of_.insert(site_of_.end(), ranges.size(), static_cast<std::uint32_t>(sites_.size()));
    sites_.push_back(site);
}

/// Packs the runs, long ones in pieces, and stores where the parts begin.
void CandidateSet::addRuns(const CellParts& parts, Site& site) {
    constexpr std::size_t kBlock = std::size_t{1} << 18U;
    const std::uint32_t most = (std::uint32_t{1} << length_bits_) - 1;
    const bool is_whole = cells_ <= most;  // no run is in pieces
    std::size_t count = parts.runs.size();
    for (std::size_t i = 0; !is_whole && i < parts.runs.size(); ++i)
        count += (parts.runs[i].end - parts.runs[i].first - 1) / most;
    if (blocks_.empty() || blocks_.back().size() + count > blocks_.back().capacity()) {
        blocks_.emplace_back();
        blocks_.back().reserve(std::max(kBlock, count));
    }
    std::vector<std::uint32_t>& block = blocks_.back();
    const std::size_t offset = block.size();
    site.first_part = part_runs_.size();
    if (is_whole) {
        part_runs_.insert(part_runs_.end(), parts.first.begin(), parts.first.end() - 1);
        block.resize(offset + count);
        for (std::size_t i = 0; i < count; ++i)
            block[offset + i] =
                parts.runs[i].first << length_bits_ | (parts.runs[i].end - parts.runs[i].first);
    }
    for (std::size_t part = 0; !is_whole && part < parts.size(); ++part) {
        part_runs_.push_back(static_cast<std::uint32_t>(block.size() - offset));
        for (std::uint32_t i = parts.first[part]; i < parts.first[part + 1]; ++i) {
            CellRun run = parts.runs[i];
            for (; run.end - run.first > most; run.first += most)
                block.push_back(run.first << length_bits_ | most);
            block.push_back(run.first << length_bits_ | (run.end - run.first));
        }
    }
    runs_ += count;
    site.block = static_cast<std::uint32_t>(blocks_.size() - 1);
    site.offset = static_cast<std::uint32_t>(offset);
    site.directed = static_cast<std::uint32_t>(parts.size() - 1);
    site.runs = static_cast<std::uint32_t>(count);
}

void CandidateSet::addSite(const CellSet& seen) {
    const PartRange none;
    addSite({&none, 1}, partOf(seen));
}

std::size_t CandidateSet::bytes() const {
    return sites_.size() * sizeof(Site) + size() * (sizeof(PartRange) + sizeof(std::uint32_t)) +
           (part_runs_.size() + runs_) * sizeof(std::uint32_t);
}

CellSet CandidateSet::cellsOf(std::size_t candidate) const {
    CellSet cells(cells_);
    addTo(cells, candidate);
    return cells;
}

void CandidateSet::addTo(CellSet& cells, std::size_t candidate) const {
    forEachRun(candidate, [&cells](const CellRun& run) {
        for (std::uint32_t cell = run.first; cell < run.end; cell += 64) {
            const std::uint32_t count = std::min(run.end - cell, 64U);
            cells.addBits(cell, ~std::uint64_t{0} >> (64 - count));
        }
    });
}

void CandidateSet::weighSite(std::size_t site, const WeightSums& weights,
                             std::span<std::uint32_t> values) const {
    assert(weights.sums().size() == cells_ + 1);
    const Site& own = sites_[site];
    auto& before = perThread<std::vector<std::uint32_t>, struct RunWeights>();
    if (before.size() <= own.runs) before.resize(own.runs + 1);
    sumRuns(runsOf(own), own.runs, length_bits_, weights.sums().data(), before.data());
    const std::uint32_t* parts = partsOf(own);
    const std::uint32_t directed = before[parts[own.directed]];
    const std::uint32_t undirected = before[own.runs] - directed;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const PartRange range = ranges_[own.first_candidate + k];
        const std::uint32_t end = range.begin + range.count;
        const bool goes_on = end > own.directed;
        values[k] = undirected + (goes_on ? directed : 0) +
                    before[parts[goes_on ? end - own.directed : end]] - before[parts[range.begin]];
    }
}

std::vector<CellRun> CandidateSet::runsOf(std::size_t site, std::size_t part) const {
    const Site& own = sites_[site];
    const std::uint32_t *runs = runsOf(own), *parts = partsOf(own);
    const std::uint32_t end = part < own.directed ? parts[part + 1] : own.runs;
    std::vector<CellRun> unpacked_runs;
    unpacked_runs.reserve(end - parts[part]);
    for (std::uint32_t i = parts[part]; i < end; ++i) unpacked_runs.push_back(unpacked(runs[i]));
    return unpacked_runs;
}

std::uint32_t CandidateSet::weigh(std::size_t candidate, const WeightSums& weights) const {
    std::uint32_t sum = 0;
    forEachRun(candidate, [&](const CellRun& run) { sum += weights.of(run); });
    return sum;
}

void CandidateSet::weighAll(const WeightSums& weights, std::span<std::uint32_t> values) const {
    assert(values.size() == size());
    constexpr std::size_t kGrain = 32;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sites(), kGrain),
                      [&](const tbb::blocked_range<std::size_t>& some) {
                          for (std::size_t site = some.begin(); site < some.end(); ++site) {
                              const std::size_t first = firstOf(site);
                              weighSite(site, weights,
                                        values.subspan(first, firstOf(site + 1) - first));
                          }
                      });
}

}  // namespace ispace
