// SPDX-License-Identifier: GPL-3.0-or-later
// The bound by sums over sensors. The set A of cells that count as floor is found by a subgradient
// method (N. Z. Shor, Minimization methods for non-differentiable functions, 1985): A holds the
// cells that the mean views fill. Any A bounds, so steps and 16-bit means may be coarse.
#include "extensions/proofs/poses/sum_bound.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "base/simd.h"

namespace ispace::proofs::poses {

namespace {

constexpr int kUnit = 32;  // mean views are in 1 / kUnit of a part

/// Sums parts of the cells for which `mask` is 255, with its bits flipped by `flip`.
ISPACE_SIMD_CLONES std::uint32_t sumMasked(const std::uint8_t* parts, const std::uint8_t* mask,
                                           std::uint8_t flip, std::size_t cells) {
    constexpr std::size_t kBlock = 64;  // the sum of its bytes fits 16 bits
    std::uint32_t sum = 0;
    std::size_t first = 0;
    for (; first + kBlock <= cells; first += kBlock) {
        std::uint16_t block = 0;
        for (std::size_t i = first; i < first + kBlock; ++i)
            block = static_cast<std::uint16_t>(
                block + static_cast<std::uint8_t>(parts[i] & (mask[i] ^ flip)));
        sum += block;
    }
    for (; first < cells; ++first)
        sum += static_cast<std::uint8_t>(parts[first] & (mask[first] ^ flip));
    return sum;
}

/// Sums parts of a view in cells from `first` on.
std::uint32_t sumWithin(const CellParts& view, const std::vector<std::uint8_t>& mask,
                        std::uint8_t flip, std::size_t first, std::size_t count) {
    const std::size_t begin = std::max(first, view.first);
    const std::size_t end = std::min(first + count, view.first + view.parts.size());
    return begin < end ? sumMasked(&view.parts[begin - view.first], &mask[begin], flip, end - begin)
                       : 0;
}

ISPACE_SIMD_CLONES void addHalf(std::int16_t* __restrict sums, const std::uint8_t* parts,
                                std::size_t cells) {
    for (std::size_t i = 0; i < cells; ++i)
        sums[i] = static_cast<std::int16_t>(sums[i] + kUnit / 2 * parts[i]);
}

/// Adds the mean of a fat view and a core.
void addMean(const BoxNode& node, std::vector<std::int16_t>& sums) {
    for (const CellParts* view : {&node.large_parts, &node.large_core})
        addHalf(&sums[view->first], view->parts.data(), view->parts.size());
}

/// Moves a mean of `count` - 1 sums to that of these and another one.
ISPACE_SIMD_CLONES void takeIntoMean(std::int16_t* __restrict mean, const std::int16_t* other,
                                     int count, std::size_t cells) {
    const float step = 1.0F / static_cast<float>(count);
    for (std::size_t i = 0; i < cells; ++i) {
        const auto way = static_cast<float>(other[i] - mean[i]);
        mean[i] = static_cast<std::int16_t>(mean[i] + static_cast<int>(way * step));
    }
}

/// Marks the cells that the mean does not fill.
ISPACE_SIMD_CLONES void markOutside(std::uint8_t* __restrict outside, const std::int16_t* mean,
                                    const std::uint8_t* most, int times, std::size_t cells) {
    const auto full = static_cast<std::int16_t>(times * kUnit);
    for (std::size_t i = 0; i < cells; ++i)
        outside[i] = static_cast<std::uint8_t>(
            mean[i] < static_cast<std::int16_t>(full * most[i]) ? 255 : 0);
}

}  // namespace

double SumBound::seenBy(BoxId box, const std::vector<std::uint8_t>& outside) const {
    const BoxNode& node = boxes_[box];
    if (node.isBlind()) return 0;
    double fat = 0, core = 0;
    floor_.forEachLayer([&](double weight, std::size_t first, std::size_t count) {
        fat += weight * sumWithin(node.large_parts, outside, 0, first, count);
        core += weight * sumWithin(node.large_core, outside, 255, first, count);
    });
    // Cores are rounded down but for kNoShare of a cell.
    const double rounding =
        kNoShare * kParts * floor_.mostWeight() * static_cast<double>(outside.size());
    return std::min(fat * floor_.partArea(), node.most - (core - rounding) * floor_.partArea());
}

std::pair<double, BoxId> SumBound::mostSeenBy(BoxId box, const std::vector<std::uint8_t>& outside,
                                              Wanted& wanted) const {
    constexpr int kMaxDepth = 9, kMaxVisits = 30;
    struct Part {
        double most;
        BoxId box;
        int depth;
        bool operator<(const Part& other) const {
            return most != other.most ? most < other.most : box > other.box;
        }
    };
    thread_local std::vector<Part> heap;  // memory is reused
    heap.assign(1, {seenBy(box, outside), box, 0});
    for (int visits = 0;; ++visits) {
        std::pop_heap(heap.begin(), heap.end());
        const Part part = heap.back();
        heap.pop_back();
        const BoxNode& node = boxes_[part.box];
        if (visits == kMaxVisits || part.depth == kMaxDepth || node.isBlind())
            return {part.most, part.box};
        const BoxId child = node.child;
        if (child == 0 || !boxes_[child].hasLarge() || !boxes_[child + 1].hasLarge()) {
            if (child != 0 && (boxes_[child].is_bare || boxes_[child + 1].is_bare))
                wanted.bare.push_back(part.box);
            else if (child != 0 || boxes_.widestOf({&part.box, 1}) == 0)
                wanted.whole.push_back(part.box);
            return {part.most, part.box};
        }
        for (BoxId half = child; half < child + 2; ++half) boxes_[half].prefetchLarge();
        for (BoxId half = child; half < child + 2; ++half) {
            heap.push_back({std::min(part.most, seenBy(half, outside)), half, part.depth + 1});
            std::push_heap(heap.begin(), heap.end());
        }
    }
}

double SumBound::boundOf(const Bounded& tuple, double enough, Wanted& wanted) const {
    constexpr int kRounds = 2;
    constexpr double kHopeless = 1.03;                   // times the bound before
    thread_local std::vector<std::int16_t> mean, views;  // memory is reused
    thread_local std::vector<std::uint8_t> outside;
    const std::vector<std::uint8_t>& most = floor_.parts();
    mean.assign(most.size(), 0);
    outside.resize(most.size());
    for (const BoxId id : tuple.boxes) addMean(boxes_[id], mean);
    double bound = tuple.bound;
    for (int round = 1;; ++round) {
        markOutside(outside.data(), mean.data(), most.data(), static_cast<int>(times_),
                    most.size());
        double sum = 0;
        views.assign(most.size(), 0);
        for (const BoxId id : tuple.boxes) {
            const auto [seen, part] = mostSeenBy(id, outside, wanted);
            sum += seen;
            addMean(boxes_[part], views);
        }
        sum /= static_cast<double>(times_);
        floor_.forEachLayer([&](double weight, std::size_t first, std::size_t count) {
            sum +=
                weight * floor_.partArea() * sumMasked(&most[first], &outside[first], 255, count);
        });
        bound = std::min(bound, sum);
        if (bound <= enough || round == kRounds || sum > kHopeless * tuple.bound) return bound;
        takeIntoMean(mean.data(), views.data(), round + 1, most.size());
    }
}

void SumBound::lower(std::vector<Bounded>& tuples, double enough) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < tuples.size(); ++i)
        if (tuples[i].bound > enough && boxes_.areSmall(tuples[i].boxes)) open.push_back(i);
    std::vector<Wanted> wanted(open.size());
    std::vector<double> bounds(open.size());
    std::vector<BoxId> whole, bare;
    std::vector<std::size_t> again(open.size());  // not bounded yet, or without some views
    std::iota(again.begin(), again.end(), std::size_t{0});
    while (!again.empty()) {
        tbb::parallel_for(std::size_t{0}, again.size(), [&](std::size_t k) {
            const std::size_t i = again[k];
            wanted[i] = {};
            bounds[i] = boundOf(tuples[open[i]], enough, wanted[i]);
        });
        std::erase_if(again, [&](std::size_t i) { return wanted[i].bare.empty(); });
        bare.clear();
        for (const std::size_t i : again)
            bare.insert(bare.end(), wanted[i].bare.begin(), wanted[i].bare.end());
        boxes_.addLargeViews(bare);  // these change no bound of a box
    }
    for (std::size_t i = 0; i < open.size(); ++i) {
        tuples[open[i]].bound = bounds[i];
        whole.insert(whole.end(), wanted[i].whole.begin(), wanted[i].whole.end());
    }
    boxes_.splitWithLarge(std::move(whole));
}

}  // namespace ispace::proofs::poses
