// SPDX-License-Identifier: GPL-3.0-or-later
// Converts messages between CDR and the texts of rosbridge, by their definitions.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "sense/formats/ros_types.h"

namespace ispace::ros {

/// Parses a client's JSON; empty if it is none, or nests deeper than 32 levels.
std::optional<nlohmann::json> parseClientJson(std::string_view text);

/// Converts a message to JSON as rosbridge writes it: bytes as base64, NaN and infinities as null.
/// \throws FormatError for a message of another type
std::string rosJson(RosType type, std::string_view message);
/// Converts a message to CBOR (RFC 8949): lists of floats as typed arrays (RFC 8746), bytes as byte
/// strings. \throws FormatError likewise
std::string rosCbor(RosType type, std::string_view message);

/// Appends a text, or the head of one of these, in CBOR.
void appendCborText(std::string& out, std::string_view text);
enum class CborHead : unsigned {
    Unsigned = 0,
    Negative = 1,
    Bytes = 2,
    Text = 3,
    List = 4,
    Map = 5,
    Tag = 6
};
void appendCborHead(std::string& out, CborHead head, std::uint64_t value);

/// Converts JSON to a message: absent fields have their defaults, null numbers are NaN, and times
/// may have the fields of ROS 1. \throws FormatError naming the field that does not fit
std::string rosMessage(RosType type, const nlohmann::json& value);

}  // namespace ispace::ros
