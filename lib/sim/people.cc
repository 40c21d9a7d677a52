// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/people.h"

#include <cmath>

#include "layout/bodies.h"
#include "layout/movement.h"

namespace ispace {

std::vector<Mover> moversOf(const Scene& scene) {
    std::vector<Mover> movers;
    movers.reserve(scene.robots.size() + scene.people.size());
    for (const PlacedRobot& robot : scene.robots)
        movers.push_back({robot.id, robot.model, robot.pose, robot.course, robot.place});
    for (const PlacedPerson& person : scene.people)
        movers.push_back(
            {person.id, modelOf(person), person.pose, person.course, person.place, true});
    return movers;
}

RobotModel modelOf(const PlacedPerson& person) {
    constexpr double kRelaxation = 0.5, kHurry = 1.3;
    RobotModel model;
    model.radius = humanRadius(person.height);
    model.height = person.height;
    model.speed = person.speed;
    model.max_speed = kHurry * person.speed;
    model.accel = person.speed / kRelaxation;
    model.rotspeed = Angle::degrees(180);
    model.max_rotspeed = Angle::degrees(360);
    model.rotaccel = Angle::degrees(720);
    model.drive = Drive::Omni;
    model.max_sidespeed = person.speed / 2;
    return model;
}

Angle Gait::swing(double speed) const { return limbSwing(phase, speed); }

void Gait::walk(double height, double way, double speed) {
    if (way == 0 || speed == 0) return;
    phase += way / (strideOf(height) * shareOfSwing(speed));
    phase -= std::floor(phase);
    if (phase >= 1) phase = 0;  // a hair below 0, rounded
}

}  // namespace ispace
