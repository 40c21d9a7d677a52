// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of turns and of changes of velocity, step by step. In axes that turn by a step's angle a, a
// constant velocity v changes by a v to its left.
#include "sim/mean_motions.h"

#include <algorithm>
#include <utility>

namespace ispace {

void MeanMotions::add(std::size_t sensor, std::optional<std::size_t> robot,
                      std::optional<std::size_t> person, Point2 mount) {
    units_.push_back({sensor, robot, person, mount});
}

void MeanMotions::step(const Movers& movers) {
    for (Unit& unit : units_) {
        const Motion& motion =
            unit.robot ? movers.robots[*unit.robot] : movers.people[*unit.person];
        const double rate = Angle::degrees(motion.turn.speed).radians();
        const Vec2 arm = unit.mount - Point2{};
        const Vec2 velocity =
            Vec2{motion.drive.speed, motion.side.speed} + rate * perpendicular(arm);
        if (unit.heading) {
            const double turn = wrapped(motion.pose.heading - *unit.heading).radians();
            // The change in the axes of the carrier, and that of the axes themselves.
            const Vec2 mean = 0.5 * (unit.velocity + velocity);
            const Vec2 gain = velocity - unit.velocity + turn * perpendicular(mean);
            unit.gain.turn += turn;
            unit.gain.velocity = unit.gain.velocity + gain;
        }
        unit.heading = motion.pose.heading;
        unit.velocity = velocity;
    }
}

void MeanMotions::jumped() {
    for (Unit& unit : units_) unit.heading.reset();
}

void MeanMotions::read(std::size_t sensor, SimTime time) {
    for (Unit& unit : units_) {
        if (unit.sensor != sensor) continue;
        const double passed = seconds(time - unit.since);
        const Gain gain = std::exchange(unit.gain, {});
        unit.since = time;
        unit.mean.turn = passed > 0 ? gain.turn / passed : 0;
        unit.mean.acceleration = {};
        if (passed <= 0 || !unit.heading) continue;
        const Vec2 ahead = unitVector(*unit.heading);
        unit.mean.acceleration =
            (1 / passed) * (gain.velocity.x * ahead + gain.velocity.y * perpendicular(ahead));
    }
}

void MeanMotions::goOn(std::size_t sensor, const MeanMotions& before, std::size_t old_sensor) {
    const Unit* const old = before.find(old_sensor);
    if (old == nullptr) return;
    for (Unit& unit : units_) {
        if (unit.sensor != sensor) continue;
        Unit next = *old;
        next.sensor = sensor;
        next.robot = unit.robot;
        next.person = unit.person;
        next.mount = unit.mount;
        unit = next;
    }
}

std::optional<MeanMotion> MeanMotions::of(std::size_t sensor) const {
    const Unit* const unit = find(sensor);
    return unit == nullptr ? std::nullopt : std::optional(unit->mean);
}

const MeanMotions::Unit* MeanMotions::find(std::size_t sensor) const {
    const auto found = std::find_if(units_.begin(), units_.end(),
                                    [sensor](const Unit& unit) { return unit.sensor == sensor; });
    return found == units_.end() ? nullptr : &*found;
}

}  // namespace ispace
