// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/site: bounds of the openings between storeys.
//
// A sensor and the box about the openings in a floor span a box on the plane that is seen; sight
// leads through all floors only where their boxes and the range have a common part. Excludes no
// sight within kSightBetweenStoreys and kSightThroughFloors. O(floors between) for a sensor.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "site/site_sight.h"

namespace ispace {

/// The bounds of the openings in each floor, by which most sensors are known to see no other
/// storey. Stores the references.
class OpeningBounds {
  public:
    OpeningBounds(const SiteScene& building, std::span<const FloorOpening> openings);

    /// Returns the storeys through which sight leads from one to another, both included; empty
    /// if it does not.
    [[nodiscard]] std::vector<std::size_t> between(std::size_t from, std::size_t to) const;
    /// False if the range or the bounds show that a sensor, whatever its heading, sees no point of
    /// a plane of another storey. \param between as above \param above_floor height of the plane
    [[nodiscard]] bool maySee(std::span<const std::size_t> between, std::size_t from,
                              std::size_t to, const Sensor& sensor, double above_floor) const;

  private:
    [[nodiscard]] double floorOf(std::size_t storey) const {
        return building_.document.storeys[storey].floor;
    }

    const SiteScene& building_;
    std::vector<std::vector<bool>> above_;
    std::vector<Box2> boxes_;  // of the openings in each floor
};

}  // namespace ispace
