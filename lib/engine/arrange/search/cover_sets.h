// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/arrange/search: weighted coverage problems, their solutions and bounds. Uses base
// alone; TBB inside.
//
// The folder knows cells, weights and candidates, and no geometry. All values and bounds are whole
// numbers: sums are exact, bounds hold without slack for rounding, and results are the same for any
// number of threads, unless a search is stopped. Read problem.h next, then search.h.
//
//     CandidateSet candidates(6);                     // six cells
//     CellSet left(6), right(6);
//     for (std::size_t cell : {0, 1, 2}) left.set(cell);
//     for (std::size_t cell : {2, 3}) right.set(cell);
//     candidates.addSite(left);
//     candidates.addSite(right);
//     Problem problem;
//     problem.weights = {1, 2, 4, 8, 16, 32};
//     problem.kinds = {{&candidates, 2}};             // at most two sensors
//     SilentProgress progress;
//     const SearchResult result = search(problem, {}, progress);  // both: value 15, bound 15
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/cell_set.h"

namespace ispace {

/// Prefix sums of cell weights: the weight of a run takes two reads, whatever its length. Sums wrap
/// around at 2^32; only the weights of runs and candidates have to fit. Thread-safe once assigned.
class WeightSums {
  public:
    WeightSums() = default;
    /// Stores the sums of one weight per cell. O(cells)
    explicit WeightSums(std::span<const std::uint32_t> weights) { assign(weights); }
    void assign(std::span<const std::uint32_t> weights);
    [[nodiscard]] std::uint32_t of(const CellRun& run) const {
        return sums_[run.end] - sums_[run.first];
    }
    /// Returns in [i] the weight of all cells before i; one entry more than there are cells.
    [[nodiscard]] std::span<const std::uint32_t> sums() const { return sums_; }

  private:
    std::vector<std::uint32_t> sums_;
};

/// Returns true if parts follow each other, and all their runs lie within so many cells.
bool isWhole(const CellParts& parts, std::size_t cells);

/// Stores candidates of one kind, each with the cells it sees.
///
/// Candidates of one site share storage: the cells visible from the site are split into parts by
/// direction, and each candidate is a range of parts. This takes 4 bytes per run and part and 12
/// per candidate, a fraction of a bit set each. To weigh all candidates of a site takes its runs
/// once: about two cycles a run for 13 000 sites of 780 runs. Const members are thread-safe.
class CandidateSet {
  public:
    /// The parts that a candidate sees: `count` directed parts from `begin` on, wrapping around,
    /// and always the undirected part.
    struct PartRange {
        std::uint32_t begin = 0, count = 0;
    };

    /// \param cells of the grid, below 2^31
    explicit CandidateSet(std::size_t cells);

    /// Adds a site. `parts` holds the directed parts, then the undirected one that every candidate
    /// sees. Candidate k sees ranges[k]; no cell may be in two parts of one candidate.
    /// \pre ranges are not empty
    void addSite(std::span<const PartRange> ranges, const CellParts& parts);
    /// Adds a site with a single candidate.
    void addSite(const CellSet& seen);

    [[nodiscard]] std::size_t cells() const { return cells_; }
    [[nodiscard]] std::size_t size() const { return ranges_.size(); }
    [[nodiscard]] std::size_t sites() const { return sites_.size(); }
    /// The candidates of a site are [firstOf(site), firstOf(site + 1)).
    [[nodiscard]] std::size_t firstOf(std::size_t site) const {
        return site == sites_.size() ? size() : sites_[site].first_candidate;
    }
    [[nodiscard]] std::size_t siteOf(std::size_t candidate) const { return site_of_[candidate]; }
    /// Returns the memory that grows with the number of sites.
    [[nodiscard]] std::size_t bytes() const;
    /// Returns the number of stored runs; a run that is split between parts, or for its length,
    /// counts several times.
    [[nodiscard]] std::size_t runs() const { return runs_; }

    /// Calls visit(const CellRun&) for the disjoint runs of a candidate, in arbitrary order.
    template <typename Visit>
    void forEachRun(std::size_t candidate, Visit visit) const;
    /// The same for all candidates of a site; a cell may be in several runs.
    template <typename Visit>
    void forEachRunOfSite(std::size_t site, Visit visit) const {
        const std::uint32_t* const runs = runsOf(sites_[site]);
        for (std::uint32_t i = 0; i < sites_[site].runs; ++i) visit(unpacked(runs[i]));
    }
    [[nodiscard]] CellSet cellsOf(std::size_t candidate) const;
    /// Adds the candidate's cells.
    void addTo(CellSet& cells, std::size_t candidate) const;

    [[nodiscard]] PartRange rangeOf(std::size_t candidate) const { return ranges_[candidate]; }
    /// Returns the number of directed parts of a site.
    [[nodiscard]] std::size_t directedParts(std::size_t site) const {
        return sites_[site].directed;
    }
    /// Returns the runs of a part of a site; part directedParts() is the undirected one.
    [[nodiscard]] std::vector<CellRun> runsOf(std::size_t site, std::size_t part) const;

    /// Computes the weight of the cells that each candidate of a site sees: values[k] for
    /// firstOf(site) + k. O(runs and parts of the site + candidates).
    /// \pre each sum is below 2^32
    void weighSite(std::size_t site, const WeightSums& weights,
                   std::span<std::uint32_t> values) const;
    [[nodiscard]] std::uint32_t weigh(std::size_t candidate, const WeightSums& weights) const;
    /// Computes the same for all candidates, in parallel.
    void weighAll(const WeightSums& weights, std::span<std::uint32_t> values) const;

  private:
    /// A run takes 32 bits: the first cell above, the length (at least 1) below. The runs of a site
    /// are contiguous, by parts; the undirected part comes last.
    struct Site {
        std::size_t first_candidate = 0;
        std::size_t first_part = 0;           ///< in part_runs_
        std::uint32_t block = 0, offset = 0;  ///< its first run
        std::uint32_t directed = 0;           ///< parts without the undirected one
        std::uint32_t runs = 0;
    };

    void addRuns(const CellParts& parts, Site& site);
    [[nodiscard]] const std::uint32_t* runsOf(const Site& site) const {
        return blocks_[site.block].data() + site.offset;
    }
    /// Returns in [k] the first run of part k, counted from the site's first.
    [[nodiscard]] const std::uint32_t* partsOf(const Site& site) const {
        return part_runs_.data() + site.first_part;
    }
    [[nodiscard]] CellRun unpacked(std::uint32_t run) const {
        const std::uint32_t first = run >> length_bits_;
        return {first, first + (run & ((std::uint32_t{1} << length_bits_) - 1))};
    }

    std::size_t cells_, runs_ = 0;
    std::uint32_t length_bits_;
    std::vector<Site> sites_;
    std::vector<std::uint32_t> part_runs_;  // by site, by part
    // By candidate:
    std::vector<PartRange> ranges_;
    std::vector<std::uint32_t> site_of_;
    // Never moved as they grow: that would take twice the memory.
    std::vector<std::vector<std::uint32_t>> blocks_;
};

template <typename Visit>
void CandidateSet::forEachRun(std::size_t candidate, Visit visit) const {
    const Site& site = sites_[site_of_[candidate]];
    const std::uint32_t *runs = runsOf(site), *parts = partsOf(site);
    const auto visit_all = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) visit(unpacked(runs[i]));
    };
    const PartRange own = ranges_[candidate];
    const std::uint32_t end = own.begin + own.count;
    visit_all(parts[own.begin], parts[std::min(end, site.directed)]);
    if (end > site.directed) visit_all(0, parts[end - site.directed]);
    visit_all(parts[site.directed], site.runs);
}

/// The view of a candidate: runs of cells, ascending, that do not touch each other.
using CellRuns = std::vector<CellRun>;

/// Returns the view of a candidate. O(n log n) for n runs.
CellRuns runsOf(const CandidateSet& set, std::uint32_t candidate);
/// Computes the intersection of two views. O(n)
CellRuns commonOf(const CellRuns& a, const CellRuns& b);

/// Prefix sums of cell weights masked by one candidate's view: its overlap with another view takes
/// two reads per run.
class MaskedSums {
  public:
    explicit MaskedSums(std::size_t cells) : sums_(cells + 1) {}
    /// O(cells)
    void assign(const CellRuns& runs, const std::uint32_t* weights);
    /// Returns the weight of the cells of these runs that lie in the view. O(n) for n runs.
    [[nodiscard]] std::int64_t of(const CellRuns& runs) const {
        std::uint32_t sum = 0;
        for (const CellRun& run : runs) sum += sums_[run.end] - sums_[run.first];
        return sum;
    }

  private:
    std::vector<std::uint32_t> sums_;  // [i]: of all before cell i
};

}  // namespace ispace
