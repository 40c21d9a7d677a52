// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "base/cell_set.h"
#include "base/parallel.h"
#include "coverage/shadow_footprint.h"
#include "env/level.h"
#include "geom/curve.h"
#include "raster/grid.h"
#include "scene/sensor/sensor.h"
#include "sense/scan.h"
#include "trace/ray_world.h"

namespace ispace {

/// What each sensor of an environment sees of the floor by itself: a laser that scans a slice sees
/// of that slice, any other sensor of one level plane (see ShadowCaster). From inside a solid,
/// deeper than kRayEpsilon, nothing is seen.
///
/// The exact region is the truth; cells are those with their centre in it, rasterised
/// (cellsBySector) for slices and tested one by one (cellsOnPlane) for planes. The edges of a field
/// of view and the greatest range count as inside, a line that hides what is behind it does not.
class VisibleArea {
  public:
    /// Keeps the references. \param plane its height \param worlds for cells on planes; null if
    /// only regions are asked for
    VisibleArea(const Environment& environment, double plane, Worlds* worlds = nullptr)
        : environment_(environment), plane_(plane), worlds_(worlds) {}

    /// To be called for a sensor like it (its model, height, tilt and roll) before its cells are
    /// asked for, by one thread. \pre there are worlds
    void prepare(const Sensor& sensor) const;

    /// Disjoint curves, what is seen on their left; nothing if no closed form is known: for swept
    /// lasers that do not scan a slice. Thread-safe. \throws FormatError as ShadowCaster
    [[nodiscard]] std::optional<std::vector<Curve>> regionOf(const Sensor& sensor) const;
    /// Thread-safe. \pre prepare()
    [[nodiscard]] CellSet cellsOf(const Grid& grid, const Sensor& sensor) const;

    [[nodiscard]] double plane() const { return plane_; }
    [[nodiscard]] std::shared_ptr<const Level> levelAt(double height) const {
        return environment_.level(height);
    }
    /// What stops the sight of a sensor that looks at the plane. \pre prepare()
    [[nodiscard]] const RayWorld& meshFor(const SensorModel& model) const;

  private:
    const Environment& environment_;
    double plane_;
    Worlds* worlds_;
    Lazy<ShadowCaster> shadows_;
};

}  // namespace ispace
