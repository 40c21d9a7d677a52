// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of tags, receivers, mats and gates.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "base/number.h"
#include "sense/formats/field_values.h"

namespace ispace {

namespace {

using namespace fields;

/// Fields of JSON that are topics, too.
constexpr char kReceiverTagsText[] = "tags";
constexpr char kMatOnText[] = "on";

// Tags and receivers.

const Burst& burstOf(const View& reading) { return reading.as<Burst>(); }

/// Returns the position by either method of locating, unknown coordinates empty.
std::array<std::optional<double>, 3> positionOf(const Burst& burst) {
    if (burst.fix) return {burst.fix->position.x, burst.fix->position.y, burst.fix->position.z};
    if (burst.simple) return {burst.simple->x, burst.simple->y, std::nullopt};
    return {};
}

template <std::size_t kAxis>
FieldValue coordinate(const View& reading) {
    return Measured{positionOf(burstOf(reading))[kAxis]};
}

template <double PositionFix::*kPart>
FieldValue ofFix(const View& reading) {
    const Burst& burst = burstOf(reading);
    return burst.fix ? Measured{(*burst.fix).*kPart} : Measured{};
}

FieldValue knownPosition(const View& reading) {
    std::vector<Measured> known;
    for (const auto& part : positionOf(burstOf(reading)))
        if (part) known.push_back({part});
    return known.empty() ? FieldValue(Measured{}) : FieldValue(known);
}

FieldValue wholePosition(const View& reading) {
    std::vector<double> parts;
    for (const auto& part : positionOf(burstOf(reading))) parts.push_back(part.value_or(kNoValue));
    return parts;
}

FieldValue heardReceivers(const View& reading) {
    std::vector<FieldRecord> heard;
    for (const TimeOfFlight& flight : burstOf(reading).heard)
        heard.push_back({{{"receiver", FieldText(reading.receivers[flight.receiver].id)},
                          {"time_of_flight", Measured{flight.time}},
                          {"range", Measured{flight.distance}}}});
    return heard;
}

/// Formats RECEIVER=SECONDS pairs, separated by blanks.
FieldValue timesOfFlight(const View& reading) {
    std::string times;
    for (const TimeOfFlight& flight : burstOf(reading).heard) {
        if (!times.empty()) times += ' ';
        times.append(reading.receivers[flight.receiver].id).append("=");
        appendDouble(times, flight.time);
    }
    return FieldText(times);
}

FieldValue rangesOfReceivers(const View& reading) {
    std::vector<double> ranges(reading.receivers.size(), kNoValue);
    for (const TimeOfFlight& flight : burstOf(reading).heard)
        ranges[flight.receiver] = flight.distance;
    return ranges;
}

FieldValue receiverIds(const View& reading) {
    std::vector<std::string> ids;
    for (const Sensor& receiver : reading.receivers) ids.push_back(receiver.id);
    return ids;
}

FieldValue receiverPositions(const View& reading) {
    std::vector<double> parts;
    for (const Sensor& receiver : reading.receivers) {
        const Point3& at = receiver.pose.position;
        parts.insert(parts.end(), {at.x, at.y, at.z});
    }
    return parts;
}

FieldValue heardCount(const View& reading) { return fieldOf(burstOf(reading).heard.size()); }

constexpr ReadingField kTagFields[] = {
    {"fov", kInInfo, figure<Tag, &Tag::fov>},
    {"rate", kInInfo, figure<Tag, &Tag::rate>},
    {"heard", kInJson, heardReceivers},
    {"heard", kInLine, heardCount},
    {"position", kInJson, knownPosition},
    {"x", kInColumn | kInLine, coordinate<0>},
    {"y", kInColumn | kInLine, coordinate<1>},
    {"z", kInColumn | kInLine, coordinate<2>},
    {"residual", kInJson | kInColumn | kInLine, ofFix<&PositionFix::residual>},
    {"pdop", kInJson | kInColumn, ofFix<&PositionFix::pdop>},
    {"hdop", kInJson | kInColumn, ofFix<&PositionFix::hdop>},
    {"vdop", kInJson | kInColumn, ofFix<&PositionFix::vdop>},
    {"heard", kInColumn, heardCount},
    {"times", kInColumn, timesOfFlight},
    {"ranges", kInArray, rangesOfReceivers, kFloat64,
     [](const View& r) { return std::vector<std::uint64_t>{r.receivers.size()}; }},
    {"positions", kInArray, wholePosition, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>{3}; }},
    {"receivers", kInFixed, receiverIds},
    {"receiver_positions", kInFixed, receiverPositions, kFloat64, [](const View& r) {
         return std::vector<std::uint64_t>{r.receivers.size(), 3};
     }}};

constexpr RosTopic kTagTopics[] = {
    {RosType::PointStamped, "position", RosFrame::World,
     [](const RosHeader& header, const View& r) {
         const auto [x, y, z] = positionOf(burstOf(r));
         if (!x) return std::string();
         return pointMessage(header, {*x, *y, z.value_or(r.pose.position.z)});
     }}};

FieldValue heardTags(const View& reading) {
    std::vector<FieldRecord> tags;
    for (const HeardTag& heard : reading.as<Hearings>().tags)
        tags.push_back(
            {{{"tag", FieldText(heard.tag)}, {"time_of_flight", Measured{heard.time_of_flight}}}});
    return tags;
}

FieldValue tagIds(const View& reading) {
    std::vector<std::string> ids;
    for (const HeardTag& heard : reading.as<Hearings>().tags) ids.push_back(heard.tag);
    return ids;
}

FieldValue tagTimes(const View& reading) {
    constexpr int kMicroseconds = 6;
    std::vector<std::string> times;
    for (const HeardTag& heard : reading.as<Hearings>().tags)
        times.push_back(heard.time_of_flight ? formatFixed(*heard.time_of_flight, kMicroseconds)
                                             : "-");
    return times;
}

constexpr RosTopic kReceiverTopics[] = {
    {RosType::String, kReceiverTagsText, RosFrame::Sensor, jsonText<kReceiverTagsText>}};

constexpr ReadingField kReceiverFields[] = {
    {"range_min", kInInfo, figure<Receiver, &Receiver::min_range>},
    {"range_max", kInInfo, figure<Receiver, &Receiver::max_range>},
    {"fov", kInInfo, figure<Receiver, &Receiver::fov>},
    {"rate", kInInfo, figure<Receiver, &Receiver::rate>},
    {"tags", kInJson, heardTags},
    {"tags", kInLine, tagIds},
    {"tof", kInLine, tagTimes}};

// Mats and gates.

template <double Point2::*kCoordinate>
FieldValue onFloor(const View& reading) {
    return Measured{reading.sensor.pose.position.onFloor().*kCoordinate};
}

FieldValue headingOf(const View& reading) {
    return Measured{wrapped(reading.sensor.pose.heading).degrees()};
}

FieldValue matSize(const View& reading) {
    const Mat& mat = reading.sensor.as<Mat>();
    return std::vector<double>{2 * mat.half_length, 2 * mat.half_width};
}

FieldValue countOnMat(const View& reading) { return fieldOf(reading.as<MatState>().on.size()); }

constexpr ReadingField kMatFields[] = {{"x", kInInfo, onFloor<&Point2::x>},
                                       {"y", kInInfo, onFloor<&Point2::y>},
                                       {"heading", kInInfo, headingOf},
                                       {"size", kInInfo, matSize},
                                       {"rate", kInInfo, figure<Mat, &Mat::rate>},
                                       {"n", kInLine | kIsState, countOnMat},
                                       {"on", kInPage, countOnMat},
                                       {"on", kInJson | kInLine | kIsState, [](const View& r) {
                                            return FieldValue(r.as<MatState>().on);
                                        }}};

constexpr RosTopic kMatTopics[] = {
    {RosType::String, kMatOnText, RosFrame::Sensor, jsonText<kMatOnText>}};

FieldValue lastPassage(const View& reading) {
    const GateState& gate = reading.as<GateState>();
    return gate.last.empty() ? FieldText() : FieldText(gate.last);
}

FieldValue wayOfLast(const View& reading) {
    const GateState& gate = reading.as<GateState>();
    return gate.last.empty() ? FieldText() : FieldText(gate.last_in ? "in" : "out");
}

constexpr ReadingField kGateFields[] = {
    {"x", kInInfo, onFloor<&Point2::x>},
    {"y", kInInfo, onFloor<&Point2::y>},
    {"heading", kInInfo, headingOf},
    {"width", kInInfo,
     [](const View& r) { return FieldValue(2 * r.sensor.as<Gate>().half_width); }},
    {"height", kInInfo, figure<Gate, &Gate::height>},
    {"rate", kInInfo, figure<Gate, &Gate::rate>},
    {"in", kInJson | kInLine | kInPage | kIsState, measured<GateState, &GateState::in>},
    {"out", kInJson | kInLine | kInPage | kIsState, measured<GateState, &GateState::out>},
    {"last", kInJson | kInLine, lastPassage},
    {"way", kInJson | kInLine, wayOfLast},
    {"broken", kInJson | kInLine | kIsState, measured<GateState, &GateState::broken>}};

template <std::int64_t GateState::*kCount>
std::string passagesMessage(const RosHeader& /*header*/, const View& reading) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    return integerMessage(
        static_cast<std::int32_t>(std::min(reading.as<GateState>().*kCount, kMost)));
}

constexpr RosTopic kGateTopics[] = {
    {RosType::Int32, "in", RosFrame::Sensor, passagesMessage<&GateState::in>},
    {RosType::Int32, "out", RosFrame::Sensor, passagesMessage<&GateState::out>},
    {RosType::Bool, "broken", RosFrame::Sensor, [](const RosHeader& /*header*/, const View& r) {
         return boolMessage(r.as<GateState>().broken);
     }}};

}  // namespace

const ReadingKind Burst::kKind = {.fields = kTagFields, .topics = kTagTopics};
const ReadingKind Hearings::kKind = {.fields = kReceiverFields, .topics = kReceiverTopics};
const ReadingKind MatState::kKind = {.fields = kMatFields, .topics = kMatTopics};
const ReadingKind GateState::kKind = {.fields = kGateFields, .topics = kGateTopics};

}  // namespace ispace
