// SPDX-License-Identifier: GPL-3.0-or-later
// Floor that at least t of n sensors see. Three bounds, of which the least counts: by single views
// (the sum of all but the largest j over t - j), by cells (the t-th largest fat view), and by
// prices of cores.
#include "extensions/proofs/poses/multiple_bound.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>

#include "base/simd.h"

namespace ispace::proofs::poses {

struct MultipleBound::Dense {
    std::array<std::vector<std::uint8_t>, kMaxBoxes> fat, core;
    std::vector<std::int16_t> least;
};

namespace {

/// Writes `unit` times `most`, less the cores by their prices.
ISPACE_SIMD_CLONES void takeCores(std::int16_t* __restrict least, const std::uint8_t* most,
                                  const std::array<const std::uint8_t*, kMaxBoxes>& core,
                                  const std::array<std::int16_t, kMaxBoxes>& price,
                                  std::int16_t unit, std::size_t count) {
    const std::uint8_t *a = core[0], *b = core[1], *c = core[2], *d = core[3];
    const int pa = price[0], pb = price[1], pc = price[2], pd = price[3];
    for (std::size_t i = 0; i < count; ++i)
        least[i] = static_cast<std::int16_t>(unit * most[i] - pa * a[i] - pb * b[i] - pc * c[i] -
                                             pd * d[i]);
}

/// Lowers to a sum of views, by factors.
ISPACE_SIMD_CLONES void lowerTo(std::int16_t* __restrict least,
                                const std::array<const std::uint8_t*, kMaxBoxes>& view,
                                const std::array<std::int16_t, kMaxBoxes>& factor,
                                std::size_t count) {
    const std::uint8_t *a = view[0], *b = view[1], *c = view[2], *d = view[3];
    const int fa = factor[0], fb = factor[1], fc = factor[2], fd = factor[3];
    for (std::size_t i = 0; i < count; ++i) {
        const auto sum = static_cast<std::int16_t>(fa * a[i] + fb * b[i] + fc * c[i] + fd * d[i]);
        least[i] = sum < least[i] ? sum : least[i];
    }
}

ISPACE_SIMD_CLONES std::int32_t sumOfLeast(const std::int16_t* least, std::size_t count) {
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += least[i];
    return sum;
}

/// Moves the larger values to `high`, the smaller ones to `low`.
ISPACE_SIMD_CLONES void sortInto(std::uint8_t* __restrict high, std::uint8_t* __restrict low,
                                 std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t a = high[i], b = low[i];
        high[i] = a > b ? a : b;
        low[i] = a > b ? b : a;
    }
}

void spread(const CellParts& view, std::size_t cells, std::vector<std::uint8_t>& all) {
    all.assign(cells, 0);
    std::copy(view.parts.begin(), view.parts.end(),
              all.begin() + static_cast<std::ptrdiff_t>(view.first));
}

}  // namespace

MultipleBound::MultipleBound(const PoseFloor& floor, const PoseBoxes& boxes, std::size_t sensors,
                             std::size_t times)
    : floor_(floor), boxes_(boxes), sensors_(sensors), times_(times) {
    const unsigned everyone = (1U << sensors) - 1;
    const auto priced = [this](unsigned chosen, std::size_t share) {
        Prices prices{};
        for (std::size_t i = 0; i < sensors_; ++i)
            if ((chosen >> i & 1U) != 0)
                prices[i] = static_cast<std::int16_t>(kUnit / static_cast<int>(share));
        return prices;
    };
    for (unsigned chosen = everyone + 1; chosen-- > 0;) {
        const auto free = sensors - static_cast<std::size_t>(std::popcount(chosen));
        if (free < times) cell_prices_.push_back(priced(chosen, times - free));
        if (chosen == 0) prices_.push_back({});
        for (std::size_t share = times; share > 0 && chosen != 0; --share)
            prices_.push_back(priced(chosen, share));
    }
}

double MultipleBound::ofSingles(std::span<const BoxId> boxes) const {
    std::array<double, kMaxBoxes> most{};
    for (std::size_t i = 0; i < sensors_; ++i) most[i] = boxes_[boxes[i]].most;
    std::sort(most.begin(), most.begin() + static_cast<std::ptrdiff_t>(sensors_));
    // All but the largest j see the floor times - j times.
    double bound = std::numeric_limits<double>::infinity(), sum = 0;
    for (std::size_t i = 0; i < sensors_; ++i) {
        sum += most[i];
        if (i + times_ >= sensors_)
            bound = std::min(bound, sum / static_cast<double>(i + times_ - sensors_ + 1));
    }
    return bound;
}

double MultipleBound::boundFor(const Prices& prices, std::span<const BoxId> boxes, Grain grain,
                               Dense& views) const {
    const std::vector<std::uint8_t>& most = floor_.in(grain).parts();
    const std::size_t cells = most.size();
    std::array<const std::uint8_t*, kMaxBoxes> fat{}, core{};
    double area = 0;
    for (std::size_t i = 0; i < kMaxBoxes; ++i) {
        fat[i] = views.fat[i].data();
        core[i] = views.core[i].data();
        if (i < sensors_) area += prices[i] * boxes_[boxes[i]].most;
    }
    views.least.resize(cells);
    takeCores(views.least.data(), most.data(), core, prices, kUnit, cells);
    for (const Prices& cell_prices : cell_prices_) {
        Prices factors{};
        std::array<const std::uint8_t*, kMaxBoxes> view = fat;
        for (std::size_t i = 0; i < sensors_; ++i) {
            factors[i] = static_cast<std::int16_t>(cell_prices[i] - prices[i]);
            if (factors[i] < 0) view[i] = core[i];
        }
        lowerTo(views.least.data(), view, factors, cells);
    }
    // Cores are rounded down but for kNoShare of a cell.
    area += 2.0 * kUnit * kMaxBoxes * kNoShare * kParts * floor_.in(grain).partArea() *
            floor_.mostWeight() * static_cast<double>(cells);
    return (area + floor_.in(grain).weightOf([&views](std::size_t first, std::size_t count) {
               return sumOfLeast(&views.least[first], count);
           })) /
           kUnit;
}

double MultipleBound::of(std::span<const BoxId> boxes, double enough) const {
    double bound = ofSingles(boxes);
    if (bound <= enough) return bound;
    bound = std::min(bound, boundIn(Grain::Large, boxes, enough));
    return boxes_.isWorthFine(bound, enough, boxes)
               ? std::min(bound, boundIn(Grain::Fine, boxes, enough))
               : bound;
}

double MultipleBound::boundIn(Grain grain, std::span<const BoxId> boxes, double enough) const {
    thread_local Dense views;  // memory is reused
    const std::size_t cells = floor_.in(grain).parts().size();
    for (std::size_t i = 0; i < kMaxBoxes; ++i) {
        spread(i < sensors_ ? boxes_[boxes[i]].fatIn(grain) : CellParts(), cells, views.fat[i]);
        spread(i < sensors_ ? boxes_[boxes[i]].coreIn(grain) : CellParts(), cells, views.core[i]);
    }
    double bound = std::numeric_limits<double>::infinity();
    for (const Prices& prices : prices_) {
        bound = std::min(bound, boundFor(prices, boxes, grain, views));
        if (bound <= enough) break;
    }
    return bound;
}

double MultipleBound::ofCentres(std::span<const BoxId> boxes) const {
    thread_local Dense views;  // memory is reused
    const std::size_t cells = floor_.in(Grain::Large).parts().size();
    // The largest values so far, in order: the view seen `times` times is the last of them.
    for (std::size_t rank = 0; rank < times_; ++rank) views.fat[rank].assign(cells, 0);
    std::vector<std::uint8_t>& view = views.core[0];
    for (const BoxId id : boxes) {
        spread(boxes_[id].centre, cells, view);
        for (std::size_t rank = 0; rank < times_; ++rank)
            sortInto(views.fat[rank].data(), view.data(), cells);
    }
    return floor_.in(Grain::Large).weightOf([&](std::size_t first, std::size_t count) {
        std::uint64_t sum = 0;
        for (std::size_t i = first; i < first + count; ++i) sum += views.fat[times_ - 1][i];
        return sum;
    });
}

}  // namespace ispace::proofs::poses
