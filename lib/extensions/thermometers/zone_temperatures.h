// SPDX-License-Identifier: GPL-3.0-or-later
// The memory of a run: zones have one temperature for all their thermometers, however often each
// of them is read. Advancing a zone is O(moving bodies); states are of one thread.
//
//     ZoneTemperatures zones;
//     const double celsius = zones.advance(thermometer, 60, bodies).celsius;  // after a minute
#pragma once

#include <string>
#include <unordered_map>

#include "extensions/thermometers/thermometer.h"
#include "trace/moving_bodies.h"

namespace ispace::thermometers {

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
    /// before, or since the start of a new zone, and returns its state. An earlier time restarts
    /// it.
    State advance(const Thermometer& thermometer, double time, const MovingBodies& bodies);

  private:
    std::unordered_map<std::string, State> zones_;
};

}  // namespace ispace::thermometers
