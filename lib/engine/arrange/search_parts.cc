// SPDX-License-Identifier: GPL-3.0-or-later
// Searches parts of a site one by one, for 1, 2, ... sensors, and shares the sensors out.
//
// A PartProblem holds the cells and candidates of a part in the order of the site, so that equal
// parts give equal results, candidate by candidate, and a choice maps back by its position. One
// sensor more never covers less, and a bound for n sensors holds for fewer: a search that does not
// begin any more, or ends below the one before it although coverage need not be connected, takes
// that result and one more sensor.
#include "arrange/search_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "arrange/search/share_out.h"

namespace ispace {

namespace {

/// The sites of candidates in each room, of the set of the site.
class SitesOfRooms {
  public:
    explicit SitesOfRooms(const CoverageModel& model)
        : all_(*model.problem().kinds.front().candidates), sites_(model.site().rooms.size()) {
        for (std::size_t site = 0; site < all_.sites(); ++site)
            sites_[model.roomOf({0, all_.firstOf(site)})].push_back(site);
    }
    [[nodiscard]] const CandidateSet& all() const { return all_; }
    /// Returns the sites in these rooms, ascending.
    [[nodiscard]] std::vector<std::size_t> sitesIn(std::span<const std::size_t> rooms) const {
        std::vector<std::size_t> sites;
        for (const std::size_t room : rooms)
            sites.insert(sites.end(), sites_[room].begin(), sites_[room].end());
        std::ranges::sort(sites);
        return sites;
    }
    /// Returns the candidates in these rooms, ascending.
    [[nodiscard]] std::vector<std::size_t> candidatesIn(std::span<const std::size_t> rooms) const {
        std::vector<std::size_t> candidates;
        for (const std::size_t site : sitesIn(rooms))
            for (std::size_t i = all_.firstOf(site); i < all_.firstOf(site + 1); ++i)
                candidates.push_back(i);
        return candidates;
    }

  private:
    const CandidateSet& all_;
    std::vector<std::vector<std::size_t>> sites_;
};

/// The problem of one part; its cells and candidates follow each other as in that of the site.
class PartProblem {
  public:
    PartProblem(const CoverageModel& model, std::span<const std::size_t> rooms,
                const SitesOfRooms& sites)
        : set_(cellsOf(model, rooms)) {
        const Problem& whole = model.problem();
        std::uint32_t cells = 0;
        for (const std::size_t room : rooms) {
            const CellBlock block = model.cellsOfRoom(room);
            shifts_.push_back({block, cells});
            for (std::size_t cell = block.first; cell < block.end; ++cell) {
                problem_.weights.push_back(whole.weights[cell]);
                problem_.achieved.push_back(whole.achieved[cell]);
            }
            cells = static_cast<std::uint32_t>(problem_.weights.size());
        }
        problem_.required = whole.required;
        problem_.is_connected = whole.is_connected;
        problem_.standing = CellSet(problem_.cells());
        for (const auto& [block, first] : shifts_)
            for (std::size_t cell = block.first; cell < block.end; ++cell)
                if (whole.standing.test(cell)) problem_.standing.set(first + cell - block.first);
        for (const std::size_t site : sites.sitesIn(rooms)) addSite(sites.all(), site);
        problem_.kinds.push_back({&set_, 1, 1, whole.kinds.front().multiplicity});
    }
    PartProblem(const PartProblem&) = delete;
    PartProblem& operator=(const PartProblem&) = delete;

    [[nodiscard]] Problem& problem() { return problem_; }

  private:
    static std::size_t cellsOf(const CoverageModel& model, std::span<const std::size_t> rooms) {
        std::size_t cells = 0;
        for (const std::size_t room : rooms) {
            const CellBlock block = model.cellsOfRoom(room);
            cells += block.end - block.first;
        }
        return cells;
    }

    [[nodiscard]] CellRun moved(const CellRun& run) const {
        for (const auto& [block, first] : shifts_)
            if (run.first >= block.first && run.first < block.end) {
                const auto shift = first - static_cast<std::uint32_t>(block.first);  // may wrap
                return {run.first + shift, run.end + shift};
            }
        return {0, 0};
    }

    void addSite(const CandidateSet& all, std::size_t site) {
        CellParts parts;
        parts.first.push_back(0);
        for (std::size_t k = 0; k <= all.directedParts(site); ++k) {
            for (const CellRun& run : all.runsOf(site, k)) parts.runs.push_back(moved(run));
            parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
        }
        std::vector<CandidateSet::PartRange> ranges;
        for (std::size_t i = all.firstOf(site); i < all.firstOf(site + 1); ++i)
            ranges.push_back(all.rangeOf(i));
        set_.addSite(ranges, parts);
    }

    struct Shift {
        CellBlock block;
        std::uint32_t first = 0;
    };

    std::vector<Shift> shifts_;
    CandidateSet set_;
    Problem problem_;
};

/// The results of a part, in [n - 1] with the n candidates of the part's own set.
struct PartResults {
    std::vector<SearchResult> by_number = {};
    std::vector<std::size_t> candidates = {};  ///< in the set of the site

    /// \param standing weight that standing sensors cover
    [[nodiscard]] GainCurve curve(double standing) const {
        GainCurve curve{{standing}, {standing}};
        for (const SearchResult& result : by_number) {
            curve.values.push_back(static_cast<double>(result.best.value));
            curve.bounds.push_back(static_cast<double>(result.bound));
        }
        // A bound for n sensors holds for fewer.
        for (std::size_t i = curve.bounds.size(); i-- > 2;)
            curve.bounds[i - 1] = std::min(curve.bounds[i - 1], curve.bounds[i]);
        return curve;
    }
};

/// Adds the first candidate that is not chosen yet. \pre there is one
Solution withOneMore(Solution solution, std::size_t candidates) {
    for (std::size_t i = 0; i < candidates; ++i) {
        if (std::find(solution.chosen.begin(), solution.chosen.end(), Choice{0, i}) !=
            solution.chosen.end())
            continue;
        solution.chosen.push_back({0, i});
        break;
    }
    return solution;
}

PartResults resultsOf(const CoverageModel& model, std::span<const std::size_t> rooms,
                      const SitesOfRooms& sites, int most, Progress& progress) {
    PartProblem part(model, rooms, sites);
    PartResults results;
    results.candidates = sites.candidatesIn(rooms);
    const auto last = std::min(static_cast<std::size_t>(most), results.candidates.size());
    SearchOptions options = model.searchOptions();
    for (std::size_t n = 1; n <= last; ++n) {
        if (n > 1 && progress.stopped()) {
            results.by_number.push_back(
                {withOneMore(results.by_number.back().best, results.candidates.size()),
                 part.problem().totalWeight(), false});
            continue;
        }
        part.problem().kinds.front().most = static_cast<int>(n);
        part.problem().order.assign(n, 0);
        options.share.search = '/' + std::to_string(rooms.front()) + '/' + std::to_string(n);
        SearchResult found = search(part.problem(), options, progress);
        // One more sensor never covers less.
        if (n > 1 && !part.problem().is_connected &&
            found.best.value < results.by_number.back().best.value)
            found.best = withOneMore(results.by_number.back().best, results.candidates.size());
        results.by_number.push_back(std::move(found));
    }
    return results;
}

}  // namespace

bool isSearchedByParts(const CoverageModel& model) {
    const ArrangeOptions& options = model.options();
    return !model.site().isOneRoom() && model.kinds().size() == 1 && !options.budget &&
           !options.target && !options.cases && !options.objective && model.parts().size() > 1;
}

std::vector<SearchResult> searchParts(const CoverageModel& model, Progress& progress) {
    const Problem& whole = model.problem();
    const int most = whole.kinds.front().most;
    const std::vector<CoverageModel::Part> parts = model.parts();
    const SitesOfRooms sites(model);
    std::vector<PartResults> results(parts.size());
    std::vector<GainCurve> curves;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::size_t alike = parts[i].alike;
        if (alike == i) {
            results[i] = resultsOf(model, parts[i].rooms, sites, most, progress);
        } else {
            results[i].by_number = results[alike].by_number;
            results[i].candidates = sites.candidatesIn(parts[i].rooms);
        }
        double standing = 0;
        for (const std::size_t room : parts[i].rooms) {
            const CellBlock block = model.cellsOfRoom(room);
            for (std::size_t cell = block.first; cell < block.end; ++cell)
                if (whole.achieved[cell] >= whole.required) standing += whole.weights[cell];
        }
        curves.push_back(results[i].curve(standing));
    }
    std::vector<SearchResult> all;
    for (int n = 1; n <= most; ++n) {
        const SharedOut shared = shareOut(curves, n);
        SearchResult& result = all.emplace_back();
        result.best.value = static_cast<std::uint64_t>(std::llround(shared.value));
        result.bound = static_cast<std::uint64_t>(std::llround(shared.bound));
        for (std::size_t i = 0; i < parts.size(); ++i) {
            for (const SearchResult& one : results[i].by_number)
                result.is_complete = result.is_complete && one.is_complete;
            const auto count = static_cast<std::size_t>(shared.counts[i]);
            if (count == 0 || results[i].by_number.empty()) continue;
            const std::size_t last = std::min(count, results[i].by_number.size());
            const SearchResult& own = results[i].by_number[last - 1];
            for (const Choice& choice : own.best.chosen)
                result.best.chosen.push_back({0, results[i].candidates[choice.candidate]});
        }
        // Numbers that are not part of the best split may lack a proof.
        result.is_complete = result.is_complete || result.best.value >= result.bound;
    }
    return all;
}

}  // namespace ispace
