// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/cost_levels.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace ispace {
namespace {

constexpr std::size_t kMaxLevels = 4'000;

}  // namespace

CostLevels::CostLevels(const std::vector<Kind>& kinds, double most) {
    for (const Kind& kind : kinds) {
        // 1, 2, 4, ... and the rest: they make up any number, and equal sums never pile up.
        auto left =
            std::min(static_cast<std::size_t>(std::max(kind.most, 0)), kind.candidates->size());
        for (std::size_t count = 1; left > 0; count *= 2) {
            count = std::min(count, left);
            left -= count;
            mayAdd(count, kind.cost, most);
            if (levels_.size() > kMaxLevels) {
                setEven(most);
                return;
            }
        }
    }
}

void CostLevels::mayAdd(std::size_t count, double cost, double most) {
    const double more = static_cast<double>(count) * cost;
    std::vector<Level> dearer;
    dearer.reserve(levels_.size());
    for (const Level& level : levels_) {
        if (isCheaper(most, level.least + more)) break;
        dearer.push_back({level.least + more, level.most + more});
    }
    std::vector<Level> both;
    both.reserve(levels_.size() + dearer.size());
    std::merge(levels_.begin(), levels_.end(), dearer.begin(), dearer.end(),
               std::back_inserter(both),
               [](const Level& a, const Level& b) { return a.least < b.least; });
    levels_.clear();
    for (const Level& level : both) {
        if (levels_.empty() || isCheaper(levels_.back().most, level.least))
            levels_.push_back(level);
        else
            levels_.back().most = std::max(levels_.back().most, level.most);
    }
}

void CostLevels::setEven(double most) {
    is_even_ = true;
    const double unit = std::pow(10, std::floor(std::log10(most)) - 5);
    levels_.resize(kMaxLevels + 1);
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const double multiplicity = static_cast<double>(i) / static_cast<double>(kMaxLevels);
        const double cost = normaliseCost(std::floor(most * multiplicity / unit) * unit);
        levels_[i] = {cost, cost};
    }
}

std::size_t CostLevels::below(double cost) const {
    const auto end =
        std::partition_point(levels_.begin() + 1, levels_.end(),
                             [cost](const Level& level) { return isCheaper(level.most, cost); });
    return static_cast<std::size_t>(end - levels_.begin()) - 1;
}

double CostLevels::above(std::size_t i) const {
    if (is_even_) return levels_[i].most;
    if (i + 1 < levels_.size()) return levels_[i + 1].least;
    return std::numeric_limits<double>::infinity();
}

}  // namespace ispace
