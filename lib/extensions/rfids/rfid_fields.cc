// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of RFID readers.
#include "extensions/rfids/rfid_tags.h"
#include "sense/formats/field_values.h"

namespace ispace::rfids {

namespace {

using namespace fields;

constexpr char kRfidTagsText[] = "tags";

FieldValue countOfTags(const View& reading) { return fieldOf(reading.as<RfidTags>().tags.size()); }

constexpr ReadingField kRfidFields[] = {
    {"range_min", kInInfo, figure<Rfid, &Rfid::min_range>},
    {"range_max", kInInfo, figure<Rfid, &Rfid::max_range>},
    {"fov", kInInfo,
     [](const View& r) {
         const Rfid& rfid = r.sensor.as<Rfid>();
         return FieldValue(std::vector{rfid.fov_x, rfid.fov_y});
     }},
    {"rate", kInInfo, figure<Rfid, &Rfid::rate>},
    {"n", kInLine | kInColumn, countOfTags},
    {"tags", kInJson | kInLine | kIsState,
     [](const View& r) { return FieldValue(r.as<RfidTags>().tags); }},
    {"n", kInArray,
     [](const View& r) { return FieldValue(static_cast<double>(r.as<RfidTags>().tags.size())); },
     kFloat64, [](const View&) { return std::vector<std::uint64_t>(); }},
    {"limits", kInFixed, limitsOf<Rfid>}};

constexpr RosTopic kRfidTopics[] = {
    {RosType::String, kRfidTagsText, RosFrame::Sensor, jsonText<kRfidTagsText>}};

}  // namespace

const ReadingKind RfidTags::kKind = {.fields = kRfidFields, .topics = kRfidTopics};

}  // namespace ispace::rfids
