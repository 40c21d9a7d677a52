// SPDX-License-Identifier: GPL-3.0-or-later
// The motions that kinds of sensors detect: a function `senses(KIND, …)` for each of these kinds.
#pragma once

#include <cmath>
#include <variant>

#include "geom/point.h"
#include "scene/sensor/kinds.h"

namespace ispace {

/// Returns true if a person in view who moves so is detected.
/// \param velocity m/s over the floor \param direction unit vector from the sensor to the person
inline bool senses(const Pir& pir, Vec2 velocity, Vec3 /*direction*/) {
    const double speed = length(velocity);
    return speed >= pir.min_speed && speed > 0;
}
/// Likewise for a radar, by the radial speed.
inline bool senses(const Radar& radar, Vec2 velocity, Vec3 direction) {
    const double speed = velocity.x * direction.x + velocity.y * direction.y;
    return std::fabs(speed) >= radar.min_speed && speed != 0;
}

/// Returns true if the readings of a kind depend on the motion of people.
inline bool detectsMotion(const SensorModel& model) {
    return std::visit(
        [](const auto& one) {
            return requires { senses(one, Vec2(), Vec3()); };
        },
        model);
}

/// Likewise for any kind; false unless detectsMotion(model).
inline bool detects(const SensorModel& model, Vec2 velocity, Vec3 direction) {
    return std::visit(
        [&](const auto& one) {
            if constexpr (requires { senses(one, velocity, direction); })
                return senses(one, velocity, direction);
            else
                return false;
        },
        model);
}

}  // namespace ispace
