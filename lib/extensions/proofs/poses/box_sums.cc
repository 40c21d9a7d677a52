// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of tuples by sums, for the check: as SumBound, by other code. Any choice of cells gives a
// valid bound, so the check need not make the choices of the search.
#include "extensions/proofs/poses/box_sums.h"

#include <algorithm>

namespace ispace::proofs::poses {

double BoxSums::outside(std::uint32_t box, const Marks& marks) const {
    const CheckedBox& own = boxes_[box];
    const auto sum = [&](const auto& view, char marked) {
        return floor_.weigh([&](std::size_t first, std::size_t count) {
            std::uint64_t parts = 0;
            const std::size_t begin = std::max(first, view.first);
            const std::size_t end = std::min(first + count, view.first + view.parts.size());
            for (std::size_t cell = begin; cell < end; ++cell)
                parts += marks[cell] == marked ? view.parts[cell - view.first] : 0U;
            return parts;
        }) / BoxViews::kParts;
    };
    // Cores are rounded down but for kNoShare of a cell.
    const double rounding = kNoShare * static_cast<double>(marks.size()) * floor_.side_ *
                            floor_.side_ * floor_.most_weight_;
    return std::min(sum(own.large_view, 0), own.most - sum(own.large_core, 1) + rounding);
}

void BoxSums::search(std::uint32_t box, double area, int depth, const Marks& marks,
                     Most& most) const {
    constexpr int kMaxDepth = 10;
    if (area <= most.area) return;
    const CheckedBox& own = boxes_[box];
    if (own.second == 0 || depth == kMaxDepth) {
        most = {area, box};
        return;
    }
    const double first = std::min(area, outside(box + 1, marks));
    const double second = std::min(area, outside(own.second, marks));
    if (first >= second) search(box + 1, first, depth + 1, marks, most);
    search(own.second, second, depth + 1, marks, most);
    if (first < second) search(box + 1, first, depth + 1, marks, most);
}

/// Adds a share of the mean of a fat view and a core.
void BoxSums::addTo(std::vector<double>& mean, std::uint32_t box, double share) const {
    const auto add = [&](const auto& view) {
        for (std::size_t i = 0; i < view.parts.size(); ++i)
            mean[view.first + i] += share / 2 * view.parts[i];
    };
    add(boxes_[box].large_view);
    add(boxes_[box].large_core);
}

double BoxSums::sumOf(std::span<const std::uint32_t> boxes, double enough) const {
    constexpr int kRounds = 4;
    const std::vector<std::uint16_t>& floor = floor_.most_;
    std::vector<double> mean(floor.size());
    for (const std::uint32_t box : boxes) addTo(mean, box, 1);
    Marks marks(floor.size());
    double bound = floor_.floorArea();
    for (int round = 1; round <= kRounds && bound > enough; ++round) {
        for (std::size_t cell = 0; cell < floor.size(); ++cell)
            marks[cell] = mean[cell] >= times_ * floor[cell] ? 1 : 0;
        double area = floor_.weigh([&](std::size_t first, std::size_t count) {
            std::uint64_t parts = 0;
            for (std::size_t cell = first; cell < first + count; ++cell)
                parts += marks[cell] != 0 ? floor[cell] : 0U;
            return parts;
        }) / BoxViews::kParts;
        const double share = 1.0 / (round + 1);
        for (double& cell : mean) cell *= 1 - share;
        for (const std::uint32_t box : boxes) {
            Most most;
            search(box, outside(box, marks), 0, marks, most);
            area += std::max(most.area, 0.0) / times_;
            addTo(mean, most.part, share);
        }
        bound = std::min(bound, area);
    }
    return bound;
}

double BoxSums::boundOf(std::span<const std::uint32_t> boxes, double enough, int halvings) const {
    const double bound = sumOf(boxes, enough);
    if (bound <= enough || halvings == 0) return bound;
    const auto size = [this](std::uint32_t id) {
        const PoseBox& box = boxes_[id].box;
        return boxes_[id].second == 0 ? -1
                                      : box.at.width() * box.at.depth() * std::max(box.span, 1e-3);
    };
    const auto largest =
        std::max_element(boxes.begin(), boxes.end(),
                         [size](std::uint32_t a, std::uint32_t b) { return size(a) < size(b); });
    const std::uint32_t second = boxes_[*largest].second;
    if (second == 0) return bound;
    double most = 0;
    for (const std::uint32_t half : {*largest + 1, second}) {
        std::vector<std::uint32_t> halved(boxes.begin(), boxes.end());
        halved[static_cast<std::size_t>(largest - boxes.begin())] = half;
        most = std::max(most, boundOf(halved, enough, halvings - 1));
        if (most >= bound) return bound;
    }
    return most;
}

}  // namespace ispace::proofs::poses
