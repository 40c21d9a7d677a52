// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/view_rules.h"

#include <cstdint>
#include <utility>

namespace ispace {

namespace {

template <typename IsKept>
void keep(CellParts& parts, IsKept is_kept) {
    std::vector<CellRun> runs;
    std::vector<std::uint32_t> first = {0};
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (std::uint32_t r = parts.first[part]; r < parts.first[part + 1]; ++r) {
            std::uint32_t begin = parts.runs[r].first;
            for (std::uint32_t i = begin; i < parts.runs[r].end; ++i) {
                if (is_kept(i)) continue;
                if (begin < i) runs.push_back({begin, i});
                begin = i + 1;
            }
            if (begin < parts.runs[r].end) runs.push_back({begin, parts.runs[r].end});
        }
        first.push_back(static_cast<std::uint32_t>(runs.size()));
    }
    parts.runs = std::move(runs);
    parts.first = std::move(first);
}

}  // namespace

void CoverRule::keepCovered(const SensorModel& sensor, Point2 place, CellParts& parts) const {
    keep(parts,
         [&](std::uint32_t cell) { return !cells_.test(cell) || isCovered(sensor, place, cell); });
}

void CoverRule::keepCovered(const SensorModel& sensor, Point2 place, CellSet& cells) const {
    CellSet seen = cells;
    seen &= cells_;
    seen.forEach([&](std::size_t cell) {
        if (!isCovered(sensor, place, cell)) cells.reset(cell);
    });
}

void CoverRule::removeAll(CellParts& parts) const {
    keep(parts, [this](std::uint32_t cell) { return !cells_.test(cell); });
}

}  // namespace ispace
