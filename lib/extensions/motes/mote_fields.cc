// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of motes.
#include <cmath>

#include "base/number.h"
#include "extensions/motes/mote_report.h"
#include "sense/formats/field_values.h"

namespace ispace::motes {

namespace {

using namespace fields;

constexpr char kNeighboursText[] = "neighbours";

FieldValue roundedLux(const View& reading) {
    return fieldOf(static_cast<std::int64_t>(std::llround(reading.as<MoteReport>().lux)));
}

const std::vector<Neighbour>& neighboursIn(const View& reading) {
    return reading.as<MoteReport>().neighbours;
}

FieldValue neighbourRecords(const View& reading) {
    std::vector<FieldRecord> records;
    for (const Neighbour& one : neighboursIn(reading))
        records.push_back({{{"mote", FieldText(one.mote)}, {"margin", Measured{one.margin}}}});
    return records;
}

FieldValue countOfNeighbours(const View& reading) { return fieldOf(neighboursIn(reading).size()); }

FieldValue neighbourIds(const View& reading) {
    std::vector<std::string> ids;
    for (const Neighbour& one : neighboursIn(reading)) ids.push_back(one.mote);
    return ids;
}

FieldValue shortMargins(const View& reading) {
    std::vector<std::string> texts;
    for (const Neighbour& one : neighboursIn(reading)) texts.push_back(formatFixed(one.margin, 1));
    return texts;
}

/// Formats MOTE=MARGIN pairs, separated by blanks.
FieldValue marginsAsText(const View& reading) {
    std::string text;
    for (const Neighbour& one : neighboursIn(reading)) {
        if (!text.empty()) text += ' ';
        text.append(one.mote).append("=");
        appendDouble(text, one.margin);
    }
    return FieldText(text);
}

FieldValue motesOfRoom(const View& reading) {
    std::vector<std::string> ids;
    for (const MoteRadio& one : reading.sensor.as<Mote>().motes)
        ids.push_back(reading.sensor.idBeside(one.id));
    return ids;
}

FieldValue marginsByMote(const View& reading) {
    std::vector<double> margins;
    const std::vector<Neighbour>& neighbours = neighboursIn(reading);
    auto next = neighbours.begin();  // both are in the order of the scene
    for (const MoteRadio& one : reading.sensor.as<Mote>().motes) {
        const bool is_heard =
            next != neighbours.end() && next->mote == reading.sensor.idBeside(one.id);
        margins.push_back(is_heard ? next->margin : kNoValue);
        if (is_heard) ++next;
    }
    return margins;
}

constexpr ReadingField kMoteFields[] = {
    {"radio", kInInfo, figure<Mote, &Mote::radio>},
    {"loss", kInInfo, figure<Mote, &Mote::loss>},
    {"rate", kInInfo, figure<Mote, &Mote::rate>},
    {"lux", kInJson | kInColumn,
     [](const View& r) { return FieldValue(Measured{r.as<MoteReport>().lux}); }},
    {"lux", kInLine | kIsState, roundedLux},
    {"lux", kInArray, measured<MoteReport, &MoteReport::lux>, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>(); }},
    {"n", kInLine | kInColumn, countOfNeighbours},
    {"neighbours", kInJson, neighbourRecords},
    {"neighbours", kInLine | kIsState, neighbourIds},
    {"margins", kInLine, shortMargins},
    {"margins", kInColumn, marginsAsText},
    {"margins", kInArray, marginsByMote, kFloat64,
     [](const View& r) { return std::vector<std::uint64_t>{r.sensor.as<Mote>().motes.size()}; }},
    {"motes", kInFixed, motesOfRoom}};

constexpr RosTopic kMoteTopics[] = {
    {RosType::Illuminance, "illuminance", RosFrame::Sensor,
     [](const RosHeader& header, const View& r) {
         return measureMessage(header, r.as<MoteReport>().lux);
     }},
    {RosType::String, kNeighboursText, RosFrame::Sensor, jsonText<kNeighboursText>}};

}  // namespace

const ReadingKind MoteReport::kKind = {.fields = kMoteFields, .topics = kMoteTopics};

}  // namespace ispace::motes
