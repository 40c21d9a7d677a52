// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of microphones.
#include <cmath>

#include "extensions/microphones/sound_level.h"
#include "sense/formats/field_values.h"

namespace ispace::microphones {

namespace {

using namespace fields;

/// A tenth of a decibel: smaller changes of a state are no events.
FieldValue shortLevel(const View& reading) {
    return fieldOf(std::round(10 * reading.as<SoundLevel>().level) / 10);
}

constexpr ReadingField kMicrophoneFields[] = {
    {"floor", kInInfo, figure<Microphone, &Microphone::floor>},
    {"max", kInInfo, figure<Microphone, &Microphone::max>},
    {"loss", kInInfo, figure<Microphone, &Microphone::loss>},
    {"rate", kInInfo, figure<Microphone, &Microphone::rate>},
    {"level", kInJson | kInColumn,
     [](const View& r) { return FieldValue(Measured{r.as<SoundLevel>().level}); }},
    {"level", kInLine | kIsState, shortLevel},
    {"level", kInArray, measured<SoundLevel, &SoundLevel::level>, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>(); }}};

constexpr RosTopic kMicrophoneTopics[] = {
    {RosType::Float64, "level", RosFrame::Sensor, [](const RosHeader& /*header*/, const View& r) {
         return numberMessage(r.as<SoundLevel>().level);
     }}};

}  // namespace

const ReadingKind SoundLevel::kKind = {.fields = kMicrophoneFields, .topics = kMicrophoneTopics};

}  // namespace ispace::microphones
