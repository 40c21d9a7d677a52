// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of passive infrared sensors.
#include "extensions/pirs/pir_state.h"
#include "sense/formats/field_values.h"

namespace ispace::pirs {

namespace {

using namespace fields;

FieldValue motionAsNumber(const View& reading) {
    return fieldOf(int{reading.as<PirState>().motion});
}

constexpr ReadingField kPirFields[] = {
    {"range_min", kInInfo, figure<Pir, &Pir::min_range>},
    {"range_max", kInInfo, figure<Pir, &Pir::max_range>},
    {"fov", kInInfo,
     [](const View& r) {
         const Pir& pir = r.sensor.as<Pir>();
         return FieldValue(std::vector{pir.fov_x, pir.fov_y});
     }},
    {"hold", kInInfo, figure<Pir, &Pir::hold>},
    {"min_speed", kInInfo, figure<Pir, &Pir::min_speed>},
    {"rate", kInInfo, figure<Pir, &Pir::rate>},
    {"motion", kInJson | kInLine | kIsState, measured<PirState, &PirState::motion>},
    {"motion", kInColumn | kInPage, motionAsNumber},
    {"motion", kInArray,
     [](const View& r) { return FieldValue(r.as<PirState>().motion ? 1.0 : 0.0); }, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>(); }},
    {"limits", kInFixed, limitsOf<Pir>}};

constexpr RosTopic kPirTopics[] = {
    {RosType::Bool, "motion", RosFrame::Sensor, [](const RosHeader& /*header*/, const View& r) {
         return boolMessage(r.as<PirState>().motion);
     }}};

}  // namespace

const ReadingKind PirState::kKind = {.fields = kPirFields, .topics = kPirTopics};

}  // namespace ispace::pirs
