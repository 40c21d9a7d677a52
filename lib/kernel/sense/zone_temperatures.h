// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <unordered_map>

#include "scene/sensor/thermometer.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Returns the temperature that constant heat and people lead to.
double steadyTemperature(const ZoneHeat& heat, const MovingBodies& bodies);

/// Solves the equation of ZoneHeat, with constant heat and people:
///
///     T(t) = from + (steady - from) (1 - exp(-t loss / storage))
double temperatureAfter(const ZoneHeat& heat, double steady, double from, double seconds);

/// Temperatures of the zones of thermometers, by id.
class ZoneTemperatures {
  public:
    struct State {
        double celsius = 0;
        double time = 0;  ///< seconds
    };

    /// Advances the thermometer's zone to a time, with its heat and the people in it since the time
    /// before, or since the start of a new zone. An earlier time restarts it.
    void advance(const Thermometer& thermometer, double time, const MovingBodies& bodies);
    /// Returns the last state of the thermometer's zone.
    [[nodiscard]] State stateOf(const Thermometer& thermometer) const;

  private:
    std::unordered_map<std::string, State> zones_;
};

}  // namespace ispace
