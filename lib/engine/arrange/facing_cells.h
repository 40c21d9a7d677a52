// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: cells in which only faces count.
#pragma once

#include <span>
#include <vector>

#include "base/cell_set.h"
#include "coverage/camera_rules.h"
#include "coverage/target.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// Cells of the zones of rules. A sensor covers such a cell only if it is a camera that sees faces
/// at its centre from ahead, by one of the rules of the cell.
class FacingCells {
  public:
    /// \throws UsageError for an unknown zone
    FacingCells(const Environment& environment, const Target& target,
                std::span<const FacingRule> rules);

    /// Removes the cells in which a sensor at this point sees no faces.
    void keepFaces(const SensorModel& sensor, Point2 place, CellParts& parts) const;
    void keepFaces(const SensorModel& sensor, Point2 place, CellSet& cells) const;
    /// Removes the cells of all rules.
    void removeAll(CellParts& parts) const;

  private:
    template <typename IsKept>
    static void keep(CellParts& parts, IsKept is_kept);
    [[nodiscard]] bool isKept(bool is_camera, Point2 place, std::size_t cell) const;

    struct Part {
        Angle heading, within;
        CellSet cells;
    };

    Grid grid_;
    std::vector<Part> parts_;
    CellSet all_;
};

}  // namespace ispace
