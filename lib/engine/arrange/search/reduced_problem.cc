// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts a problem down to some candidates. Cells that the same of them see, with the same need,
// become one cell: thousands become hundreds, and bounds are computed as many times faster.
//
// A set of parts is told by the exclusive or of 128 bits of each part (A. L. Zobrist, A new hashing
// method with application for game playing, 1970), computed from differences along the cells: two
// operations a run. Two distinct sets have equal bits with a probability of about 2^-128, which
// proofs neglect.
#include "arrange/search/branch_node.h"

#include <algorithm>
#include <compare>
#include <span>

#include "base/random.h"

namespace ispace {
namespace {

/// Identifies a set of parts: the exclusive or of 128 random bits of each.
struct Signature {
    std::uint64_t low = 0, high = 0;

    Signature& operator^=(const Signature& other) {
        low ^= other.low;
        high ^= other.high;
        return *this;
    }
    friend auto operator<=>(const Signature&, const Signature&) = default;
};

/// A site with the views of its kept candidates, in the fewest parts that tell them apart.
struct KeptSite {
    std::size_t kind = 0;
    std::vector<CandidateSet::PartRange> ranges;  // of the candidates
    std::vector<std::vector<CellRun>> parts;      // the last is seen by all
};

/// One candidate requires no parts, and its runs in order merge better.
KeptSite singleSite(const CandidateSet& set, std::size_t kind, std::uint32_t candidate) {
    KeptSite kept{kind, {CandidateSet::PartRange()}, {{}}};
    std::vector<CellRun>& runs = kept.parts[0];
    set.forEachRun(candidate, [&runs](const CellRun& run) { runs.push_back(run); });
    std::sort(runs.begin(), runs.end(),
              [](const CellRun& a, const CellRun& b) { return a.first < b.first; });
    return kept;
}

KeptSite siteOf(const CandidateSet& set, std::size_t kind,
                std::span<const std::uint32_t> candidates) {
    if (candidates.size() == 1) return singleSite(set, kind, candidates[0]);
    KeptSite kept{kind, {}, {}};
    const std::size_t site = set.siteOf(candidates[0]);
    const auto directed = static_cast<std::uint32_t>(set.directedParts(site));
    // Merges parts between directions at which a candidate's view begins or ends.
    const auto within = [directed](std::uint32_t part) {
        return part > directed ? part - directed : part;
    };
    std::vector<std::uint32_t> limits = {0, directed};
    for (const std::uint32_t candidate : candidates) {
        const CandidateSet::PartRange range = set.rangeOf(candidate);
        limits.insert(limits.end(), {range.begin, within(range.begin + range.count)});
    }
    std::sort(limits.begin(), limits.end());
    limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
    const auto parts = static_cast<std::uint32_t>(limits.size() - 1);
    const auto part_at = [&limits](std::uint32_t part) {
        return static_cast<std::uint32_t>(std::lower_bound(limits.begin(), limits.end(), part) -
                                          limits.begin());
    };
    std::vector<char> is_seen(parts, 0);
    kept.ranges.reserve(candidates.size());
    for (const std::uint32_t candidate : candidates) {
        const CandidateSet::PartRange range = set.rangeOf(candidate);
        const std::uint32_t last = range.begin + range.count;
        const std::uint32_t begin = part_at(range.begin);
        const std::uint32_t end = part_at(within(last)) + (last > directed ? parts : 0);
        kept.ranges.push_back({begin, end - begin});
        for (std::uint32_t part = begin; part < end; ++part) is_seen[part % parts] = 1;
    }
    kept.parts.resize(parts + 1);
    const auto add_to = [&](std::vector<CellRun>& runs, std::size_t part) {
        const std::vector<CellRun> more = set.runsOf(site, part);
        runs.insert(runs.end(), more.begin(), more.end());
    };
    for (std::uint32_t part = 0; part < parts; ++part)
        for (std::uint32_t i = limits[part]; is_seen[part] != 0 && i < limits[part + 1]; ++i)
            add_to(kept.parts[part], i);
    add_to(kept.parts[parts], directed);
    return kept;
}

std::vector<KeptSite> sitesOf(const ReducedProblem& from,
                              const std::vector<std::vector<std::uint32_t>>& kept) {
    std::vector<KeptSite> sites;
    for (std::size_t kind = 0; kind < kept.size(); ++kind) {
        const CandidateSet& set = *from.kinds[kind].candidates;
        std::size_t next = 0;
        while (next < kept[kind].size()) {
            const std::size_t first = next, site = set.siteOf(kept[kind][first]);
            while (next < kept[kind].size() && set.siteOf(kept[kind][next]) == site) ++next;
            sites.push_back(siteOf(set, kind, std::span(kept[kind]).subspan(first, next - first)));
        }
    }
    return sites;
}

std::vector<Signature> signaturesOf(const std::vector<KeptSite>& sites, std::size_t cells) {
    // Computes the change from each cell to the next, then sums up.
    std::vector<Signature> signatures(cells + 1);
    std::uint64_t number = 0;
    for (const KeptSite& site : sites)
        for (const auto& part : site.parts) {
            ++number;
            const Signature own{mixedBits(2 * number), mixedBits(2 * number + 1)};
            for (const CellRun& run : part) {
                signatures[run.first] ^= own;
                signatures[run.end] ^= own;
            }
        }
    for (std::size_t i = 1; i < cells; ++i) signatures[i] ^= signatures[i - 1];
    signatures.pop_back();
    return signatures;
}

/// Merged cells: each is named by the first of its members, and they are numbered in that order, so
/// that a run of cells becomes a run of merged cells.
struct Joined {
    std::vector<std::uint32_t> before;  ///< [i]: merged cells that begin before cell i
};

Joined joinCells(const ReducedProblem& from, const std::vector<Signature>& signatures,
                 std::vector<std::uint32_t>& multipliers, ReducedProblem& to) {
    const std::size_t cells = from.cells();
    std::vector<std::uint32_t> order;
    order.reserve(cells);
    for (std::size_t i = 0; i < cells; ++i)
        if (from.weights[i] > 0 && signatures[i] != Signature())
            order.push_back(static_cast<std::uint32_t>(i));
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
        return signatures[a] == signatures[b] && from.needs[a] == from.needs[b];
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (signatures[a] != signatures[b]) return signatures[a] < signatures[b];
        return from.needs[a] != from.needs[b] ? from.needs[a] < from.needs[b] : a < b;
    });
    // The first member of a merged cell holds the sums.
    std::vector<std::uint32_t> weights(cells, 0), sums(cells, 0);
    for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
        if (!same(order[first], order[i])) first = i;
        weights[order[first]] += from.weights[order[i]];
        sums[order[first]] += multipliers[order[i]];
    }
    Joined joined;
    joined.before.reserve(cells + 1);
    multipliers.clear();
    for (std::size_t i = 0; i < cells; ++i) {
        joined.before.push_back(static_cast<std::uint32_t>(to.weights.size()));
        if (weights[i] == 0) continue;
        to.weights.push_back(weights[i]);
        to.needs.push_back(from.needs[i]);
        multipliers.push_back(sums[i]);
    }
    joined.before.push_back(static_cast<std::uint32_t>(to.weights.size()));
    return joined;
}

/// Converts the runs of a part to merged cells; merges touching runs.
void addPart(const std::vector<CellRun>& runs, const Joined& joined, CellParts& parts) {
    const std::size_t begin = parts.runs.size();
    for (const CellRun& run : runs) {
        const CellRun now{joined.before[run.first], joined.before[run.end]};
        if (now.first == now.end) continue;
        if (parts.runs.size() > begin && parts.runs.back().end == now.first)
            parts.runs.back().end = now.end;
        else
            parts.runs.push_back(now);
    }
    parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
}

void addSite(const KeptSite& site, const Joined& joined, CandidateSet& to) {
    CellParts parts;
    parts.first = {0};
    for (const auto& part : site.parts) addPart(part, joined, parts);
    to.addSite(site.ranges, parts);
}

}  // namespace

std::size_t ReducedProblem::candidates() const {
    std::size_t count = 0;
    for (const OfKind& kind : kinds) count += kind.candidates->size();
    return count;
}

std::size_t ReducedProblem::bytes() const {
    std::size_t bytes = weights.size() * sizeof(weights[0]) + needs.size() * sizeof(needs[0]);
    for (const OfKind& kind : kinds)
        bytes += kind.candidates->bytes() + kind.original.size() * sizeof(kind.original[0]);
    return bytes;
}

ReducedProblem wholeProblem(const Problem& problem, const RelaxedCells& cells) {
    ReducedProblem whole;
    whole.settled = cells.settled;
    whole.weights = cells.weights;
    whole.needs = cells.needs;
    for (std::size_t k = 0; k < problem.kinds.size(); ++k) {
        // The problem outlives the sets derived from it.
        std::shared_ptr<const CandidateSet> set(std::shared_ptr<const CandidateSet>(),
                                                problem.kinds[k].candidates);
        whole.kinds.push_back({std::move(set), {}, cells.multiplicities[k]});
    }
    return whole;
}

ReducedProblem reduce(const ReducedProblem& from,
                      const std::vector<std::vector<std::uint32_t>>& kept,
                      std::vector<std::uint32_t>& multipliers) {
    ReducedProblem to;
    to.settled = from.settled;
    const std::vector<KeptSite> sites = sitesOf(from, kept);
    const Joined joined = joinCells(from, signaturesOf(sites, from.cells()), multipliers, to);
    std::vector<std::shared_ptr<CandidateSet>> sets;
    for (std::size_t k = 0; k < kept.size(); ++k)
        sets.push_back(std::make_shared<CandidateSet>(to.cells()));
    for (const KeptSite& site : sites) addSite(site, joined, *sets[site.kind]);
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const std::vector<std::uint32_t>& names = from.kinds[k].original;
        std::vector<std::uint32_t> original;
        original.reserve(kept[k].size());
        for (const std::uint32_t i : kept[k]) original.push_back(names.empty() ? i : names[i]);
        // A copy allocates exactly its size; a growing set reserves more.
        auto set = std::make_shared<const CandidateSet>(*sets[k]);
        sets[k].reset();
        to.kinds.push_back({std::move(set), std::move(original), from.kinds[k].multiplicity});
    }
    return to;
}

}  // namespace ispace
