// SPDX-License-Identifier: GPL-3.0-or-later
// Rules of facing for searches by cells: arrange counts a cell of such a zone as covered only by
// cameras that see faces there.
#pragma once

#include <span>
#include <vector>

#include "arrange/view_rules.h"
#include "extensions/camerarules/camera_rules.h"

namespace ispace::camerarules {

/// Cells of the zones of rules of facing. A sensor covers such a cell only if it is a camera that
/// sees faces at its centre from ahead, by one of the rules of the cell.
class FacingCells final : public CoverRule {
  public:
    /// \throws UsageError for an unknown zone
    FacingCells(const Environment& environment, const Target& target,
                std::span<const FacingRule> rules);

    [[nodiscard]] bool isCovered(const SensorModel& sensor, Point2 place,
                                 std::size_t cell) const override;

  private:
    struct Part {
        Angle heading, within;
        CellSet cells;
    };

    FacingCells(const Grid& grid, std::vector<Part> parts);
    static std::vector<Part> partsOf(const Environment& environment, const Target& target,
                                     std::span<const FacingRule> rules);

    Grid grid_;
    std::vector<Part> parts_;
};

/// Returns the rule of arrange() for these. \pre headings are known, as from facingIn(), or their
/// doors are in the environment
MakeCoverRule coverRuleOf(std::vector<FacingRule> rules);

}  // namespace ispace::camerarules
