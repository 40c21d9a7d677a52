// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/robot.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "base/number.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

double shareOfSwing(double speed) {
    constexpr double kFullSwing = 0.5;  // m/s
    return std::min(1.0, std::abs(speed) / kFullSwing);
}

Angle limbSwing(double phase, double speed) {
    return Angle::degrees(kMaxSwingDegrees * shareOfSwing(speed) *
                          std::sin(2 * std::numbers::pi * phase));
}

Pose3 poseOn(const Pose2& carrier, const Pose3& pose) {
    const Vec2 way = pose.position.onFloor() - carrier.position;
    const auto [c, s] = cosSin(carrier.heading);
    return {{way.x * c + way.y * s, way.y * c - way.x * s, pose.position.z},
            pose.heading - carrier.heading,
            pose.tilt,
            pose.roll};
}

namespace {

void applyBody(RobotModel& model, const Record& record) {
    if (record.has("radius")) model.radius = record.number("radius");
    if (record.has("center")) model.center = record.number("center");
    if (record.has("height")) model.height = record.number("height");
    if (!record.has("size")) return;
    const Tuple& size = record.tuple("size");
    model.length = size[0];
    model.width = size[1];
    if (size.size() > 2) model.height = size[2];
}

/// A speed and its maximum, in the units of the keys. A written maximum lowers an unwritten speed;
/// if both are written, the maximum must not be less.
struct SpeedKeys {
    std::string_view speed, greatest, unit;
};

void applySpeed(const SpeedKeys& keys, double& speed, double& greatest, const Record& record,
                Diagnostics& findings) {
    if (record.has(keys.greatest)) greatest = record.number(keys.greatest);
    if (!record.has(keys.speed)) {
        speed = std::min(speed, greatest);
        return;
    }
    speed = record.number(keys.speed);
    if (speed <= greatest) return;
    std::string message(keys.speed);
    message.append(" ").append(formatDouble(speed)).append(" ").append(keys.unit);
    message.append(" is above ").append(keys.greatest).append(" ");
    message.append(formatDouble(greatest)).append(" ").append(keys.unit);
    findings.add(record.finding(keys.speed, std::move(message)));
}

void applyWheels(RobotModel& model, const Record& record) {
    if (!record.has("wheels")) return;
    const Tuple& wheels = record.tuple("wheels");
    model.wheels = {wheels[0], wheels[1]};
}

void applyNoise(MotionNoise& noise, const Record& record) {
    const auto apply = [&](std::string_view key, std::array<double, 4>& alphas) {
        if (!record.has(key)) return;
        const Tuple& values = record.tuple(key);
        std::copy(values.begin(), values.end(), alphas.begin());
    };
    apply("motion_noise", noise.motion);
    apply("odometry_noise", noise.odometry);
    if (!record.has("start_noise")) return;
    const Tuple& start = record.tuple("start_noise");
    noise.start_place = start[0];
    noise.start_heading = Angle::degrees(start.size() > 1 ? start[1] : 0);
}

void applyDrive(RobotModel& model, const Record& record, Diagnostics& findings) {
    if (record.has("drive")) {
        model.drive = record.text("drive") == "omni" ? Drive::Omni : Drive::Differential;
        model.max_sidespeed = model.drive == Drive::Omni ? model.max_speed : 0;
    }
    if (!record.has("max_sidespeed")) return;
    model.max_sidespeed = record.number("max_sidespeed");
    if (model.drive == Drive::Omni) return;
    findings.add(
        record.finding("max_sidespeed", "only drive=omni goes sideways: say so, or leave it out"));
}

void applyContacts(RobotModel& model, const Record& record, Diagnostics& findings) {
    if (record.has("sonar")) {
        model.sonar.places.clear();
        for (const Tuple& place : record.list("sonar"))
            model.sonar.places.push_back({{place[0], place[1]}, Angle::degrees(place[2])});
    }
    if (record.has("sonar_range")) {
        const Tuple& range = record.tuple("sonar_range");
        if (range.size() > 1) model.sonar.min_range = range.front();
        model.sonar.max_range = range.back();
        if (model.sonar.max_range <= model.sonar.min_range)
            findings.add(record.finding(
                "sonar_range",
                "the greatest range of sonars, " + formatDouble(model.sonar.max_range) +
                    " m, must be above the least, " + formatDouble(model.sonar.min_range) + " m"));
    }
    if (record.has("sonar_fov")) model.sonar.fov = record.angle("sonar_fov");
    if (!record.has("bumpers")) return;
    model.bumpers.clear();
    for (const Tuple& part : record.list("bumpers")) {
        model.bumpers.push_back({Angle::degrees(part[0]), Angle::degrees(part[1])});
        if (part[0] < part[1] && part[1] - part[0] <= 360) continue;
        findings.add(record.finding(
            "bumpers", "`bumpers`: " + formatDouble(part[0]) + "," + formatDouble(part[1]) +
                           " is no part of a turn, wanted FROM,TO counter-clockwise"));
    }
}

}  // namespace

Wheels wheelsOf(const RobotModel& model) {
    if (model.wheels.radius > 0) return model.wheels;
    constexpr double kTrack = 0.8, kMaxRadius = 0.2;  // shares of the width
    const double width = model.length > 0 ? model.width : 2 * model.radius;
    return {std::min(model.height / 2, kMaxRadius * width), kTrack * width};
}

RobotModel withParameters(RobotModel base, const Record& record) {
    Diagnostics findings;
    applyBody(base, record);
    applySpeed({"speed", "max_speed", "m/s"}, base.speed, base.max_speed, record, findings);
    double turn = base.rotspeed.degrees(), greatest_turn = base.max_rotspeed.degrees();
    applySpeed({"rotspeed", "max_rotspeed", "deg/s"}, turn, greatest_turn, record, findings);
    base.rotspeed = Angle::degrees(turn);
    base.max_rotspeed = Angle::degrees(greatest_turn);
    if (record.has("accel")) base.accel = record.number("accel");
    if (record.has("rotaccel")) base.rotaccel = record.angle("rotaccel");
    applyDrive(base, record, findings);
    applyWheels(base, record);
    applyNoise(base.noise, record);
    applyContacts(base, record, findings);
    findings.throwIfAny();
    return base;
}

RobotModel robotOf(const Record& record, const DeviceCatalogue& devices) {
    return parametersOf<RobotModel>(record, deviceOf(record, devices));
}

MotionPlan courseOf(const Record& record) {
    MotionPlan course;
    if (record.has("path"))
        for (const Tuple& place : record.list("path")) course.path.push_back({place[0], place[1]});
    course.loop = record.flag("loop");
    course.pause = record.number("pause");
    course.wander = record.text("walk") == "wander";
    return course;
}

Pose2 floorPoseOf(const Record& record) {
    const Tuple& at = record.tuple("at");
    return {{at[0], at[1]}, record.angle("heading")};
}

}  // namespace ispace
