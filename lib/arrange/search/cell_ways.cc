// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/cell_ways.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <queue>
#include <utility>

namespace ispace {

namespace {

constexpr std::uint64_t kNoCost = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint8_t kNoStep = 0xff;

}  // namespace

/// The last step to each cell of a search, which ends at the goal.
struct CellWays::Tree {
    std::vector<std::uint8_t> steps;
    std::uint64_t cost = kNoCost;  ///< the seen length above, all of it in the lower 32 bits
    std::uint32_t goal = 0;
};

CellWays::Tree CellWays::search(const std::function<bool(std::uint32_t)>& is_seen) const {
    Tree tree;
    tree.steps.assign(open.size(), kNoStep);
    std::vector<std::uint64_t> costs(open.size(), kNoCost);
    std::vector<bool> counts(open.size());
    for (std::uint32_t i = 0; i < open.size(); ++i)
        counts[i] = is_seen(i) && !from.test(i) && !to.test(i);
    using Open = std::pair<std::uint64_t, std::uint32_t>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> queue;
    from.forEach([&](std::size_t cell) {
        costs[cell] = 0;
        queue.emplace(0, static_cast<std::uint32_t>(cell));
    });
    while (!queue.empty()) {
        const auto [cost, cell] = queue.top();
        queue.pop();
        if (cost > costs[cell]) continue;
        if (to.test(cell)) {
            tree.cost = cost;
            tree.goal = cell;
            return tree;
        }
        for (std::uint32_t bits = open[cell]; bits != 0; bits &= bits - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(bits));
            const CellStep& step = steps[k];
            std::uint64_t sum = cost + step.length;
            for (const WayCell& piece : step.pieces)
                if (counts[cell + piece.cell]) sum += std::uint64_t{piece.length} << 32U;
            const std::uint32_t next = cell + static_cast<std::uint32_t>(step.to);
            if (sum >= costs[next]) continue;
            costs[next] = sum;
            tree.steps[next] = static_cast<std::uint8_t>(k);
            queue.emplace(sum, next);
        }
    }
    return tree;
}

bool CellWays::exist() const {
    return search([](std::uint32_t) { return false; }).cost != kNoCost;
}

CellWay CellWays::leastSeen(const std::function<bool(std::uint32_t)>& is_seen) const {
    const Tree tree = search(is_seen);
    CellWay way{tree.cost >> 32U, tree.cost & 0xffffffffU, {}};
    std::map<std::uint32_t, std::uint32_t> lengths;
    for (std::uint32_t cell = tree.goal; tree.steps[cell] != kNoStep;) {
        const CellStep& step = steps[tree.steps[cell]];
        cell -= static_cast<std::uint32_t>(step.to);
        for (const WayCell& piece : step.pieces) {
            const std::uint32_t at = cell + piece.cell;
            if (!from.test(at) && !to.test(at)) lengths[at] += piece.length;
        }
    }
    for (const auto& [cell, length] : lengths) way.cells.push_back({cell, length});
    return way;
}

}  // namespace ispace
