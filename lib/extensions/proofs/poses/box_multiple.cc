// SPDX-License-Identifier: GPL-3.0-or-later
// Floor that several sensors see at a time, for the check of certificates.
#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>

#include "extensions/proofs/poses/box_views.h"

namespace ispace::proofs::poses {

namespace {

constexpr std::size_t kMaxSensors = 4;
constexpr int kWhole = 12;  // prices are in twelfths: a half, a third and a quarter are whole
using Weights = std::array<int, kMaxSensors>;

/// Lists the weights by which the sensors of a subset have a share each, the others none.
/// \param share_of (number of the others) returns the share; 0: the subset is left out
template <typename ShareOf>
void addSubsets(std::size_t sensors, ShareOf share_of, std::vector<Weights>& all) {
    for (unsigned subset = (1U << sensors) - 1; subset > 0; --subset) {
        const auto size = static_cast<std::size_t>(std::popcount(subset));
        const std::size_t share = share_of(sensors - size);
        if (share == 0) continue;
        Weights weights{};
        for (std::size_t i = 0; i < sensors; ++i)
            if ((subset >> i & 1U) != 0) weights[i] = kWhole / static_cast<int>(share);
        all.push_back(weights);
    }
}

/// Views and cores of the sensors in the cells from `first` on.
struct Spread {
    std::size_t first = 0, count = 0;
    std::array<std::vector<std::uint16_t>, kMaxSensors> fat, core;
    std::vector<std::int32_t> least, sum;

    template <typename View>
    void put(const View& view, std::vector<std::uint16_t>& all) const {
        all.assign(count, 0);
        if (!view.parts.empty())
            std::copy(view.parts.begin(), view.parts.end(),
                      all.begin() + static_cast<std::ptrdiff_t>(view.first - first));
    }
};

void addTimes(int factor, const std::vector<std::uint16_t>& parts, std::vector<std::int32_t>& sum) {
    if (factor == 0) return;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * parts[i];
}

/// Bounds it by areas alone: all sensors but some few see this floor often enough without those.
double ofAreas(std::span<const BoxViews::Placed> sensors, std::size_t times) {
    std::vector<double> areas;
    for (const BoxViews::Placed& sensor : sensors) areas.push_back(sensor.most);
    std::sort(areas.begin(), areas.end());
    double sum = std::accumulate(areas.begin(), areas.end(), 0.0);
    double bound = std::numeric_limits<double>::infinity();
    for (; times > 0; --times) {
        bound = std::min(bound, sum / static_cast<double>(times));
        sum -= areas.back();
        areas.pop_back();
    }
    return bound;
}

}  // namespace

/// Floor that `times` of n sensors see, at least `times - k` of any n - k of them see: each subset
/// bounds it in a cell by the sum of its views over that share. Prices, any weights, move area
/// between the sensors' proven areas and the cells: bound = sum of price * area + sum over cells of
/// min over subsets of (weight - price) * view, with the core for the view where that is negative.
double BoxViews::sharedBy(std::span<const Placed> sensors, std::size_t times, double enough) const {
    thread_local Spread spread;           // memory is reused
    thread_local std::size_t likely = 0;  // prices that sufficed last time
    if (ofAreas(sensors, times) <= enough) return ofAreas(sensors, times);
    std::vector<Weights> prices = {{}}, in_cell;
    for (std::size_t share = times; share > 0; --share)
        addSubsets(
            sensors.size(), [share](std::size_t) { return share; }, prices);
    addSubsets(
        sensors.size(), [times](std::size_t others) { return others < times ? times - others : 0; },
        in_cell);
    spread.first = most_.size();
    std::size_t end = 0;
    for (const Placed& sensor : sensors) {
        const BoxView& view = *sensor.view;
        if (view.parts.empty()) continue;
        spread.first = std::min(spread.first, view.first);
        end = std::max(end, view.first + view.parts.size());
    }
    if (end == 0) return 0;
    spread.count = end - spread.first;
    // A core is in the view, but for roundings.
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        spread.put(*sensors[i].view, spread.fat[i]);
        BoxCore core = *sensors[i].core;
        if (!core.parts.empty() &&
            (core.first < spread.first || core.first + core.parts.size() > end))
            core = {};
        spread.put(core, spread.core[i]);
    }
    const auto bound_for = [&](const Weights& price) {
        double area = 2.0 * kMaxSensors * kWhole * kNoShare * static_cast<double>(most_.size()) *
                      side_ * side_ * most_weight_;
        for (std::size_t i = 0; i < sensors.size(); ++i) area += price[i] * sensors[i].most;
        spread.least.assign(spread.count, 0);
        for (std::size_t i = 0; i < spread.count; ++i)
            spread.least[i] = kWhole * most_[spread.first + i];
        for (std::size_t i = 0; i < sensors.size(); ++i)
            addTimes(-price[i], spread.core[i], spread.least);
        for (const Weights& own : in_cell) {
            spread.sum.assign(spread.count, 0);
            for (std::size_t i = 0; i < sensors.size(); ++i)
                addTimes(own[i] - price[i], own[i] > price[i] ? spread.fat[i] : spread.core[i],
                         spread.sum);
            for (std::size_t i = 0; i < spread.count; ++i)
                spread.least[i] = std::min(spread.least[i], spread.sum[i]);
        }
        const double sum = weigh([&](std::size_t first, std::size_t count) {
            std::int64_t parts = 0;
            const std::size_t from = std::max(first, spread.first);
            const std::size_t to = std::min(first + count, end);
            for (std::size_t i = from; i < to; ++i) parts += spread.least[i - spread.first];
            return parts;
        });
        return (area + sum / kParts) / kWhole;
    };
    double bound = ofAreas(sensors, times);
    for (std::size_t i = 0; i < prices.size(); ++i) {
        const std::size_t next = (i + likely) % prices.size();
        bound = std::min(bound, bound_for(prices[next]));
        if (bound > enough) continue;
        likely = next;
        return enough;  // the bound itself depends on the price, and so on earlier calls
    }
    return bound;
}

}  // namespace ispace::proofs::poses
