// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/robot.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/number.h"
#include "sensor/keys.h"

namespace ispace {

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

/// A speed and the greatest one, in the units of the keys. A written greatest speed lowers a speed
/// that is not written; written both, they must fit.
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

}  // namespace

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
    findings.throwIfAny();
    return base;
}

RobotModel robotOf(const Record& record, const DeviceCatalogue& devices) {
    return parametersOf<RobotModel>(record, deviceOf(record, devices));
}

Pose2 floorPoseOf(const Record& record) {
    const Tuple& at = record.tuple("at");
    return {{at[0], at[1]}, record.angle("heading")};
}

}  // namespace ispace
