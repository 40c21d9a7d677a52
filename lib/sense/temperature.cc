// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/temperature.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/polygon.h"

namespace ispace {

namespace {

constexpr double kPersonWatts = 75;  // sensible heat of people at light work

int peopleIn(const Polygon& outline, const MovingBodies& bodies) {
    int people = 0;
    for (const MovingBody& body : bodies.bodies()) {
        // The trunk is a person's only box.
        const bool is_trunk = body.owner >= kFirstPerson && body.radius == 0;
        if (is_trunk && locate(outline, body.pose.position) != Side::Outside) ++people;
    }
    return people;
}

/// Lets the zone's temperature approach the steady one for some seconds.
void approach(Temperature& now, double from, double seconds) {
    now.truth = now.steady + (from - now.steady) * std::exp(-seconds / now.constant);
    now.celsius = now.truth + now.error;
    if (now.resolution > 0)
        now.celsius = now.resolution * std::round(now.celsius / now.resolution) + 0.0;
    now.celsius = std::clamp(now.celsius, now.min, now.max);
}

}  // namespace

Temperature readingOf(const Thermometer& thermometer, const Moment& now) {
    const ZoneHeat& heat = thermometer.heat;
    Temperature reading{.time = now.time, .frame = now.frame, .pose = now.pose};
    const double power = heat.power + kPersonWatts * peopleIn(heat.outline, now.bodies);
    reading.steady = heat.outside + power / heat.loss;
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
    approach(reading, heat.start, now.time);
    return reading;
}

void follow(const Temperature& before, Temperature& now) {
    const double passed = now.time - before.time;
    if (passed >= 0) approach(now, before.truth, passed);
}

}  // namespace ispace
