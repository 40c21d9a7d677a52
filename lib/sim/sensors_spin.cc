// SPDX-License-Identifier: GPL-3.0-or-later
// Scans whose beams follow one another.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "sim/sensors.h"

namespace ispace {

namespace {

/// The next step at or after a time.
SimTime atStep(SimTime time, SimTime step) { return (time + step - SimTime(1)) / step * step; }

}  // namespace

/// Up to the step at or after its last beam.
SimTime SensorReader::durationOf(const Laser& laser, SimTime step) {
    constexpr double kNanoseconds = 1e9;
    return atStep(SimTime(std::llround(laser.duration() * kNanoseconds)), step);
}

/// When the scan began that a sensor has completed; of others now.
SimTime SensorReader::beginOf(std::size_t sensor, SimTime time) const {
    const bool is_first = due_[sensor] == SimTime(0);
    if (is_first || durations_[sensor] == SimTime(0)) return time;
    const std::int64_t period = periods_[sensor].newest(time - durations_[sensor]);
    return atStep(periods_[sensor].begin(period), step_);
}

Pose3 SensorReader::poseOf(const Sensor& sensor, const Trail::Walk& walk) const {
    if (sensor.mount) return poseOn(sensor, walk.robot(sensor.mount->robot));
    return sensor.person ? poseOn(sensor, walk.person(*sensor.person)) : sensor.pose;
}

void SensorReader::followTrail(const SensorReader& before,
                               const std::unordered_set<std::string_view>& stayers,
                               const Movers& movers) {
    if (!trail_.isKept()) return;
    using Indices = std::vector<std::optional<std::size_t>>;
    const auto indices = [&stayers](const auto& here, const auto& there) {
        std::unordered_map<std::string_view, std::size_t> old;
        for (std::size_t i = 0; i < there.size(); ++i) old.emplace(there[i].id, i);
        Indices found(here.size());
        for (std::size_t i = 0; i < here.size(); ++i) {
            const auto index = old.find(here[i].id);
            if (index != old.end() && stayers.contains(here[i].id)) found[i] = index->second;
        }
        return found;
    };
    trail_.goOn(before.trail_, indices(scene_->robots, before.scene_->robots),
                indices(scene_->people, before.scene_->people), Places(movers),
                [this](const Places& places, MovingBodies& bodies) { setBodies(places, bodies); });
}

/// Where each beam leaves, and among whom.
void SensorReader::sweep(const Laser& laser, std::size_t sensor) {
    SensorReading& reading = readings_[sensor];
    Scan& scan = std::get<Scan>(reading.value);
    const auto count = static_cast<std::size_t>(laser.beams);
    std::vector<BeamsAmong>& parts = parts_[sensor];
    scan.beam_poses.clear();
    if (laser.sweep == SweepAxis::None && trail_.isStillSince(reading.time)) {
        parts.assign({{0, count, &bodies_}});
        return;
    }
    parts.clear();
    scan.beam_poses.resize(count);
    bool moves = false;
    Trail::Walk walk(trail_, reading.time);
    for (std::size_t n = 0; n < count; ++n) {
        const std::size_t beam = laser.spin > 0 ? n : count - 1 - n;
        const double later = laser.timeOf(static_cast<int>(beam));
        walk.to(later);
        const Pose3 pose = sweptPose(laser, poseOf(*sensors_[sensor].sensor(), walk),
                                     scan.number + later * laser.rate);
        moves = moves || pose != scan.pose;
        scan.beam_poses[beam] = pose;
        const MovingBodies* const bodies = &walk.bodies();
        if (parts.empty() || parts.back().bodies != bodies) parts.push_back({beam, beam, bodies});
        parts.back().begin = std::min(parts.back().begin, beam);
        parts.back().end = std::max(parts.back().end, beam + 1);
    }
    if (!moves) scan.beam_poses.clear();
}

}  // namespace ispace
