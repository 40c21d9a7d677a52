// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/thermometers/temperature.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "extensions/thermometers/zone_temperatures.h"

namespace ispace::thermometers {

namespace {

/// Sets the zone's temperature and measures it.
void measure(Temperature& now, double truth) {
    now.truth = truth;
    now.celsius = now.truth + now.error;
    if (now.resolution > 0)
        now.celsius = now.resolution * std::round(now.celsius / now.resolution) + 0.0;
    now.celsius = std::clamp(now.celsius, now.min, now.max);
}

}  // namespace

Temperature readingOf(const Thermometer& thermometer, const Moment& now) {
    const ZoneHeat& heat = thermometer.heat;
    Temperature reading;
    reading.steady = steadyTemperature(heat, now.bodies);
    reading.constant = heat.storage / heat.loss;
    reading.min = thermometer.min;
    reading.max = thermometer.max;
    if (now.options.noise_seed) {
        std::array<float, 1> normal{};
        RandomKey constant = now.noiseKey();
        constant.frame = 0;
        draw(constant, 0, {.normal = normal});
        reading.error = thermometer.error * static_cast<double>(normal[0]);
        reading.resolution = thermometer.resolution;
    }
    measure(reading, temperatureAfter(heat, reading.steady, heat.start, now.time));
    return reading;
}

void goOn(const Temperature& before, double passed, Temperature& now) {
    if (passed >= 0)
        measure(now,
                before.truth - (now.steady - before.truth) * std::expm1(-passed / now.constant));
}

}  // namespace ispace::thermometers
