// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of ultra-wideband anchors.
#include <algorithm>

#include "base/number.h"
#include "extensions/uwbs/uwb_ranges.h"
#include "sense/formats/field_values.h"

namespace ispace::uwbs {

namespace {

using namespace fields;

constexpr char kUwbTagsText[] = "tags";

constexpr int kMillimetres = 3;  // decimals of a length in lines of the protocol

const std::vector<UwbRange>& rangesIn(const View& reading) { return reading.as<UwbRanges>().tags; }

FieldValue rangedTags(const View& reading) {
    std::vector<FieldRecord> tags;
    for (const UwbRange& one : rangesIn(reading)) {
        FieldValue position = Measured{};
        FieldValue is_ambiguous = Measured{};
        Measured pdop, hdop, vdop;
        if (one.fix) {
            is_ambiguous = one.fix->is_one_of_two;
            const Point3& at = one.fix->position;
            position = std::vector<Measured>{{at.x}, {at.y}, {at.z}};
            pdop.value = one.fix->pdop;
            hdop.value = one.fix->hdop;
            vdop.value = one.fix->vdop;
        }
        tags.push_back({{{"tag", FieldText(one.tag)},
                         {"range", Measured{one.range}},
                         {"blocked", one.is_blocked},
                         {"position", std::move(position)},
                         {"ambiguous", std::move(is_ambiguous)},
                         {"pdop", pdop},
                         {"hdop", hdop},
                         {"vdop", vdop}}});
    }
    return tags;
}

FieldValue countOfRanges(const View& reading) { return fieldOf(rangesIn(reading).size()); }

FieldValue textsOfTags(const View& reading) {
    std::vector<std::string> texts;
    for (const UwbRange& one : rangesIn(reading)) texts.push_back(one.tag);
    return texts;
}

FieldValue shortRanges(const View& reading) {
    std::vector<std::string> texts;
    for (const UwbRange& one : rangesIn(reading))
        texts.push_back(formatFixed(one.range, kMillimetres));
    return texts;
}

FieldValue blockedOnes(const View& reading) {
    std::vector<std::int64_t> flags;
    for (const UwbRange& one : rangesIn(reading)) flags.push_back(one.is_blocked ? 1 : 0);
    return flags;
}

FieldValue ambiguousOnes(const View& reading) {
    std::vector<std::string> flags;
    for (const UwbRange& one : rangesIn(reading))
        flags.emplace_back(!one.fix ? "-" : one.fix->is_one_of_two ? "1" : "0");
    return flags;
}

/// Lists the tags whose position is one of two, separated by blanks.
FieldValue ambiguousAsText(const View& reading) {
    std::string text;
    for (const UwbRange& one : rangesIn(reading)) {
        if (!one.fix || !one.fix->is_one_of_two) continue;
        if (!text.empty()) text += ' ';
        text += one.tag;
    }
    return FieldText(text);
}

template <double Point3::*kAxis>
FieldValue shortPositions(const View& reading) {
    std::vector<std::string> texts;
    for (const UwbRange& one : rangesIn(reading))
        texts.push_back(one.fix ? formatFixed((one.fix->position).*kAxis, kMillimetres) : "-");
    return texts;
}

/// Formats TAG=RANGE pairs, separated by blanks.
FieldValue rangesAsText(const View& reading) {
    std::string text;
    for (const UwbRange& one : rangesIn(reading)) {
        if (!text.empty()) text += ' ';
        text.append(one.tag).append("=");
        appendDouble(text, one.range);
    }
    return FieldText(text);
}

/// Formats TAG=X/Y/Z of the located tags, separated by blanks.
FieldValue positionsAsText(const View& reading) {
    std::string text;
    for (const UwbRange& one : rangesIn(reading)) {
        if (!one.fix) continue;
        if (!text.empty()) text += ' ';
        text.append(one.tag).append("=");
        const Point3& at = one.fix->position;
        appendDouble(text, at.x);
        appendDouble(text += '/', at.y);
        appendDouble(text += '/', at.z);
    }
    return FieldText(text);
}

/// Returns the tags of the room, sorted, each once.
std::vector<std::string> tagsOfRoom(const View& reading) {
    std::vector<std::string> texts;
    for (const ElectronicTag& tag : reading.sensor.as<Uwb>().tags) texts.push_back(tag.text);
    std::sort(texts.begin(), texts.end());
    texts.erase(std::unique(texts.begin(), texts.end()), texts.end());
    return texts;
}

/// Sets the values of each tag in range, in the order of tagsOfRoom(); the others have none.
template <typename Set>
FieldValue byTag(const View& reading, std::size_t values, Set set) {
    const std::vector<std::string> texts = tagsOfRoom(reading);
    std::vector<double> all(values * texts.size(), kNoValue);
    for (const UwbRange& one : rangesIn(reading)) {
        const auto found = std::lower_bound(texts.begin(), texts.end(), one.tag);
        if (found == texts.end() || *found != one.tag) continue;
        set(one, all.data() + values * static_cast<std::size_t>(found - texts.begin()));
    }
    return all;
}

FieldValue rangesByTag(const View& reading) {
    return byTag(reading, 1, [](const UwbRange& one, double* to) { *to = one.range; });
}

FieldValue positionsByTag(const View& reading) {
    return byTag(reading, 3, [](const UwbRange& one, double* to) {
        if (!one.fix) return;
        const Point3& at = one.fix->position;
        to[0] = at.x;
        to[1] = at.y;
        to[2] = at.z;
    });
}

FieldValue ambiguousByTag(const View& reading) {
    return byTag(reading, 1, [](const UwbRange& one, double* to) {
        if (one.fix) *to = one.fix->is_one_of_two ? 1 : 0;
    });
}

constexpr ReadingField kUwbFields[] = {
    {"range_min", kInInfo, figure<Uwb, &Uwb::min_range>},
    {"range_max", kInInfo, figure<Uwb, &Uwb::max_range>},
    {"loss", kInInfo, figure<Uwb, &Uwb::loss>},
    {"rate", kInInfo, figure<Uwb, &Uwb::rate>},
    {"n", kInLine | kInColumn, countOfRanges},
    {"tags", kInJson, rangedTags},
    {"tags", kInLine | kIsState, textsOfTags},
    {"ranges", kInLine, shortRanges},
    {"blocked", kInLine, blockedOnes},
    {"x", kInLine, shortPositions<&Point3::x>},
    {"y", kInLine, shortPositions<&Point3::y>},
    {"z", kInLine, shortPositions<&Point3::z>},
    {"ambiguous", kInLine, ambiguousOnes},
    {"ranges", kInColumn, rangesAsText},
    {"positions", kInColumn, positionsAsText},
    {"ambiguous", kInColumn, ambiguousAsText},
    {"ranges", kInArray, rangesByTag, kFloat64,
     [](const View& r) { return std::vector<std::uint64_t>{tagsOfRoom(r).size()}; }},
    {"positions", kInArray, positionsByTag, kFloat64,
     [](const View& r) {
         return std::vector<std::uint64_t>{tagsOfRoom(r).size(), 3};
     }},
    {"ambiguous", kInArray, ambiguousByTag, kFloat64,
     [](const View& r) { return std::vector<std::uint64_t>{tagsOfRoom(r).size()}; }},
    {"tags", kInFixed, [](const View& r) { return FieldValue(tagsOfRoom(r)); }},
    {"limits", kInFixed, limitsOf<Uwb>}};

constexpr RosTopic kUwbTopics[] = {
    {RosType::String, kUwbTagsText, RosFrame::Sensor, jsonText<kUwbTagsText>}};

}  // namespace

const ReadingKind UwbRanges::kKind = {.fields = kUwbFields, .topics = kUwbTopics};

}  // namespace ispace::uwbs
