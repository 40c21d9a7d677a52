// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of turns and of changes of velocity, step by step. In axes that turn by a step's angle a, a
// constant velocity v changes by a v to its left.
#include "sim/inertial_means.h"

#include <algorithm>
#include <utility>

namespace ispace {

void InertialMeans::add(std::size_t sensor, std::optional<std::size_t> robot,
                        std::optional<std::size_t> person, Point2 mount) {
    units_.push_back({sensor, robot, person, mount});
}

void InertialMeans::step(const Movers& movers) {
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

void InertialMeans::jumped() {
    for (Unit& unit : units_) unit.heading.reset();
}

void InertialMeans::read(std::size_t sensor, SimTime time) {
    for (Unit& unit : units_) {
        if (unit.sensor != sensor) continue;
        const double passed = seconds(time - unit.since);
        const Gain gain = std::exchange(unit.gain, {});
        unit.since = time;
        unit.rate = passed > 0 ? gain.turn / passed : 0;
        unit.acceleration = {};
        if (passed <= 0 || !unit.heading) continue;
        const Vec2 ahead = unitVector(*unit.heading);
        unit.acceleration =
            (1 / passed) * (gain.velocity.x * ahead + gain.velocity.y * perpendicular(ahead));
    }
}

void InertialMeans::goOn(std::size_t sensor, const InertialMeans& before, std::size_t old_sensor) {
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

void InertialMeans::addTo(std::size_t sensor, Inertia& reading) const {
    const Unit* const unit = find(sensor);
    if (unit == nullptr) return;
    const Frame3 axes(reading.pose);
    const auto add = [&axes](Vec3& sum, Vec3 vector) {
        sum.x += dot(vector, axes.forward);
        sum.y += dot(vector, axes.left);
        sum.z += dot(vector, axes.up);
    };
    add(reading.rates, {0, 0, unit->rate});
    add(reading.accelerations, {unit->acceleration.x, unit->acceleration.y, 0});
}

const InertialMeans::Unit* InertialMeans::find(std::size_t sensor) const {
    const auto found = std::find_if(units_.begin(), units_.end(),
                                    [sensor](const Unit& unit) { return unit.sensor == sensor; });
    return found == units_.end() ? nullptr : &*found;
}

}  // namespace ispace
