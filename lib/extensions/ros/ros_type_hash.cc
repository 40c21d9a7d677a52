// SPDX-License-Identifier: GPL-3.0-or-later
// The hash is sha256 of the type's description as JSON in the form of Python's json.dumps, which
// rosidl uses; a blank more would be another type.
#include "extensions/ros/ros_type_hash.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include "record/text.h"

namespace ispace::ros {

namespace {

/// Numbers of type_description_interfaces/msg/FieldType.
constexpr std::array<std::pair<std::string_view, int>, 10> kTypeIds{{{"bool", 15},
                                                                     {"byte", 16},
                                                                     {"int8", 2},
                                                                     {"uint8", 3},
                                                                     {"int32", 6},
                                                                     {"uint32", 7},
                                                                     {"uint64", 9},
                                                                     {"float32", 10},
                                                                     {"float64", 11},
                                                                     {"string", 17}}};
constexpr int kNested = 1, kFixedArray = 48, kSequence = 144;

/// "geometry_msgs/Point" is "geometry_msgs/msg/Point" there.
std::string fullName(std::string_view name) {
    const std::size_t slash = name.find('/');
    const bool is_short = slash == name.rfind('/');
    return std::string(name.substr(0, slash)) + (is_short ? "/msg" : "") +
           std::string(name.substr(slash));
}

std::string inQuotes(std::string_view text) { return '"' + std::string(text) + '"'; }

std::string fieldText(std::string_view name, int type, std::size_t capacity,
                      const std::string& nested) {
    return "{\"name\": " + inQuotes(name) + ", \"type\": {\"type_id\": " + std::to_string(type) +
           ", \"capacity\": " + std::to_string(capacity) +
           ", \"string_capacity\": 0, \"nested_type_name\": " + inQuotes(nested) + "}}";
}

std::string fieldText(const RosField& field) {
    const std::string_view base = std::string_view(field.type).substr(0, field.type.find('['));
    const auto* const found = std::find_if(kTypeIds.begin(), kTypeIds.end(),
                                           [base](const auto& one) { return one.first == base; });
    int type = found == kTypeIds.end() ? kNested : found->second;
    if (field.is_array) type += field.length > 0 ? kFixedArray : kSequence;
    return fieldText(field.name, type, field.length,
                     field.fields != nullptr ? fullName(field.fields->name) : "");
}

/// Returns a struct's description as the JSON of Python.
std::string typeText(const RosStruct& type) {
    std::string out = "{\"type_name\": " + inQuotes(fullName(type.name)) + ", \"fields\": [";
    for (const RosField& field : type.fields)
        out += (&field == type.fields.data() ? "" : ", ") + fieldText(field);
    if (type.fields.empty()) {
        constexpr int kUint8 = 3;
        out += fieldText("structure_needs_at_least_one_member", kUint8, 0, "");
    }
    return out + "]}";
}

/// Adds the descriptions of all contained types by name.
void addContained(const RosStruct& type, std::map<std::string, std::string>& out) {
    for (const RosField& field : type.fields) {
        if (field.fields == nullptr) continue;
        out.emplace(fullName(field.fields->name), typeText(*field.fields));
        addContained(*field.fields, out);
    }
}

}  // namespace

std::string rosTypeHash(RosType type) {
    const RosStruct& fields = rosFields(type);
    std::map<std::string, std::string> contained;
    addContained(fields, contained);
    std::string text =
        "{\"type_description\": " + typeText(fields) + ", \"referenced_type_descriptions\": [";
    std::string_view separator;
    for (const auto& [name, description] : contained) {
        text.append(separator).append(description);
        separator = ", ";
    }
    const std::string digest = sha256(text + "]}");
    return "RIHS01_" + digest.substr(digest.find(':') + 1);
}

}  // namespace ispace::ros
