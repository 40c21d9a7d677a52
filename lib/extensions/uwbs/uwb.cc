// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/uwbs/uwb.h"

#include <vector>

#include "base/number.h"
#include "extensions/uwbs/uwb_ranges.h"
#include "scene/devices.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::uwbs {

Uwb withParameters(Uwb base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("loss")) base.loss = record.number("loss");
    if (record.has("bias")) base.noise.bias = record.number("bias");
    if (record.has("sigma")) base.noise.sigma[0] = record.number("sigma");
    if (record.has("dropout")) base.noise.dropout = record.number("dropout");
    if (record.has("blocked")) {
        const Tuple& blocked = record.tuple("blocked");
        base.blocked_bias = blocked[0];
        base.blocked_sigma = blocked[1];
    }
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("slots")) base.slots = static_cast<std::size_t>(record.number("slots"));
    findings.throwIfAny();
    return base;
}

FieldOfView fieldOfView(const Uwb& uwb, const Pose3& pose) {
    return FieldOfView::window(pose, Angle::degrees(180), Angle::degrees(90), uwb.max_range);
}

namespace {

void addUwbKeys(std::vector<KeySpec>& keys) {
    constexpr double kMaxError = 1e3, kMaxLoss = 200, kMaxSlots = 1e6;
    keys.push_back(rangeKey("least and greatest range in line of sight, or the greatest alone"));
    keys.push_back({.name = "loss",
                    .type = KeyType::Number,
                    .help = "by which each wall or mover between weakens the signal, dB: 6 halve "
                            "the range",
                    .lower = 0,
                    .upper = kMaxLoss});
    keys.push_back({.name = "bias",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "mean error of a range in line of sight, with --noise",
                    .lower = -kMaxError,
                    .upper = kMaxError});
    keys.push_back({.name = "sigma",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "standard deviation of a range in line of sight, with --noise",
                    .lower = 0,
                    .upper = kMaxError});
    keys.push_back({.name = "blocked",
                    .type = KeyType::Tuple,
                    .unit = Unit::Length,
                    .help = "mean and standard deviation of the error that each wall or mover "
                            "between adds, with --noise",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = 0,
                    .upper = kMaxError});
    keys.push_back({.name = "dropout",
                    .type = KeyType::Number,
                    .unit = Unit::Share,
                    .help = "share of the ranges that is lost, with --noise",
                    .lower = 0,
                    .upper = 1});
    keys.push_back(positiveKey("rate", Unit::Frequency, "rounds of ranges a second", kMaxRate));
    keys.push_back({.name = "slots",
                    .type = KeyType::Number,
                    .help = "tags that a round has time for: the nearest that answer",
                    .lower = 1,
                    .upper = kMaxSlots,
                    .whole = true});
}

/// Returns the anchors that stand by themselves.
std::vector<UwbAnchor> anchorsOf(const RoomRecords& room) {
    std::vector<UwbAnchor> anchors;
    for (std::size_t i = 0; i < room.records.size(); ++i) {
        const Record& record = room.records[i];
        if (record.keyword() != "uwb" || !record.has("at") || record.has("on")) continue;
        anchors.push_back({room.ids[i], poseOf(record),
                           parametersOf<Uwb>(record, deviceOf(record, room.devices))});
    }
    return anchors;
}

void lookUpTagsAndAnchors(SensorModel& model, const Record& /*record*/, const RoomRecords& room) {
    changeModel<Uwb>(model, [&room](Uwb& uwb) {
        uwb.tags = sharedTags(room);
        uwb.anchors = room.shared<UwbAnchor>([&room] { return anchorsOf(room); });
    });
}

void forgetTagsAndAnchors(SensorModel& model) {
    changeModel<Uwb>(model, [](Uwb& uwb) {
        uwb.tags = {};
        uwb.anchors = {};
    });
}

/// Builds a housing with a stub antenna.
std::vector<Mesh> uwbBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.02, -0.03, -0.06}, {0, 0.03, 0});
    addBox(box, {-0.015, -0.005, 0}, {-0.005, 0.005, 0.06});
    return {std::move(box)};
}

}  // namespace

const SensorKind Uwb::kKind = {
    .keyword = "uwb",
    .noun = "UWB anchor",
    .help =
        "ultra-wideband anchor, which measures the ranges of tags: the key `tag` of people, robots "
        "and things; bare: range=50 loss=6 rate=10 slots=64",
    .heading_help = "direction that it faces, from +x; it measures in all directions",
    .device_help = "an ultra-wideband module one can buy",
    .sign = SensorSign::Triangle,
    .add_keys = addUwbKeys,
    .body = uwbBody,
    .read = readModel<Uwb>,
    .look_up = lookUpTagsAndAnchors,
    .forget = forgetTagsAndAnchors,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Uwb& uwb = *tryModel<Uwb>(model);
        return {rangeText(uwb.min_range, uwb.max_range), "360", "-", formatDouble(uwb.rate)};
    },
    .bearings = [](const SensorModel& model) -> BearingSpan {
        const Angle half_turn = Angle::degrees(180);
        return {-half_turn, half_turn, tryModel<Uwb>(model)->max_range};
    },
    .field_of_view = fieldOfViewOf<Uwb>,
    .stopped_by = Surfaces::Solid,
    .is_read = true,
    .is_arranged = true,
    .follows_poses = true,
    .locates_together = kMinAnchors,
    .sight_errors = [](const SensorModel& model, double range) -> SightErrors {
        return {distanceSigma(tryModel<Uwb>(model)->noise, range), 0};
    },
    .measure = measureBy<Uwb>,
    .reading = &UwbRanges::kKind};

void addUwbs() { addSensorKind(Uwb::kKind); }

}  // namespace ispace::uwbs
