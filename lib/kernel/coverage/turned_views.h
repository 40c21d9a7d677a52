// SPDX-License-Identifier: GPL-3.0-or-later
// A table of the floor about a sensor's foot, by which all sites of a lattice share the work of
// deciding which headings look at a cell.
//
//     const TurnedViews turned(ahead, headings, plane, reach);  // once for a height, tilt and roll
//     std::vector<const HeldViews::Verdict*> row(columns);
//     turned.find(x, cell, y, row);                             // at each site, for each row
//     for (const HeldViews::Verdict* verdict : row) use(verdict->held, verdict->unsure);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "coverage/held_views.h"
#include "geom/point.h"
#include "scene/sensor/field_of_view.h"

namespace ispace {

/// The views of one sensor at several headings over a level plane, in polar coordinates about its
/// foot: for all points of a ring and a sector, the views that hold them, and those that may. The
/// table is that of all sites at which the sensor has this height, tilt and roll.
///
/// 192 rings by 1024 sectors, two bytes each. A bin is decided with a margin of 2 % of its size,
/// more than the float32 errors of find() (2e-5 rad), so a sure verdict holds for each point of it;
/// points of unsure bins are tested by HeldViews. Immutable, thread-safe.
class TurnedViews {
  public:
    /// Builds the table in milliseconds. \param ahead the view at heading 0
    /// \param plane the plane's height in the frame of `ahead`
    /// \param reach the table's radius on the plan: beyond, all views may hold any point
    /// \pre 1 to HeldViews::kMax headings
    TurnedViews(const FieldOfView& ahead, std::span<const Angle> headings, double plane,
                double reach);

    /// Finds the verdicts of points in one row: point i is at (x + i * step, y) from the foot.
    /// Bit k of a verdict stands for headings[k]. Stores references into the table.
    void find(double x, double step, double y, std::span<const HeldViews::Verdict*> row) const;

    [[nodiscard]] std::span<const Angle> headings() const { return headings_; }

  private:
    [[nodiscard]] std::size_t index(int ring, int sector) const {
        return static_cast<std::size_t>(ring) * kSectors + static_cast<std::size_t>(sector);
    }

    static constexpr int kRings = 192, kSectors = 1024;

    std::vector<Angle> headings_;
    float rings_per_metre_;
    std::vector<std::uint16_t> pattern_;        // by ring and sector; one more ring for all beyond
    std::vector<HeldViews::Verdict> verdicts_;  // by pattern
};

}  // namespace ispace
