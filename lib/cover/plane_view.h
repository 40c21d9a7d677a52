// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "env/environment.h"
#include "geom/curve.h"
#include "raster/grid.h"
#include "sensor/sensor.h"
#include "trace/ray_world.h"

namespace ispace {

/// What sensors that do not scan in a level slice see of a level plane: by field of view, greatest
/// range and occlusion by everything that stands (`mesh`: a RayWorld::ofEnvironment, of Solid
/// surfaces for receivers, of Opaque ones for all others, as for the exact regions). The blind zone
/// is not cut out. A place on the plane that a body covers is seen if sight reaches it.
///
/// By cells: centres, with rays of float32 as RayWorld::look has them.
///
/// A laser that scans in one tilted plane is seen to cover the floor over or under which that plane
/// passes in sight, above the floor (`height` does not count); a swept one what its scans pass of
/// the plane at `height` as it turns on, between scans as well.
/// A receiver hears there a tag that emits all around.
CellSet cellsSeen(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, double height);

/// The same as exact regions, by the shadows that bodies throw. (Contact with the plane is by
/// height here and along the ray there: where sight grazes what is less than kRayEpsilon above the
/// plane, the two differ.) Needs the environment no longer once it is made; copies share what they
/// hold. Thread-safe. O(n log n) in the triangles near the field of view and the crossings of their
/// shadows.
class ShadowCaster {
  public:
    explicit ShadowCaster(const Environment& environment);

    /// Regions as curves with what is seen on their left, disjoint: the field of view on
    /// the plane less the shadows of all triangles between it and the sensor. Conics are laid out
    /// within kChordError (of receivers and spherical rangers that see farther than some hundred
    /// times their height over the plane somewhat worse). Empty curves: nothing is seen; nothing:
    /// not known exactly (swept lasers).
    /// \throws FormatError for shadows that cross by the ten million
    [[nodiscard]] std::optional<std::vector<Curve>> regionSeen(const Sensor& sensor,
                                                               double height) const;

  private:
    struct Data;
    std::shared_ptr<const Data> data_;
};

}  // namespace ispace
