// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "geom/point.h"
#include "sensor/sensor.h"

namespace ispace {

/// Directions as directionOf() has them, to the bit: from `first` counter-clockwise to the last one
/// before `beyond`; both are in (-180, 180] degrees.
struct FanArc {
    Angle first, beyond;
    friend bool operator==(const FanArc&, const FanArc&) = default;
};

/// All directions in which a level laser sees cells: just those of which cellsSeen() says so, with
/// all that it rounds. Fans whose sides look alike may so begin or end a few roundings apart.
///
/// None if it sees all around, or if that is not one arc: roundings may tear it where directions
/// change from 180 to -180 degrees. O(1), some tens of evaluations.
std::optional<FanArc> fanArc(const Laser& laser, Angle heading);

}  // namespace ispace
