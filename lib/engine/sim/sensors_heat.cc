// SPDX-License-Identifier: GPL-3.0-or-later
// Zones have one temperature for all their thermometers.
#include "sim/sensor_scheduler.h"

#include <utility>

namespace ispace {

/// Sets a thermometer's value so that its next one continues from the zone's last state.
void SensorReader::continueZone(std::size_t sensor, SensorReading& reading) const {
    const auto* const thermometer = sensors_[sensor].tryAs<Thermometer>();
    if (thermometer == nullptr) return;
    const ZoneTemperatures::State last = zones_.stateOf(*thermometer);
    Temperature before;
    before.time = last.time;
    before.truth = last.celsius;
    reading.value = before;
}

/// Advances the zones of due thermometers.
void SensorReader::heatZones(std::span<const std::size_t> due) {
    for (const std::size_t i : due) {
        const auto* const thermometer = sensors_[i].tryAs<Thermometer>();
        if (thermometer == nullptr) continue;
        zones_.advance(*thermometer, seconds(readings_[i].time), bodies_);
        continueZone(i, readings_[i]);
    }
}

/// Advances the zones to the end of the scene before.
void SensorReader::followZones(const SensorReader& before, SimTime time, const Movers& movers) {
    zones_ = before.zones_;
    bool are_bodies_here = false;
    for (const Sensor& sensor : before.sensors_) {
        const auto* const thermometer = sensor.tryAs<Thermometer>();
        if (thermometer == nullptr) continue;
        if (!std::exchange(are_bodies_here, true)) updateBodies(movers);
        zones_.advance(*thermometer, seconds(time), bodies_);
    }
}

}  // namespace ispace
