// SPDX-License-Identifier: GPL-3.0-or-later
// The visible area of one sensor, as exact curves and as cells of a grid: the two ways in which
// coverage.h computes its figures. Metres, in the frame of the environment.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "base/cell_set.h"
#include "base/parallel.h"
#include "coverage/counted_cells.h"
#include "coverage/shadow_footprint.h"
#include "env/level.h"
#include "geom/curve.h"
#include "raster/grid.h"
#include "scene/sensor/sensor.h"
#include "sense/scan.h"
#include "trace/ray_world.h"

namespace ispace {

struct KnownSight;

/// Computes the visible area of single sensors: for a laser that scans a slice in that slice, for
/// any other sensor on one level plane (see ShadowCaster). A sensor inside a solid, deeper than
/// kRayEpsilon, sees no floor.
///
///     VisibleArea sight(scene.environment, 0.0);
///     if (const auto region = sight.regionOf(sensor)) area = signedArea(*region);
///
/// The exact region is the reference; cells count if their centre lies in it, rasterised
/// (cellsBySector) for slices and tested one by one (cellsOnPlane) for planes. The edges of a field
/// of view and the maximum range count as inside, an occluding line does not.
class VisibleArea {
  public:
    /// Stores the references. \param plane height of the plane \param worlds required for cells on
    /// planes; null if only regions are requested \param reach of the farthest level laser, see
    /// LevelViews
    VisibleArea(const Environment& environment, double plane, RayScenes* worlds = nullptr,
                double reach = std::numeric_limits<double>::infinity())
        : environment_(environment), plane_(plane), worlds_(worlds), reach_(reach) {}

    /// Keeps the regions of sensors that scan no slice, for calls with equal models and poses: up
    /// to 20 000 of them. \pre no call has been made
    void keepRegions();

    /// Builds the world for sensors of the same model, height, tilt and roll. One thread must call
    /// it before cellsOf(). \pre worlds is not null
    void prepare(const Sensor& sensor) const;

    /// Returns disjoint curves with the seen floor on their left; empty if no closed form is known:
    /// for swept lasers that do not scan a slice. Thread-safe. \throws FormatError as ShadowCaster
    [[nodiscard]] std::optional<std::vector<Curve>> regionOf(const Sensor& sensor) const;
    /// Returns a box that holds regionOf(), by the field of view and the range alone. Thread-safe.
    [[nodiscard]] Box2 boxOf(const Sensor& sensor) const;
    /// Returns the cells with their centre in the view. Thread-safe. \pre prepare()
    /// \param counted if not null, the view holds those of these cells, and arbitrary others
    /// \param known as ViewScope::known, of sensors that scan no slice
    [[nodiscard]] CellSet cellsOf(const Grid& grid, const Sensor& sensor,
                                  const CountedCells* counted = nullptr,
                                  KnownSight* known = nullptr) const;

    [[nodiscard]] double plane() const { return plane_; }
    [[nodiscard]] std::shared_ptr<const Level> levelAt(double height) const {
        return environment_.level(height);
    }
    /// Returns the triangles that block the sight of a sensor on the plane. \pre prepare()
    [[nodiscard]] const RayWorld& meshFor(const SensorModel& model) const;

  private:
    class KnownRegions;

    const Environment& environment_;
    double plane_;
    RayScenes* worlds_;
    double reach_;
    Lazy<ShadowCaster> shadows_;
    std::shared_ptr<KnownRegions> known_;  // null: none are kept
};

/// Returns true if two sensors see the same in one room: their models are equal but for the lists
/// of other things (SensorKind::forget), such as the tags of a reader, and so are their poses.
bool seeAlike(const Sensor& a, const Sensor& b);

}  // namespace ispace
