// SPDX-License-Identifier: GPL-3.0-or-later
// Cells in fine units, ways to spend a budget, and the search for multipliers.
//
// Weights are scaled by the largest factor for which their sum fits in 32 bits, so that whole
// multipliers are fine enough. A budget
// allows up to 20 000 combinations of counts, which are listed; beyond, a fractional knapsack
// bounds them. Multipliers move by the volume algorithm (F. Barahona, R. Anbil, The volume
// algorithm: producing primal solutions with a subgradient method, 2000), in sums of a fixed order:
// results do not depend on threads or vector widths.
#include "arrange/search/relaxation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/simd.h"

namespace ispace {

namespace {

constexpr std::size_t kMaxPaths = 20'000;

/// Computes the largest multiplicity that all sensors together can give a cell.
std::uint64_t maxMultiplicityOf(const Problem& problem) {
    std::uint64_t multiplicities = 0;
    for (const SensorType& kind : problem.kinds) {
        auto most =
            std::min(static_cast<std::size_t>(std::max(kind.most, 0)), kind.candidates->size());
        if (problem.budget) most = affordableCount(*problem.budget, 0, kind.cost, most);
        multiplicities += most * static_cast<std::uint64_t>(kind.multiplicity);
    }
    return multiplicities;
}

}  // namespace

RelaxedCells::RelaxedCells(const Problem& problem)
    : weights(problem.cells()), needs(problem.cells(), 1) {
    const std::uint64_t total = std::max<std::uint64_t>(problem.totalWeight(), 1);
    scale = static_cast<std::uint32_t>(
        std::max<std::uint64_t>(std::numeric_limits<std::uint32_t>::max() / total, 1));
    int common = 0;
    for (const SensorType& kind : problem.kinds) common = std::gcd(common, kind.multiplicity);
    common = std::max(common, 1);
    multiplicities.reserve(problem.kinds.size());
    for (const SensorType& kind : problem.kinds)
        multiplicities.push_back(static_cast<std::uint16_t>(kind.multiplicity / common));
    const std::uint64_t max_multiplicity = maxMultiplicityOf(problem);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const int achieved = problem.achieved.empty() ? 0 : problem.achieved[i];
        const std::uint32_t weight = problem.weights[i] * scale;
        if (achieved >= problem.required) {
            settled += weight;
            continue;
        }
        if (static_cast<std::uint64_t>(problem.required - achieved) > max_multiplicity) continue;
        weights[i] = weight;
        needs[i] = static_cast<std::uint16_t>((problem.required - achieved + common - 1) / common);
    }
}

CountChoice::CountChoice(const Problem& problem) {
    if (problem.budget) budget_ = *problem.budget;
    const std::size_t kinds = problem.kinds.size();
    costs_.reserve(kinds);
    most_.reserve(kinds);
    for (std::size_t k = 0; k < kinds; ++k) {
        costs_.push_back(problem.kinds[k].cost);
        most_.push_back(std::min(static_cast<std::size_t>(std::max(problem.kinds[k].most, 0)),
                                 problem.kinds[k].candidates->size()));
        most_[k] = fitting(k, 0);
    }
    double cost = 0;
    for (std::size_t k = 0; k < kinds; ++k) cost += costs_[k] * static_cast<double>(most_[k]);
    if (!isCheaper(budget_, cost)) {
        ways_ = {most_};
        total_ = std::accumulate(most_.begin(), most_.end(), std::size_t{0});
        return;
    }
    std::vector<std::size_t> counts(kinds, 0);
    list(counts, 0, 0);
    // The cheapest first yields the most sensors.
    std::vector<std::size_t> order(kinds);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return costs_[a] < costs_[b]; });
    double spent = 0;
    for (const std::size_t kind : order) {
        const std::size_t count = fitting(kind, spent);
        spent += static_cast<double>(count) * costs_[kind];
        total_ += count;
    }
    if (!is_listed_) ways_.clear();
}

std::size_t CountChoice::fitting(std::size_t kind, double spent) const {
    return affordableCount(budget_, spent, costs_[kind], most_[kind]);
}

void CountChoice::list(std::vector<std::size_t>& counts, std::size_t kind, double spent) {
    if (!is_listed_) return;
    // Sums kind by kind, as costOf does: feasible counts are among the ways.
    const std::size_t most = fitting(kind, spent);
    if (kind + 1 == counts.size()) {
        counts[kind] = most;
        ways_.push_back(counts);
        is_listed_ = ways_.size() <= kMaxPaths;
        return;
    }
    for (std::size_t n = most + 1; n-- > 0;) {
        counts[kind] = n;
        list(counts, kind + 1, spent + static_cast<double>(n) * costs_[kind]);
    }
}

CountChoice::Best CountChoice::best(std::span<const std::vector<std::uint64_t>> sums) const {
    const std::size_t kinds = sums.size();
    Best best;
    best.with.assign(kinds, 0);
    best.may.assign(kinds, 0);
    const auto up_to = [&sums](std::size_t kind, std::size_t count) {
        return sums[kind][std::min(count, sums[kind].size() - 1)];
    };
    if (!is_listed_) {
        best.value = knapsack(sums, best.counts);
        for (std::size_t k = 0; k < kinds; ++k) best.may[k] = most_[k] > 0 ? 1 : 0;
        best.with.assign(kinds, best.value);
        return best;
    }
    for (const auto& way : ways_) {
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < kinds; ++k) value += up_to(k, way[k]);
        if (best.counts.empty() || value > best.value) {
            best.value = value;
            best.counts = way;
        }
        for (std::size_t k = 0; k < kinds; ++k) {
            if (way[k] == 0) continue;
            best.may[k] = 1;
            best.with[k] = std::max(best.with[k], value - up_to(k, way[k]) + up_to(k, way[k] - 1));
        }
    }
    for (std::size_t k = 0; k < kinds; ++k)
        best.counts[k] = std::min(best.counts[k], sums[k].size() - 1);
    return best;
}

std::uint64_t CountChoice::knapsack(std::span<const std::vector<std::uint64_t>> sums,
                                    std::vector<std::size_t>& counts) const {
    struct Item {
        double per_cost, weigh;
        std::size_t kind;
    };
    std::vector<Item> items;
    for (std::size_t k = 0; k < sums.size(); ++k)
        for (std::size_t n = 1; n < sums[k].size(); ++n) {
            const auto weigh = static_cast<double>(sums[k][n] - sums[k][n - 1]);
            items.push_back({weigh / costs_[k], weigh, k});
        }
    std::stable_sort(items.begin(), items.end(),
                     [](const Item& a, const Item& b) { return a.per_cost > b.per_cost; });
    counts.assign(sums.size(), 0);
    double spent = 0, value = 0;
    for (const Item& item : items) {
        const double cost = costs_[item.kind];
        if (isCheaper(budget_, spent + cost)) {
            value += item.weigh * std::max(0.0, budget_ - spent) / cost;
            break;
        }
        value += item.weigh;
        spent += cost;
        ++counts[item.kind];
    }
    // Rounding errors, of costs and of values, are far below 1e-9 of the sum.
    return static_cast<std::uint64_t>(std::ceil(value * (1 + 1e-9))) + 1;
}

namespace {

constexpr std::size_t kLanes = 16;  // sums in a fixed order that vectorises

float total(const float (&lanes)[kLanes]) {
    float sum = 0;
    for (const float lane : lanes) sum += lane;
    return sum;
}

/// Limits of a step along a direction: squares of the deficits, without cells at their limits.
struct Lack {
    float average = 0, fresh = 0, both = 0;
};
ISPACE_SIMD_CLONES Lack lackOf(const std::uint32_t* weights, const std::uint32_t* at,
                               const float* average, const float* cover, std::size_t cells) {
    constexpr float kFar = std::numeric_limits<float>::max();
    float average_lanes[kLanes] = {}, fresh_lanes[kLanes] = {}, both_lanes[kLanes] = {};
    const std::size_t whole = cells / kLanes * kLanes;
    // Selections, no branches: only these vectorise.
    const auto add = [&](std::size_t i, std::size_t lane) {
        const float least = at[i] == 0 ? 0.0F : -kFar, most = at[i] == weights[i] ? 0.0F : kFar;
        const float old = 1.0F - average[i], fresh = 1.0F - cover[i];
        const float old_up = old < least ? least : old, fresh_up = fresh < least ? least : fresh;
        const float old_free = old_up > most ? most : old_up;
        const float fresh_free = fresh_up > most ? most : fresh_up;
        average_lanes[lane] += old_free * old_free;
        fresh_lanes[lane] += fresh_free * fresh_free;
        both_lanes[lane] += old_free * fresh_free;
    };
    for (std::size_t i = 0; i < whole; i += kLanes)
        for (std::size_t lane = 0; lane < kLanes; ++lane) add(i + lane, lane);
    for (std::size_t i = whole; i < cells; ++i) add(i, i - whole);
    return {total(average_lanes), total(fresh_lanes), total(both_lanes)};
}

ISPACE_SIMD_CLONES void mix(float* average, const float* cover, float part, std::size_t cells) {
    for (std::size_t i = 0; i < cells; ++i) average[i] += part * (cover[i] - average[i]);
}

/// Whole numbers below 2^31 convert as `Int` = std::int32_t, several times as fast as others.
template <typename Int>
inline void moveAs(const std::uint32_t* weights, const std::uint32_t* at, const float* average,
                   float length, std::uint32_t* trial, std::size_t cells) {
    for (std::size_t i = 0; i < cells; ++i) {
        const auto top = static_cast<double>(static_cast<Int>(weights[i]));
        const double to = static_cast<double>(static_cast<Int>(at[i])) +
                          static_cast<double>(length * (1.0F - average[i]));
        const double up = to < 0.0 ? 0.0 : to;
        const double within = up > top ? top : up;
        trial[i] = static_cast<std::uint32_t>(static_cast<Int>(within));
    }
}
ISPACE_SIMD_CLONES void moveSmall(const std::uint32_t* weights, const std::uint32_t* at,
                                  const float* average, float length, std::uint32_t* trial,
                                  std::size_t cells) {
    moveAs<std::int32_t>(weights, at, average, length, trial, cells);
}

}  // namespace

MultiplierSearch::MultiplierSearch(std::span<const std::uint32_t> weights,
                                   std::vector<std::uint32_t> start, double target,
                                   const SearchPace& pace)
    : weights_(weights),
      target_(target),
      pace_(pace),
      factor_(pace.factor),
      is_small_(std::all_of(weights.begin(), weights.end(),
                            [](std::uint32_t weight) { return weight < 1U << 31U; })),
      trial_(std::move(start)) {}

void MultiplierSearch::restart(double bound, std::span<const float> cover) {
    bound_ = bound;
    trial_ = best_;
    mix(average_.data(), cover.data(), static_cast<float>(mixing_), cover.size());
    step();
}

void MultiplierSearch::report(double bound, std::span<const float> cover) {
    if (best_.empty()) {
        bound_ = bound;
        best_ = trial_;
        average_.assign(cover.begin(), cover.end());
        step();
        return;
    }
    // Finds the mixture of old average and new subgradient with the least deficit.
    const Lack lack =
        lackOf(weights_.data(), best_.data(), average_.data(), cover.data(), cover.size());
    const double along = static_cast<double>(lack.average) - static_cast<double>(lack.both);
    const double across = along + static_cast<double>(lack.fresh) - static_cast<double>(lack.both);
    const double part = across > 0 ? along / across : 0.0;
    part_ = std::clamp(part, mixing_ * pace_.least_part, mixing_);
    mix(average_.data(), cover.data(), static_cast<float>(part_), cover.size());
    if (bound < bound_) {
        if (lack.both > 0) factor_ = std::min(factor_ * 1.2, 2.0);
        bound_ = bound;
        best_.swap(trial_);
        failures_ = 0;
    } else if (++failures_ >= 3) {
        factor_ *= 0.66;
        failures_ = 0;
    }
    settle();
    step();
}

void MultiplierSearch::settle() {
    constexpr double kLittle = 0.02;  // of the distance to the target
    constexpr double kLess = 0.7, kMinValue = 0.005;
    if (pace_.patience == 0 || ++reports_ % pace_.patience != 0) return;
    if (settled_ - bound_ < kLittle * (bound_ - target_))
        mixing_ = std::max(mixing_ * kLess, kMinValue);
    settled_ = bound_;
}

void MultiplierSearch::step() {
    const Lack lack =
        lackOf(weights_.data(), best_.data(), average_.data(), average_.data(), average_.size());
    const double above = std::max(bound_ - target_, bound_ * 1e-5);
    const double length =
        lack.average > 0 ? factor_ * above / static_cast<double>(lack.average) : 0.0;
    trial_.resize(best_.size());
    const auto move = is_small_ ? moveSmall : moveAs<std::int64_t>;
    move(weights_.data(), best_.data(), average_.data(), static_cast<float>(length), trial_.data(),
         trial_.size());
}

}  // namespace ispace
