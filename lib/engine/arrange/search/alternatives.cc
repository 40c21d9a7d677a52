// SPDX-License-Identifier: GPL-3.0-or-later
// Further solutions, by splitting those that remain (E. L. Lawler, A procedure for computing the K
// best solutions to discrete optimization problems, 1972). Parts are problems without candidates
// near some choices; the part with the best solution is split next.
#include "arrange/search/alternatives.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

namespace ispace {

namespace {

/// A problem without some candidates.
struct LimitedProblem {
    Problem problem;
    std::vector<std::unique_ptr<CandidateSet>> sets;
    std::vector<std::vector<std::size_t>> originals;  // [kind][candidate]
};

/// Copies the candidates with `keep`. \param originals receives their indices
std::unique_ptr<CandidateSet> subsetOf(const CandidateSet& set, const std::vector<bool>& keep,
                                       std::vector<std::size_t>& originals) {
    auto subset = std::make_unique<CandidateSet>(set.cells());
    for (std::size_t site = 0; site < set.sites(); ++site) {
        std::vector<CandidateSet::PartRange> ranges;
        for (std::size_t i = set.firstOf(site); i < set.firstOf(site + 1); ++i)
            if (keep[i]) {
                ranges.push_back(set.rangeOf(i));
                originals.push_back(i);
            }
        if (ranges.empty()) continue;
        CellParts parts;
        parts.first = {0};
        for (std::size_t part = 0; part <= set.directedParts(site); ++part) {
            const std::vector<CellRun> runs = set.runsOf(site, part);
            parts.runs.insert(parts.runs.end(), runs.begin(), runs.end());
            parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
        }
        subset->addSite(ranges, parts);
    }
    return subset;
}

/// Removes the candidates near any of these choices; empty if a kind has none left.
std::optional<LimitedProblem> without(const Problem& problem, const std::vector<Choice>& forbidden,
                                      const NearChoices& are_near) {
    LimitedProblem limited{problem, {}, {}};
    for (std::size_t kind = 0; kind < problem.kinds.size(); ++kind) {
        const CandidateSet& set = *problem.kinds[kind].candidates;
        std::vector<bool> keep(set.size());
        for (std::size_t i = 0; i < set.size(); ++i)
            keep[i] = std::none_of(forbidden.begin(), forbidden.end(), [&](const Choice& choice) {
                return are_near({kind, i}, choice);
            });
        limited.sets.push_back(subsetOf(set, keep, limited.originals.emplace_back()));
        if (limited.sets.back()->size() == 0) return std::nullopt;
        limited.problem.kinds[kind].candidates = limited.sets.back().get();
    }
    return limited;
}

/// A part of the solutions: those without candidates near `forbidden`, with the best one found.
struct Part {
    std::vector<Choice> forbidden;
    Solution best;
};

class Splitter {
  public:
    Splitter(const Problem& problem, const NearChoices& are_near, const SearchOptions& options,
             Progress& progress)
        : problem_(problem), are_near_(are_near), options_(options), progress_(progress) {}

    /// Adds the parts of `forbidden` that differ from this solution.
    void split(const std::vector<Choice>& forbidden, const Solution& solution) {
        for (const Choice& choice : solution.chosen) {
            if (progress_.stopped()) return;
            std::vector<Choice> more = forbidden;
            more.push_back(choice);
            const auto limited = without(problem_, more, are_near_);
            if (!limited) continue;
            Solution found = search(limited->problem, options_, progress_).best;
            for (Choice& one : found.chosen)
                one.candidate = limited->originals[one.kind][one.candidate];
            if (!found.chosen.empty()) parts_.push_back({std::move(more), std::move(found)});
        }
    }
    /// Removes and returns the part with the largest value, the first of equals.
    std::optional<Part> next() {
        if (parts_.empty()) return std::nullopt;
        const auto best = std::max_element(
            parts_.begin(), parts_.end(),
            [](const Part& a, const Part& b) { return a.best.value < b.best.value; });
        Part part = std::move(*best);
        parts_.erase(best);
        return part;
    }

  private:
    const Problem& problem_;
    const NearChoices& are_near_;
    SearchOptions options_;
    Progress& progress_;
    std::vector<Part> parts_;
};

}  // namespace

bool differs(const Solution& solution, const Solution& other, const NearChoices& are_near) {
    return std::any_of(other.chosen.begin(), other.chosen.end(), [&](const Choice& choice) {
        return std::none_of(solution.chosen.begin(), solution.chosen.end(),
                            [&](const Choice& own) { return are_near(own, choice); });
    });
}

std::vector<Solution> alternativesTo(const Problem& problem, const Solution& best,
                                     const NearChoices& are_near, std::size_t count,
                                     const SearchOptions& options, Progress& progress) {
    Splitter splitter(problem, are_near, options, progress);
    splitter.split({}, best);
    std::vector<Solution> found;
    while (found.size() < count) {
        const std::optional<Part> part = splitter.next();
        if (!part) break;
        const auto same = std::find_if(found.begin(), found.end(), [&](const Solution& earlier) {
            return !differs(part->best, earlier, are_near);
        });
        splitter.split(part->forbidden, same == found.end() ? part->best : *same);
        if (same == found.end()) found.push_back(part->best);
    }
    return found;
}

}  // namespace ispace
