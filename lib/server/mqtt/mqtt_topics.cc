// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/mqtt/mqtt_topics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/json_writer.h"
#include "base/number.h"

namespace ispace {

namespace {

constexpr double kPerCent = 100, kFullColor = 255;

bool isShare(std::string_view key) { return key == "level"; }
bool isColor(std::string_view key) { return key == "color"; }

/// Multiplies each number of a list; "" if one is none.
std::string scaled(std::string_view list, double factor, bool is_whole) {
    std::string out;
    while (true) {
        const std::string_view part = list.substr(0, list.find(','));
        const auto number = parseDouble(part);
        if (!number) return "";
        const double value = *number * factor;
        out.append(out.empty() ? "" : ",");
        out += is_whole ? std::to_string(std::llround(value)) : formatDouble(value);
        if (part.size() == list.size()) return out;
        list.remove_prefix(part.size() + 1);
    }
}

/// A component of Home Assistant for the records of a keyword.
struct Component {
    std::string_view keyword, component, device_class;
};
constexpr Component kComponents[] = {{"lamp", "light", ""},
                                     {"projector", "light", ""},
                                     {"switch", "switch", ""},
                                     {"speaker", "switch", ""},
                                     {"door", "cover", "door"},
                                     {"window", "cover", "window"},
                                     {"pir", "binary_sensor", "motion"},
                                     {"contact", "binary_sensor", "door"}};

bool isPlain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
}

/// Writes characters outside of `allowed` as two underscores and two hexadecimal digits. So is an
/// underscore before such a character or before another underscore, which makes this reversible.
template <typename Allowed>
std::string escapedId(std::string_view id, Allowed allowed) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string out;
    for (std::size_t i = 0; i < id.size(); ++i) {
        const bool is_ambiguous =
            id[i] == '_' && i + 1 < id.size() && (id[i + 1] == '_' || !allowed(id[i + 1]));
        if (allowed(id[i]) && !is_ambiguous) {
            out += id[i];
            continue;
        }
        const auto byte = static_cast<unsigned char>(id[i]);
        out.append("__").append(1, kDigits[byte >> 4U]).append(1, kDigits[byte & 0xfU]);
    }
    return out;
}

}  // namespace

std::string topicId(std::string_view id) {
    return escapedId(id, [](char c) { return c != '+' && c != '#'; });
}

std::string payloadOf(std::string_view key, std::string_view value) {
    std::string scaled_value;
    if (isShare(key)) scaled_value = scaled(value, kPerCent, false);
    if (isColor(key)) scaled_value = scaled(value, kFullColor, true);
    if (!scaled_value.empty()) return scaled_value;
    if (value == "1") return "ON";
    if (value == "0") return "OFF";
    return std::string(value);
}

std::string valueOfPayload(std::string_view key, std::string_view payload) {
    if (isShare(key)) return std::string(payload) + '%';
    if (isColor(key)) return scaled(payload, 1 / kFullColor, false);
    std::string value(payload);
    for (char& c : value)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return value;
}

MqttMessage discoveryOf(const MqttThing& thing, const std::string& prefix,
                        const std::vector<std::string>& topics) {
    const auto* const found =
        std::find_if(std::begin(kComponents), std::end(kComponents),
                     [&](const Component& one) { return one.keyword == thing.keyword; });
    const Component component =
        found == std::end(kComponents) ? Component{thing.keyword, "sensor", ""} : *found;
    const bool is_commanded = isActuator(thing.keyword);
    const std::string plain = prefix + '_' + escapedId(thing.id, isPlain);
    JsonWriter json;
    json.beginObject().key("name").value(thing.id).key("unique_id").value(plain);
    if (!component.device_class.empty()) json.key("device_class").value(component.device_class);
    const auto add = [&](std::string_view name, const std::string& topic) {
        json.key(std::string(name) + "state_topic").value(topic);
        if (is_commanded) json.key(std::string(name) + "command_topic").value(topic + "/set");
    };
    bool has_main = false;  // of further keys Home Assistant knows the shares and colours alone
    for (std::size_t i = 0; i < thing.keys.size(); ++i)
        if (isShare(thing.keys[i]))
            add("brightness_", topics[i]);
        else if (isColor(thing.keys[i]))
            add("rgb_", topics[i]);
        else if (!std::exchange(has_main, true))
            add("", topics[i]);
    if (std::any_of(thing.keys.begin(), thing.keys.end(), isShare))
        json.key("brightness_scale").value(static_cast<std::int64_t>(kPerCent));
    if (component.component == "cover") {
        json.key("payload_open").value("ON").key("payload_close").value("OFF");
        json.key("state_open").value("ON").key("state_closed").value("OFF");
        json.key("payload_stop").null();
    }
    json.key("availability_topic").value(statusTopic(prefix));
    json.key("device").beginObject().key("identifiers").beginArray().value(prefix).endArray();
    json.key("name").value(prefix).key("manufacturer").value("ispace").endObject();
    json.endObject();
    return {.topic = "homeassistant/" + std::string(component.component) + '/' + plain + "/config",
            .payload = json.take(),
            .retain = true};
}

}  // namespace ispace
