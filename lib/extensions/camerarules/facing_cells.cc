// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/facing_cells.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include "base/error.h"
#include "env/zone.h"

namespace ispace::camerarules {

std::vector<FacingCells::Part> FacingCells::partsOf(const Environment& environment,
                                                    const Target& target,
                                                    std::span<const FacingRule> rules) {
    std::vector<Part> parts;
    for (const FacingRule& rule : facingIn(environment, rules))
        for (const FacingPart& part : rule.parts) {
            const NamedZone zone = namedZone(rule.zone, part.outline);
            const std::vector<double> weights =
                weightsOfCells(target, {.targets = {zone}, .weights = {}});
            Part& added =
                parts.emplace_back(Part{part.heading, rule.within, CellSet(target.grid.size())});
            for (std::size_t i = 0; i < weights.size(); ++i)
                if (weights[i] > 0) added.cells.set(i);
        }
    return parts;
}

FacingCells::FacingCells(const Environment& environment, const Target& target,
                         std::span<const FacingRule> rules)
    : FacingCells(target.grid, partsOf(environment, target, rules)) {}

FacingCells::FacingCells(const Grid& grid, std::vector<Part> parts)
    : CoverRule([&] {
          CellSet all(grid.size());
          for (const Part& part : parts) all |= part.cells;
          return all;
      }()),
      grid_(grid),
      parts_(std::move(parts)) {}

bool FacingCells::isCovered(const SensorModel& sensor, Point2 place, std::size_t cell) const {
    if (!std::holds_alternative<Camera>(sensor)) return false;
    const Point2 center = grid_.center(cell);
    return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
        return part.cells.test(cell) && isFaced(part.heading, part.within, center, place);
    });
}

MakeCoverRule coverRuleOf(std::vector<FacingRule> rules) {
    return [rules = std::move(rules)](const Environment& environment, const Target& target) {
        return std::make_unique<const FacingCells>(environment, target, rules);
    };
}

}  // namespace ispace::camerarules
