// SPDX-License-Identifier: GPL-3.0-or-later
// The motions that kinds of sensors detect, by SensorKind::senses.
#pragma once

#include "scene/sensor/sensor.h"

namespace ispace {

/// Returns true if the readings of a kind depend on the motion of people.
inline bool detectsMotion(const SensorModel& model) { return kindOf(model).senses != nullptr; }

/// Returns true if a person in view is detected; false unless detectsMotion(model).
/// \param velocity m/s over the floor \param direction unit vector from the sensor to the person
inline bool detects(const SensorModel& model, Vec2 velocity, Vec3 direction) {
    const auto senses = kindOf(model).senses;
    return senses != nullptr && senses(model, velocity, direction);
}

}  // namespace ispace
