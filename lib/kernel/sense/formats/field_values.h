// SPDX-License-Identifier: GPL-3.0-or-later
// Values of fields, for the tables of kinds.
//
// A table names a field, the formats that write it, and a function of this file as its value:
//
//     constexpr ReadingField kFields[] = {
//         {"rate", kInInfo, fields::figure<Laser, &Laser::rate>},
//         {"last", kInJson, fields::measured<GateState, &GateState::last_in>}};
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "sense/formats/reading_fields.h"
#include "sense/formats/reading_text.h"

namespace ispace::fields {

using View = ReadingView;

inline constexpr std::string_view kFloat32 = "<f4", kFloat64 = "<f8", kByte8 = "|u1";
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

inline FieldValue fieldOf(double value) { return value; }
inline FieldValue fieldOf(Angle value) { return value; }
inline FieldValue fieldOf(bool value) { return value; }
inline FieldValue fieldOf(std::int64_t value) { return value; }
inline FieldValue fieldOf(int value) { return std::int64_t{value}; }
inline FieldValue fieldOf(std::size_t value) { return static_cast<std::int64_t>(value); }
inline FieldValue fieldOf(const char* value) { return FieldText(value); }
inline FieldValue fieldOf(const std::vector<float>& values) { return std::span(values); }
inline FieldValue fieldOf(const std::vector<std::uint8_t>& values) { return std::span(values); }

/// Reads a member of the model, or of the measured value.
template <typename Model, auto kMember>
FieldValue figure(const View& reading) {
    return fieldOf(std::invoke(kMember, reading.sensor.as<Model>()));
}
template <typename One, auto kMember>
FieldValue measured(const View& reading) {
    return fieldOf(std::invoke(kMember, reading.as<One>()));
}

template <typename Model>
FieldValue limitsOf(const View& reading) {
    const Model& model = reading.sensor.as<Model>();
    return std::vector<double>{model.min_range, model.max_range};
}

template <typename Model>
std::vector<std::uint64_t> sizeOf(const View& reading) {
    const Model& model = reading.sensor.as<Model>();
    return {static_cast<std::uint64_t>(model.rows), static_cast<std::uint64_t>(model.columns)};
}

template <typename Model>
std::vector<std::uint64_t> sizeTimesThree(const View& reading) {
    std::vector<std::uint64_t> shape = sizeOf<Model>(reading);
    shape.push_back(3);
    return shape;
}

/// Writes a field of JSON as a message of text, of kinds for which ROS has no message.
template <const char* kName>
std::string jsonText(const RosHeader& /*header*/, const View& reading) {
    return textMessage(jsonOfField(reading, kName));
}

}  // namespace ispace::fields
