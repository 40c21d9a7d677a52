// SPDX-License-Identifier: GPL-3.0-or-later
// The fewest sensors that see every cell, by rows as needed.
//
// A cover of some cells bounds a cover of all from below, and if it leaves no cell uncovered it is
// one (M. C. Couto, P. J. de Rezende, C. C. de Souza, An exact algorithm for minimizing vertex
// guards on art galleries, 2011). Begins with a cell for each sensor of a known solution, which it
// alone sees, and adds up to 20 uncovered cells a round. Candidates that see the same of these
// cells are one column.
#include <algorithm>
#include <map>
#include <numeric>

#include "arrange/search/problem.h"
#include "arrange/search/search.h"
#include "arrange/search/set_cover.h"

namespace ispace {

namespace {

/// Cells that stand for all others: a cover of them bounds the number of sensors from below.
class CoverRounds {
  public:
    CoverRounds(const Problem& problem, const std::vector<Choice>& start) : problem_(problem) {
        std::vector<int> change(problem.cells() + 1);
        for (const SensorType& kind : problem.kinds)
            for (std::size_t i = 0; i < kind.candidates->size(); ++i)
                kind.candidates->forEachRun(i, [&change](const CellRun& run) {
                    ++change[run.first];
                    --change[run.end];
                });
        std::partial_sum(change.begin(), change.end(), change.begin());
        views_ = std::move(change);
        // The rarest cell that only this sensor sees.
        for (std::size_t i = 0; i < start.size(); ++i) {
            std::vector<Choice> others = start;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
            addRows(uncovered(others), 1);
        }
    }

    [[nodiscard]] std::vector<std::uint32_t> uncovered(const std::vector<Choice>& chosen) const {
        CellSet seen(problem_.cells());
        for (const Choice& choice : chosen)
            problem_.kinds[choice.kind].candidates->addTo(seen, choice.candidate);
        std::vector<std::uint32_t> cells;
        for (std::uint32_t cell = 0; cell < problem_.cells(); ++cell) {
            const bool is_achieved = !problem_.achieved.empty() && problem_.achieved[cell] > 0;
            if (problem_.weights[cell] > 0 && !is_achieved && !seen.test(cell))
                cells.push_back(cell);
        }
        return cells;
    }
    /// Adds up to `count` of these cells, spread over those that few and that many see.
    void addRows(std::vector<std::uint32_t> cells, std::size_t count) {
        std::stable_sort(cells.begin(), cells.end(), [this](std::uint32_t a, std::uint32_t b) {
            return views_[a] < views_[b];
        });
        count = std::min(count, cells.size());
        for (std::size_t i = 0; i < count; ++i) rows_.push_back(cells[i * cells.size() / count]);
        std::sort(rows_.begin(), rows_.end());
        rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
    }
    /// Candidates that see the same rows are one column.
    SetCover columns() {
        std::vector<std::uint32_t> rank(problem_.cells() + 1);  // rows before a cell
        for (const std::uint32_t row : rows_) ++rank[row + 1];
        std::partial_sum(rank.begin(), rank.end(), rank.begin());
        std::map<std::vector<std::uint32_t>, std::pair<std::uint64_t, Choice>> best;
        for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
            const CandidateSet& set = *problem_.kinds[k].candidates;
            for (std::size_t i = 0; i < set.size(); ++i) {
                std::vector<std::uint32_t> seen;
                std::uint64_t cells = 0;
                set.forEachRun(i, [&](const CellRun& run) {
                    cells += run.end - run.first;
                    for (std::uint32_t r = rank[run.first]; r < rank[run.end]; ++r)
                        seen.push_back(r);
                });
                if (seen.empty()) continue;
                std::sort(seen.begin(), seen.end());
                auto [entry, is_new] = best.try_emplace(std::move(seen), cells, Choice{k, i});
                if (!is_new && cells > entry->second.first) entry->second = {cells, {k, i}};
            }
        }
        SetCover cover{rows_.size(), {}, {}};
        choices_.clear();
        for (auto& [seen, view] : best) {
            cover.columns.push_back(seen);
            cover.costs.push_back(1);
            choices_.push_back(view.second);
        }
        return cover;
    }
    [[nodiscard]] std::vector<Choice> choicesOf(const std::vector<std::uint32_t>& columns) const {
        std::vector<Choice> chosen;
        chosen.reserve(columns.size());
        for (const std::uint32_t column : columns) chosen.push_back(choices_[column]);
        return chosen;
    }

  private:
    const Problem& problem_;
    std::vector<int> views_;           // of each cell: candidates that see it
    std::vector<std::uint32_t> rows_;  // ascending
    std::vector<Choice> choices_;      // of the columns
};

}  // namespace

WholeCover coverAllCells(const Problem& problem, std::vector<Choice> start, bool proves,
                         Progress& progress) {
    constexpr int kRounds = 200;
    constexpr std::size_t kRowsPerRound = 20;
    CoverRounds rounds(problem, start);
    WholeCover best{std::move(start), 1};
    for (int round = 0; round < kRounds && !progress.stopped(); ++round) {
        const SetCoverResult result = minimumSetCover(
            rounds.columns(), {.steps = 5'000, .tries = 2, .proves = proves}, progress);
        best.bound = std::max<std::size_t>(best.bound, result.bound);
        if (best.bound >= best.chosen.size()) break;
        const std::vector<Choice> chosen = rounds.choicesOf(result.chosen);
        std::vector<std::uint32_t> uncovered = rounds.uncovered(chosen);
        if (uncovered.empty()) {
            if (chosen.size() < best.chosen.size() && isWithinLimits(problem, chosen))
                best.chosen = chosen;
            break;
        }
        rounds.addRows(std::move(uncovered), kRowsPerRound);
    }
    return best;
}

}  // namespace ispace
