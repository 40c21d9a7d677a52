// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/scene_value.h"

#include <algorithm>
#include <vector>

namespace ispace {

bool stands(const SensorView& view, const Scene& standing) {
    return view.index < standing.sensors.size();
}

std::uint64_t valueOf(const Problem& problem, const Coverage& coverage, int unit) {
    std::vector<int> met(problem.cells());
    for (const SensorView& view : coverage.sensors) {
        const int part = view.isPartial() ? 1 : unit;
        view.cells.forEach([&](std::size_t cell) { met[cell] += part; });
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < met.size(); ++i)
        if (met[i] >= problem.required) value += problem.weights[i];
    return value;
}

bool isConnected(const Problem& problem, const Coverage& coverage, const Scene& standing) {
    CellSet counted(problem.cells());
    for (std::size_t i = 0; i < problem.cells(); ++i)
        if (problem.weights[i] > 0) counted.set(i);
    std::vector<CellSet> waiting;
    CellSet reached(problem.cells());
    for (const SensorView& view : coverage.sensors) {
        CellSet cells = view.cells;
        cells &= counted;
        if (stands(view, standing))
            reached |= cells;
        else
            waiting.push_back(std::move(cells));
    }
    if (reached.empty() && !waiting.empty()) {
        reached = waiting.back();
        waiting.pop_back();
    }
    // Joins what shares a cell with what is joined already until nothing does.
    for (bool grows = true; grows;) {
        grows = false;
        for (std::size_t i = 0; i < waiting.size(); ++i) {
            if (countCommon(waiting[i], reached) == 0) continue;
            reached |= waiting[i];
            waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(i--));
            grows = true;
        }
    }
    return waiting.empty();
}

}  // namespace ispace
