// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pirs/pir.h"

#include "base/number.h"
#include "extensions/pirs/pir_state.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::pirs {

Pir withParameters(Pir base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("fov")) applyWindow(record, base.fov_x, base.fov_y, findings);
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("hold")) base.hold = record.number("hold");
    if (record.has("min_speed")) base.min_speed = record.number("min_speed");
    if (record.has("dropout")) base.dropout = record.number("dropout");
    if (record.has("false_alarms")) base.false_alarms = record.number("false_alarms");
    findings.throwIfAny();
    return base;
}

FieldOfView fieldOfView(const Pir& pir, const Pose3& pose) {
    return FieldOfView::window(pose, 0.5 * pir.fov_x, 0.5 * pir.fov_y, pir.max_range);
}

bool senses(const Pir& pir, Vec2 velocity) {
    const double speed = length(velocity);
    return speed >= pir.min_speed && speed > 0;
}

namespace {

void addPirKeys(std::vector<KeySpec>& keys) {
    constexpr double kMaxSpeed = 1e3, kMaxHold = 86'400, kMaxAlarms = 3600;
    keys.push_back(rangeKey("least and greatest distance detected, or the greatest alone"));
    keys.push_back(windowKey());
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
    keys.push_back({.name = "hold",
                    .type = KeyType::Number,
                    .unit = Unit::Time,
                    .help = "seconds for which the output stays on after a detection; in a run",
                    .lower = 0,
                    .upper = kMaxHold});
    keys.push_back({.name = "min_speed",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "least speed over the floor, metres a second; slower people are unseen",
                    .lower = 0,
                    .upper = kMaxSpeed});
    keys.push_back({.name = "dropout",
                    .type = KeyType::Number,
                    .unit = Unit::Share,
                    .help = "share of the detections that is lost, with --noise",
                    .lower = 0,
                    .upper = 1});
    keys.push_back({.name = "false_alarms",
                    .type = KeyType::Number,
                    .help = "detections of none an hour, with --noise",
                    .lower = 0,
                    .upper = kMaxAlarms});
}

/// Builds a flat box with the dome of its lens in front.
std::vector<Mesh> pirBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.03, -0.03, -0.05}, {-0.01, 0.03, 0.05});
    addBall(box, {-0.01, 0, 0}, 0.01);
    return {std::move(box)};
}

}  // namespace

const SensorKind Pir::kKind = {
    .keyword = "pir",
    .noun = "PIR sensor",
    .help =
        "passive infrared sensor, which detects people who move; bare: range=0,7 fov=110,80 "
        "rate=10 hold=2 min_speed=0.1",
    .heading_help = "direction of its axis, from +x",
    .device_help = "a passive infrared sensor one can buy",
    .sign = SensorSign::Square,
    .add_keys = addPirKeys,
    .body = pirBody,
    .read = readModel<Pir>,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Pir& pir = *tryModel<Pir>(model);
        return {rangeText(pir.min_range, pir.max_range),
                degreesText(pir.fov_x) + "x" + degreesText(pir.fov_y), "-", formatDouble(pir.rate)};
    },
    .view = windowViewOf<Pir>,
    .bearings = windowBearings<Pir>,
    .field_of_view = fieldOfViewOf<Pir>,
    .stopped_by = Surfaces::Solid,
    .is_read = true,
    .is_arranged = true,
    .follows_poses = true,
    .senses = [](const SensorModel& model, Vec2 velocity,
                 Vec3 /*direction*/) { return senses(*tryModel<Pir>(model), velocity); },
    .measure = measureBy<Pir>,
    .follow =
        [](const AddedReading& before, AddedReading& now) {
            keepOn(before.as<PirState>(), now.time - before.time, now.as<PirState>());
        },
    .reading = &PirState::kKind};

void addPirs() { addSensorKind(Pir::kKind); }

}  // namespace ispace::pirs
