// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/rfids/rfid.h"

#include "base/number.h"
#include "extensions/rfids/rfid_tags.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::rfids {

Rfid withParameters(Rfid base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("fov")) applyWindow(record, base.fov_x, base.fov_y, findings);
    if (record.has("rate")) base.rate = record.number("rate");
    if (record.has("read")) base.read = record.number("read");
    findings.throwIfAny();
    return base;
}

FieldOfView fieldOfView(const Rfid& rfid, const Pose3& pose) {
    return FieldOfView::window(pose, 0.5 * rfid.fov_x, 0.5 * rfid.fov_y, rfid.max_range);
}

namespace {

void addRfidKeys(std::vector<KeySpec>& keys) {
    keys.push_back(rangeKey("least and greatest distance of a tag, or the greatest alone"));
    keys.push_back(windowKey());
    keys.push_back(positiveKey("rate", Unit::Frequency, "rounds of inventory a second", kMaxRate));
    keys.push_back({.name = "read",
                    .type = KeyType::Number,
                    .unit = Unit::Share,
                    .help = "share of the rounds that read a tag in the field, with --noise",
                    .lower = 0,
                    .upper = 1});
}

void lookUpTags(SensorModel& model, const Record& /*record*/, const RoomRecords& room) {
    changeModel<Rfid>(model, [&room](Rfid& rfid) { rfid.tags = sharedTags(room); });
}

/// Builds the flat housing of an antenna.
std::vector<Mesh> rfidBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.04, -0.12, -0.12}, {0, 0.12, 0.12});
    return {std::move(box)};
}

}  // namespace

const SensorKind Rfid::kKind = {
    .keyword = "rfid",
    .noun = "RFID reader",
    .help =
        "RFID reader, which lists the tags in its field: the key `tag` of people, robots and "
        "things; bare: range=0,3 fov=70,70 rate=10",
    .heading_help = "direction of the axis of its antenna, from +x",
    .device_help = "an RFID reader or antenna one can buy",
    .sign = SensorSign::Square,
    .add_keys = addRfidKeys,
    .body = rfidBody,
    .read = readModel<Rfid>,
    .look_up = lookUpTags,
    .forget =
        [](SensorModel& model) { changeModel<Rfid>(model, [](Rfid& one) { one.tags = {}; }); },
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Rfid& rfid = *tryModel<Rfid>(model);
        return {rangeText(rfid.min_range, rfid.max_range),
                degreesText(rfid.fov_x) + "x" + degreesText(rfid.fov_y), "-",
                formatDouble(rfid.rate)};
    },
    .view = windowViewOf<Rfid>,
    .bearings = windowBearings<Rfid>,
    .field_of_view = fieldOfViewOf<Rfid>,
    .stopped_by = Surfaces::Solid,
    .is_read = true,
    .is_arranged = true,
    .follows_poses = true,
    .measure = measureBy<Rfid>,
    .reading = &RfidTags::kKind};

void addRfids() { addSensorKind(Rfid::kKind); }

}  // namespace ispace::rfids
