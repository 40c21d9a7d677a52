// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/cell_paths.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <queue>
#include <utility>

namespace ispace::goals {

namespace {

constexpr std::uint64_t kNoCost = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint16_t kNoStep = 0xffff;
/// Passage k is step kPassage + k of cells to which it leads.
constexpr std::uint16_t kPassage = 32;

}  // namespace

/// The last step to each cell of a search, which ends at the goal.
struct CellPaths::Tree {
    std::vector<std::uint16_t> steps;
    std::vector<std::uint32_t> entries;  ///< of passages: the cell from which each was entered
    std::uint64_t cost = kNoCost;        ///< the seen length above, all of it in the lower 32 bits
    std::uint32_t goal = 0;
};

const CellFloor& CellPaths::floorOf(std::uint32_t cell) const {
    std::size_t i = floors.size() - 1;
    while (cell < floors[i].first) --i;
    return floors[i];
}

CellSet CellPaths::free() const {
    CellSet all = from;
    all |= to;
    for (const CellSet& passage : passages) all |= passage;
    return all;
}

CellPaths::Tree CellPaths::search(const std::function<bool(std::uint32_t)>& is_seen) const {
    Tree tree;
    tree.steps.assign(open.size(), kNoStep);
    tree.entries.assign(passages.size(), 0);
    std::vector<bool> is_taken(passages.size());
    std::vector<std::uint64_t> costs(open.size(), kNoCost);
    std::vector<bool> counts(open.size());
    const CellSet uncounted = free();
    for (std::uint32_t i = 0; i < open.size(); ++i) counts[i] = is_seen(i) && !uncounted.test(i);
    using Open = std::pair<std::uint64_t, std::uint32_t>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> queue;
    const auto reach = [&](std::uint32_t cell, std::uint64_t cost, std::uint16_t step) {
        if (cost >= costs[cell]) return;
        costs[cell] = cost;
        tree.steps[cell] = step;
        queue.emplace(cost, cell);
    };
    from.forEach([&](std::size_t cell) { reach(static_cast<std::uint32_t>(cell), 0, kNoStep); });
    while (!queue.empty()) {
        const auto [cost, cell] = queue.top();
        queue.pop();
        if (cost > costs[cell]) continue;
        if (to.test(cell)) {
            tree.cost = cost;
            tree.goal = cell;
            return tree;
        }
        const CellFloor& floor = floorOf(cell);
        for (std::uint32_t bits = open[cell]; bits != 0; bits &= bits - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(bits));
            const CellStep& step = floor.steps[k];
            std::uint64_t sum = cost + step.length;
            for (const PathCell& piece : step.pieces)
                if (counts[cell + piece.cell]) sum += std::uint64_t{piece.length} << 32U;
            reach(cell + static_cast<std::uint32_t>(step.to), sum, static_cast<std::uint16_t>(k));
        }
        // The first cell of a passage that is reached is the nearest.
        for (std::size_t k = 0; k < passages.size(); ++k) {
            if (is_taken[k] || !passages[k].test(cell)) continue;
            is_taken[k] = true;
            tree.entries[k] = cell;
            passages[k].forEach([&, cost = cost](std::size_t next) {
                reach(static_cast<std::uint32_t>(next), cost,
                      static_cast<std::uint16_t>(kPassage + k));
            });
        }
    }
    return tree;
}

bool CellPaths::exist() const {
    return search([](std::uint32_t) { return false; }).cost != kNoCost;
}

CellPath CellPaths::leastSeen(const std::function<bool(std::uint32_t)>& is_seen) const {
    const Tree tree = search(is_seen);
    CellPath way{tree.cost >> 32U, tree.cost & 0xffffffffU, {}};
    std::map<std::uint32_t, std::uint32_t> lengths;
    const CellSet uncounted = free();
    for (std::uint32_t cell = tree.goal; tree.steps[cell] != kNoStep;) {
        if (tree.steps[cell] >= kPassage) {
            cell = tree.entries[tree.steps[cell] - kPassage];
            continue;
        }
        // Steps do not leave a floor.
        const CellStep& step = floorOf(cell).steps[tree.steps[cell]];
        cell -= static_cast<std::uint32_t>(step.to);
        for (const PathCell& piece : step.pieces) {
            const std::uint32_t at = cell + piece.cell;
            if (!uncounted.test(at)) lengths[at] += piece.length;
        }
    }
    for (const auto& [cell, length] : lengths) way.cells.push_back({cell, length});
    return way;
}

}  // namespace ispace::goals
