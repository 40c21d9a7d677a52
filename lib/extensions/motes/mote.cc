// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/motes/mote.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "env/body.h"
#include "extensions/motes/mote_report.h"
#include "scene/robot.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/pose_on_carrier.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"

namespace ispace::motes {

Mote withParameters(Mote base, const Record& record) {
    base.meter = withParameters(std::move(base.meter), record);
    if (record.has("radio")) base.radio = record.number("radio");
    if (record.has("loss")) base.loss = record.number("loss");
    if (record.has("rate")) base.rate = record.number("rate");
    return base;
}

namespace {

void addMoteKeys(std::vector<KeySpec>& keys) {
    constexpr double kMaxLoss = 200;
    keys.push_back(positiveKey("radio", Unit::Length,
                               "greatest distance of motes that it hears, without walls between",
                               kMaxDistance));
    keys.push_back({.name = "loss",
                    .type = KeyType::Number,
                    .help = "by which each wall between weakens a signal, dB: 6 halve the distance",
                    .lower = 0,
                    .upper = kMaxLoss});
    luxes::addLightKeys(keys);
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
}

/// Returns how far the middle of a robot's body lies ahead of its axis.
double bodyAheadOf(const Record& robot, const RoomRecords& room) {
    try {
        return robotOf(robot, room.devices).center;
    } catch (const FormatError&) {
        return 0;  // reported by the scene
    }
}

/// Computes the position of a mote; empty if it has none yet.
std::optional<MoteRadio> radioOf(const Record& mote, const std::string& id,
                                 const RoomRecords& room) {
    const Pose3 local = poseOf(mote);
    if (!mote.has("on"))
        return mote.has("at") ? std::optional(MoteRadio{id, local.position}) : std::nullopt;
    const auto found = std::find(room.ids.begin(), room.ids.end(), mote.text("on"));
    if (found == room.ids.end()) return std::nullopt;  // reported by the scene
    const auto index = static_cast<std::size_t>(found - room.ids.begin());
    const Record& carrier = room.records[index];
    const bool is_person = carrier.keyword() == "human";
    if (is_person || carrier.keyword() == "robot") {
        const auto before = room.records.first(index);
        const auto number = std::count_if(before.begin(), before.end(), [&](const Record& record) {
            return record.keyword() == carrier.keyword();
        });
        // It sends from the carrier's axis, or from its place on a person that sits or lies.
        Point3 at{-bodyAheadOf(carrier, room), 0, local.position.z};
        if (is_person) {
            at = poseOnPerson(mote, carrier).position;
            if (figureOf(carrier) == nullptr) at = {0, 0, at.z};
        }
        return MoteRadio{id, at, static_cast<std::size_t>(number), is_person};
    }
    Pose3 pose = mountedPose(floorPoseOf(carrier), local);
    pose.position.z += topOf(bodyOf(carrier));
    return MoteRadio{id, pose.position};
}

std::vector<MoteRadio> radiosOf(const RoomRecords& room) {
    std::vector<MoteRadio> radios;
    for (std::size_t i = 0; i < room.records.size(); ++i)
        if (room.records[i].keyword() == "mote")
            if (auto radio = radioOf(room.records[i], room.ids[i], room))
                radios.push_back(*std::move(radio));
    return radios;
}

void lookUpLightsAndMotes(SensorModel& model, const Record& /*record*/, const RoomRecords& room) {
    changeModel<Mote>(model, [&room](Mote& mote) {
        lookUpLights(mote.meter, room);
        mote.motes = room.shared<MoteRadio>([&room] { return radiosOf(room); });
        mote.grid = room.shared<MoteGrid>([&mote] {
            return std::vector{MoteGrid({mote.motes.begin(), mote.motes.end()})};
        });
    });
}

/// Builds a housing with a stub antenna.
std::vector<Mesh> moteBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.02, -0.033, -0.016}, {0, 0.033, 0.016});
    addBox(box, {-0.015, 0.025, 0.016}, {-0.01, 0.03, 0.05});
    return {std::move(box)};
}

}  // namespace

const SensorKind Mote::kKind = {
    .keyword = "mote",
    .noun = "mote",
    .help =
        "node of a wireless sensor network, which reports the light on it and the nodes that it "
        "hears; bare: radio=30 loss=6 max=100000 rate=1",
    .heading_help = "direction that its light sensor faces, from +x",
    .device_help = "a node of wireless sensor networks one can buy",
    .sign = SensorSign::Diamond,
    .add_keys = addMoteKeys,
    .body = moteBody,
    .read = readModel<Mote>,
    .look_up = lookUpLightsAndMotes,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const Mote& mote = *tryModel<Mote>(model);
        return {rangeText(0, mote.radio), "180", "-", formatDouble(mote.rate)};
    },
    .bearings = [](const SensorModel& /*model*/) { return BearingSpan{}; },
    .stopped_by = Surfaces::Solid,
    .perceives = false,
    .is_read = true,
    .measure = measureBy<Mote>,
    .reading = &MoteReport::kKind};

void addMotes() { addSensorKind(Mote::kKind); }

}  // namespace ispace::motes
