// SPDX-License-Identifier: GPL-3.0-or-later
// What rules ask of the views of single sensors, besides the floor that they see: cells that some
// sensors alone cover, and floor that cameras must not see. Extensions make them, see
// cli/arrange_group.h.
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "base/cell_set.h"
#include "coverage/target.h"
#include "env/environment.h"
#include "env/zone.h"
#include "geom/point.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// Cells of a room that a sensor covers only on a condition. Sensors of other rooms never cover
/// them. Thread-safe.
///
///     class NearCells final : public CoverRule {
///       public:
///         NearCells(CellSet cells, const Grid& grid) : CoverRule(std::move(cells)), grid_(grid) {}
///         bool isCovered(const SensorModel&, Point2 place, std::size_t cell) const override {
///             return distance(grid_.center(cell), place) < 2;
///         }
///     ...
class CoverRule {
  public:
    CoverRule(const CoverRule&) = delete;
    CoverRule& operator=(const CoverRule&) = delete;
    virtual ~CoverRule() = default;

    /// Returns true if a sensor at this point covers a cell that it sees. \pre cells() has it
    [[nodiscard]] virtual bool isCovered(const SensorModel& sensor, Point2 place,
                                         std::size_t cell) const = 0;
    /// Returns the cells with the condition.
    [[nodiscard]] const CellSet& cells() const { return cells_; }

    /// Removes cells that a sensor at this point sees without covering them.
    void keepCovered(const SensorModel& sensor, Point2 place, CellParts& parts) const;
    void keepCovered(const SensorModel& sensor, Point2 place, CellSet& cells) const;
    /// Removes cells(), as for sensors of other rooms.
    void removeAll(CellParts& parts) const;

  protected:
    explicit CoverRule(CellSet cells) : cells_(std::move(cells)) {}

  private:
    CellSet cells_;
};

/// Makes the rule of a room on the cells of the search.
using MakeCoverRule =
    std::function<std::unique_ptr<const CoverRule>(const Environment&, const Target&)>;

/// Floor that cameras must not see, or only with fewer pixels a metre. Candidates that see one of
/// its cells are left out.
struct UnseenFloor {
    std::string_view option;  ///< that asks for it, for messages
    std::vector<NamedZone> zones = {};
    double density = 0;  ///< pixels a metre that are too many; 0: any sight is
};

}  // namespace ispace
