// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/luxes/lux.h"

#include "base/number.h"
#include "extensions/luxes/illuminance.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"

namespace ispace::luxes {

Lux withParameters(Lux base, const Record& record) {
    if (record.has("max")) base.max = record.number("max");
    if (record.has("resolution")) base.resolution = record.number("resolution");
    if (record.has("error")) base.error = record.number("error");
    if (record.has("rate")) base.rate = record.number("rate");
    return base;
}

void addLightKeys(std::vector<KeySpec>& keys) {
    constexpr double kBrightest = 1e6;
    keys.push_back(
        positiveKey("max", Unit::None, "greatest illuminance that it tells, lux", kBrightest));
    keys.push_back({.name = "resolution",
                    .type = KeyType::Number,
                    .help = "least difference that it tells, lux, with --noise",
                    .lower = 0,
                    .upper = kBrightest});
    keys.push_back({.name = "error",
                    .type = KeyType::Number,
                    .unit = Unit::Share,
                    .help = "standard deviation of its constant factor, with --noise",
                    .lower = 0,
                    .upper = 1});
}

namespace {

void addLuxKeys(std::vector<KeySpec>& keys) {
    addLightKeys(keys);
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
}

std::vector<Lux::Light> lightsOf(const RoomRecords& room) {
    std::vector<Lux::Light> lights;
    for (const Record& record : room.records) {
        if (record.keyword() != "lamp" || !record.flag("on") || record.number("level") == 0)
            continue;
        const Tuple& at = record.tuple("at");
        lights.push_back({{at[0], at[1]},
                          record.number("level") * record.number("lumens"),
                          unitVector(Angle::degrees(record.number("heading")))});
    }
    return lights;
}

std::vector<ProjectorBeam> beamsOf(const RoomRecords& room) {
    std::vector<ProjectorBeam> beams;
    for (const Record& record : room.records) {
        if (const auto emission = emissionOf(record); emission && emission->lumens > 0) {
            const double half = tan(Angle::degrees(emission->spread.degrees() / 2));
            beams.push_back({Frame3(emission->pose), half, half, emission->lumens});
        }
        if (record.keyword() != "projector") continue;
        if (auto beam = projectorBeam(record)) beams.push_back(*beam);
    }
    return beams;
}

void lookUp(SensorModel& model, const Record& /*record*/, const RoomRecords& room) {
    changeModel<Lux>(model, [&room](Lux& lux) { lookUpLights(lux, room); });
}

std::vector<Mesh> luxBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.02, -0.02, -0.02}, {0, 0.02, 0.02});
    return {std::move(box)};
}

}  // namespace

void lookUpLights(Lux& lux, const RoomRecords& room) {
    lux.lights = room.shared<Lux::Light>([&room] { return lightsOf(room); });
    lux.beams = room.shared<ProjectorBeam>([&room] { return beamsOf(room); });
}

const SensorKind Lux::kKind = {
    .keyword = "lux",
    .noun = "light meter",
    .help =
        "light meter, which reports the light of lamps and projectors on a spot; bare: max=100000 "
        "rate=1",
    .heading_help = "direction that the spot faces, from +x",
    .device_help = "a light meter one can buy",
    .sign = SensorSign::Square,
    .add_keys = addLuxKeys,
    .body = luxBody,
    .read = readModel<Lux>,
    .look_up = lookUp,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        return {"-", "180", "-", formatDouble(tryModel<Lux>(model)->rate)};
    },
    .bearings = [](const SensorModel& /*model*/) { return BearingSpan{}; },
    .perceives = false,
    .is_read = true,
    .measure = measureBy<Lux>,
    .reading = &Illuminance::kKind};

void addLuxes() { addSensorKind(Lux::kKind); }

}  // namespace ispace::luxes
