// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/thermometers/zone_temperatures.h"

#include <cmath>
#include <cstdint>

#include "geom/polygon.h"
#include "sense/selection.h"

namespace ispace::thermometers {

namespace {

constexpr double kPersonWatts = 75;  // sensible heat of people at light work

int peopleIn(const Polygon& outline, const MovingBodies& bodies) {
    int people = 0;
    std::uint32_t last = MovingBodies::kNoOwner;
    for (const MovingBody& body : bodies.bodies()) {
        // The trunk is a person's first box.
        const bool is_trunk = body.owner >= kFirstPerson && body.radius == 0 && body.owner != last;
        if (!is_trunk) continue;
        last = body.owner;
        if (locate(outline, body.pose.position) != Side::Outside) ++people;
    }
    return people;
}

}  // namespace

double steadyTemperature(const ZoneHeat& heat, const MovingBodies& bodies) {
    const double power = heat.power + kPersonWatts * peopleIn(heat.outline, bodies);
    return heat.outside + power / heat.loss;
}

double temperatureAfter(const ZoneHeat& heat, double steady, double from, double seconds) {
    // Without a difference of large numbers if the zone is insulated well.
    return from - (steady - from) * std::expm1(-seconds * heat.loss / heat.storage);
}

ZoneTemperatures::State ZoneTemperatures::advance(const Thermometer& thermometer, double time,
                                                  const MovingBodies& bodies) {
    const ZoneHeat& heat = thermometer.heat;
    State& state = zones_.try_emplace(thermometer.zone, State{heat.start, 0}).first->second;
    if (time < state.time) state = {heat.start, 0};
    if (time == state.time) return state;
    const double passed = time - state.time;
    state = {temperatureAfter(heat, steadyTemperature(heat, bodies), state.celsius, passed), time};
    return state;
}

}  // namespace ispace::thermometers
