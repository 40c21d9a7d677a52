// SPDX-License-Identifier: GPL-3.0-or-later
// Local search for set covers by weights of rows. Rows that stay uncovered gain weight, so that the
// search leaves local optima without random restarts. Scores of columns are updated from the rows
// that change.
#include <algorithm>
#include <cstddef>

#include "arrange/search/cover_core.h"
#include "base/random.h"

namespace ispace {

namespace {

/// One local search (Gao, Weise & Li, An efficient local search heuristic with row weighting for
/// the unicost set covering problem, 2015; with scores per cost).
class RowWeightSearch {
  public:
    RowWeightSearch(const CoverCore& core, std::uint64_t seed)
        : core_(core),
          random_(mixedBits(seed)),
          weight_(core.rows(), 1),
          covered_(core.rows()),
          score_(core.columns()),
          place_(core.columns(), kOut),
          moved_(core.columns()),
          may_enter_(core.columns(), 1),
          open_place_(core.rows()) {
        for (std::uint32_t row = 0; row < core.rows(); ++row) {
            open_place_[row] = row;
            open_.push_back(row);
        }
        for (std::size_t j = 0; j < core.columns(); ++j)
            score_[j] = static_cast<std::int64_t>(core.rowsOf(j).size());
    }

    std::vector<std::uint32_t> run(std::uint64_t steps, double enough, const Progress& progress) {
        while (!open_.empty()) enter(bestOfAll());
        std::vector<std::uint32_t> best = chosen_;
        double best_cost = cost_;
        for (std::uint64_t step = 1; step <= steps; ++step) {
            while (open_.empty()) {
                best = chosen_;
                best_cost = cost_;
                if (best_cost <= enough) return best;
                leave(leastLoss(kNone));
                if (chosen_.empty()) return best;
            }
            if (step % 64 == 0 && progress.stopped()) return best;
            const std::uint32_t out = leastLoss(last_);
            if (out != kNone) leave(out, step);
            while (!open_.empty()) {
                const std::uint32_t in = entrant();
                if (in == kNone || cost_ + core_.cost[in] >= best_cost) break;
                enter(in, step);
                last_ = in;
            }
            for (const std::uint32_t row : open_) addWeight(row);
        }
        return best;
    }

  private:
    static constexpr std::uint32_t kOut = ~std::uint32_t{0}, kNone = kOut;

    /// Gain or loss of weight per cost.
    [[nodiscard]] double rate(std::uint32_t j) const {
        return static_cast<double>(score_[j]) / core_.cost[j];
    }
    [[nodiscard]] std::uint32_t bestOfAll() const {
        std::uint32_t best = 0;
        for (std::uint32_t j = 1; j < core_.columns(); ++j)
            if (place_[j] == kOut && (place_[best] != kOut || rate(j) > rate(best))) best = j;
        return best;
    }
    /// The chosen column with the least loss, the oldest among equals.
    [[nodiscard]] std::uint32_t leastLoss(std::uint32_t tabu) const {
        std::uint32_t best = kNone;
        for (const std::uint32_t j : chosen_) {
            if (j == tabu) continue;
            const double own = rate(j), least = best == kNone ? 0 : rate(best);
            if (best == kNone || own < least || (own == least && moved_[j] < moved_[best]))
                best = j;
        }
        return best;
    }
    /// The best column of a random open row.
    std::uint32_t entrant() {
        random_ = mixedBits(random_);
        const std::uint32_t row = open_[random_ % open_.size()];
        std::uint32_t best = kNone;
        for (const std::uint32_t j : core_.columnsOf(row)) {
            if (may_enter_[j] == 0) continue;
            if (best == kNone || rate(j) > rate(best) ||
                (rate(j) == rate(best) && moved_[j] < moved_[best]))
                best = j;
        }
        return best;
    }
    void enter(std::uint32_t j, std::uint64_t step = 0) {
        place_[j] = static_cast<std::uint32_t>(chosen_.size());
        chosen_.push_back(j);
        cost_ += core_.cost[j];
        moved_[j] = step;
        for (const std::uint32_t row : core_.rowsOf(j)) {
            if (++covered_[row] == 1) {
                close(row);
                for (const std::uint32_t other : core_.columnsOf(row)) {
                    may_enter_[other] = 1;
                    if (other != j) score_[other] -= weight_[row];
                }
            } else if (covered_[row] == 2) {
                for (const std::uint32_t other : core_.columnsOf(row))
                    if (other != j && place_[other] != kOut) score_[other] -= weight_[row];
            }
        }
        score_[j] = lossOf(j);
    }
    void leave(std::uint32_t j, std::uint64_t step = 0) {
        const std::uint32_t last = chosen_.back();
        chosen_[place_[j]] = last;
        place_[last] = place_[j];
        chosen_.pop_back();
        place_[j] = kOut;
        cost_ -= core_.cost[j];
        moved_[j] = step;
        std::int64_t gain = 0;
        for (const std::uint32_t row : core_.rowsOf(j)) {
            if (--covered_[row] == 0) {
                gain += weight_[row];
                open_place_[row] = static_cast<std::uint32_t>(open_.size());
                open_.push_back(row);
                for (const std::uint32_t other : core_.columnsOf(row)) {
                    may_enter_[other] = 1;
                    if (other != j) score_[other] += weight_[row];
                }
            } else if (covered_[row] == 1) {
                for (const std::uint32_t other : core_.columnsOf(row))
                    if (place_[other] != kOut) score_[other] += weight_[row];
            }
        }
        score_[j] = gain;
        may_enter_[j] = 0;
    }
    /// Weight of the rows that a chosen column alone covers.
    [[nodiscard]] std::int64_t lossOf(std::uint32_t j) const {
        std::int64_t loss = 0;
        for (const std::uint32_t row : core_.rowsOf(j))
            if (covered_[row] == 1) loss += weight_[row];
        return loss;
    }
    void close(std::uint32_t row) {
        const std::uint32_t last = open_.back();
        open_[open_place_[row]] = last;
        open_place_[last] = open_place_[row];
        open_.pop_back();
    }
    void addWeight(std::uint32_t row) {
        ++weight_[row];
        for (const std::uint32_t j : core_.columnsOf(row)) ++score_[j];
    }

    const CoverCore& core_;
    std::uint64_t random_;
    std::vector<std::int64_t> weight_;
    std::vector<std::uint32_t> covered_;  // by how many chosen columns
    std::vector<std::int64_t> score_;     // weight gained by entering, or lost by leaving
    std::vector<std::uint32_t> place_;    // in chosen_
    std::vector<std::uint64_t> moved_;    // the step
    std::vector<char> may_enter_;         // a neighbour has moved since it left
    std::vector<std::uint32_t> open_place_, open_, chosen_;
    std::uint32_t last_ = kNone;
    double cost_ = 0;
};

}  // namespace

std::vector<std::uint32_t> coverByWeights(const CoverCore& core, std::uint64_t steps,
                                          std::uint64_t seed, double enough,
                                          const Progress& progress) {
    return RowWeightSearch(core, seed).run(steps, enough, progress);
}

}  // namespace ispace
