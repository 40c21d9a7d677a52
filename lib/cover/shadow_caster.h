// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "env/environment.h"
#include "geom/curve.h"
#include "sensor/sensor.h"

namespace ispace {

/// What sensors that do not scan in a level slice see of a level plane: what is in their field of
/// view and range, and in no shadow that a body throws. The blind zone is not cut out. A place on
/// the plane that a body covers is seen if sight reaches it. Light passes clear glass, sound does
/// not; a receiver hears there a tag that emits all around.
///
/// A laser that scans in one tilted plane covers the floor over or under which that plane passes in
/// sight, above the floor (`height` does not count). Of swept lasers no closed form is known, nor
/// of cameras whose tangential distortion ends their field of view within the picture.
///
/// Needs the environment no longer once it is made; copies share what they hold. Thread-safe.
class ShadowCaster {
  public:
    explicit ShadowCaster(const Environment& environment);

    /// The exact region: disjoint curves with what is seen on their left. Conics are laid out
    /// within kChordError (of receivers and spherical rangers that see farther than some hundred
    /// times their height over the plane somewhat worse). Empty curves: nothing is seen; nothing:
    /// not known. O(n log n) in the triangles near the field of view and the crossings of their
    /// shadows. \throws FormatError for shadows that cross by the ten million
    [[nodiscard]] std::optional<std::vector<Curve>> regionSeen(const Sensor& sensor,
                                                               double height) const;

  private:
    struct Data;
    std::shared_ptr<const Data> data_;
};

}  // namespace ispace
