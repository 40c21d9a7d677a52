// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/facing_cells.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "base/error.h"
#include "env/zone.h"

namespace ispace {

FacingCells::FacingCells(const Environment& environment, const Target& target,
                         std::span<const FacingRule> rules)
    : grid_(target.grid), all_(target.grid.size()) {
    for (const FacingRule& rule : facingIn(environment, rules))
        for (const FacingPart& part : rule.parts) {
            const NamedZone zone = namedZone(rule.zone, part.outline);
            const std::vector<double> weights =
                weightsOfCells(target, {.targets = {zone}, .weights = {}});
            Part& added =
                parts_.emplace_back(Part{part.heading, rule.within, CellSet(target.grid.size())});
            for (std::size_t i = 0; i < weights.size(); ++i)
                if (weights[i] > 0) added.cells.set(i);
            all_ |= added.cells;
        }
}

bool FacingCells::isKept(bool is_camera, Point2 place, std::size_t cell) const {
    if (!all_.test(cell)) return true;
    if (!is_camera) return false;
    const Point2 center = grid_.center(cell);
    return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
        return part.cells.test(cell) && isFaced(part.heading, part.within, center, place);
    });
}

void FacingCells::keepFaces(const SensorModel& sensor, Point2 place, CellSet& cells) const {
    const bool is_camera = std::holds_alternative<Camera>(sensor);
    CellSet seen = cells;
    seen &= all_;
    seen.forEach([&](std::size_t cell) {
        if (!isKept(is_camera, place, cell)) cells.reset(cell);
    });
}

template <typename IsKept>
void FacingCells::keep(CellParts& parts, IsKept is_kept) {
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

void FacingCells::keepFaces(const SensorModel& sensor, Point2 place, CellParts& parts) const {
    const bool is_camera = std::holds_alternative<Camera>(sensor);
    keep(parts, [&](std::uint32_t cell) { return isKept(is_camera, place, cell); });
}

void FacingCells::removeAll(CellParts& parts) const {
    keep(parts, [this](std::uint32_t cell) { return !all_.test(cell); });
}

}  // namespace ispace
