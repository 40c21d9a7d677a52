// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/microphones/microphone.h"

#include "base/number.h"
#include "extensions/microphones/sound_level.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"

namespace ispace::microphones {

Microphone withParameters(Microphone base, const Record& record) {
    Diagnostics findings;
    if (record.has("floor")) base.floor = record.number("floor");
    if (record.has("max")) base.max = record.number("max");
    if (record.has("loss")) base.loss = record.number("loss");
    if (record.has("sigma")) base.sigma = record.number("sigma");
    if (record.has("rate")) base.rate = record.number("rate");
    if (base.floor > base.max)
        findings.add(record.finding(record.has("floor") ? "floor" : "max",
                                    "its own noise, " + formatDouble(base.floor) +
                                        " dB, is louder than its loudest sound, " +
                                        formatDouble(base.max) + " dB"));
    findings.throwIfAny();
    return base;
}

namespace {

void addMicrophoneKeys(std::vector<KeySpec>& keys) {
    constexpr double kLoudest = 200;
    const auto decibels = [&keys](std::string name, std::string help) {
        keys.push_back({.name = std::move(name),
                        .type = KeyType::Number,
                        .help = std::move(help),
                        .lower = 0,
                        .upper = kLoudest});
    };
    decibels("floor", "level of its own noise, dB");
    decibels("max", "level of the loudest sound that it tells, dB");
    decibels("loss", "by which each wall between makes a sound quieter, dB");
    decibels("sigma", "standard deviation of a level, dB, with --noise");
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
}

std::vector<SoundSource> soundsOf(const RoomRecords& room) {
    std::vector<SoundSource> sources;
    for (const Record& record : room.records) {
        if (const auto emission = emissionOf(record); emission && emission->volume > 0)
            sources.push_back({emission->pose.position, emission->volume});
        if (record.keyword() != "speaker" || !record.flag("on")) continue;
        const Tuple& at = record.tuple("at");
        sources.push_back({{at[0], at[1], record.number("height")}, record.number("volume")});
    }
    return sources;
}

void lookUpSounds(SensorModel& model, const Record& /*record*/, const RoomRecords& room) {
    changeModel<Microphone>(model, [&room](Microphone& microphone) {
        microphone.sources = room.shared<SoundSource>([&room] { return soundsOf(room); });
    });
}

std::vector<Mesh> microphoneBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.02, -0.02, -0.02}, {0, 0.02, 0.02});
    return {std::move(box)};
}

}  // namespace

const SensorKind Microphone::kKind = {
    .keyword = "microphone",
    .noun = "microphone",
    .help =
        "microphone, which reports the level of speakers by their distance and the walls between; "
        "bare: floor=30 max=120 loss=30 rate=10",
    .heading_help = "direction of its front, from +x; it hears in all directions",
    .device_help = "a microphone one can buy",
    .sign = SensorSign::Square,
    .add_keys = addMicrophoneKeys,
    .body = microphoneBody,
    .read = readModel<Microphone>,
    .look_up = lookUpSounds,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        return {"-", "360", "-", formatDouble(tryModel<Microphone>(model)->rate)};
    },
    .bearings = [](const SensorModel& /*model*/) { return BearingSpan{}; },
    .stopped_by = Surfaces::Solid,
    .perceives = false,
    .is_read = true,
    .measure = measureBy<Microphone>,
    .reading = &SoundLevel::kKind};

void addMicrophones() { addSensorKind(Microphone::kKind); }

}  // namespace ispace::microphones
