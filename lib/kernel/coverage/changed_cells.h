// SPDX-License-Identifier: GPL-3.0-or-later
// Updates the view of a sensor after a body was added, removed or moved: only cells in the shadows
// of the changed bodies are tested again. The results are those of computing the view anew
// (cellsOnPlane). Deterministic; const members and functions are thread-safe. Metres.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/cell_set.h"
#include "env/environment.h"
#include "geom/point.h"
#include "raster/grid.h"
#include "scene/sensor/field_of_view.h"
#include "trace/ray_world.h"

namespace ispace {

/// The bodies by which two environments with the same walls differ, each as an upright box: a view
/// over a plane changes only in their shadows. Boxes hold bodies, so no cell that changes is
/// missed; others may be tested for no change. An edit then costs rays in these shadows instead of
/// a whole view.
///
///     if (const auto changed = ChangedBodies::between(before, after))
///         return changesIn(changed->shadowsOn(grid, eye, 0), grid, mesh, view, 0, seen);
class ChangedBodies {
  public:
    /// Empty unless Environment::changesSince() compares the two.
    static std::optional<ChangedBodies> between(const Environment& before,
                                                const Environment& after);

    /// Returns true if a body meets this part of the plan.
    [[nodiscard]] bool meet(const Box2& part) const;
    /// Returns the cells of the plane at `height` whose rays from `eye` may meet a body: disjoint
    /// runs in ascending order, each in one row. All cells if the eye stands above, in or below a
    /// body. O(rows in shadow), for each body.
    [[nodiscard]] std::vector<CellRun> shadowsOn(const Grid& grid, Point3 eye, double height) const;

  private:
    struct Bounds {
        Box2 plan;
        double bottom = 0, top = 0;
    };
    std::vector<Bounds> bodies_;
};

/// Cells that a view gains and loses by a change.
struct CellChanges {
    std::vector<std::uint32_t> gained, lost;
};

/// Compares a view after a change with its cells before, in these cells alone: cellsOnPlane() of
/// the changed mesh holds those of `before` less `lost` and with `gained`, if `where` has all cells
/// that change. O(cells of `where`) rays.
CellChanges changesIn(std::span<const CellRun> where, const Grid& grid, const RayWorld& mesh,
                      const FieldOfView& view, double height, const CellSet& before);

}  // namespace ispace
