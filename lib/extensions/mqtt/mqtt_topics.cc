// SPDX-License-Identifier: GPL-3.0-or-later
// Payloads and descriptions. Source: Home Assistant, "MQTT Discovery"
// (homeassistant/COMPONENT/OBJECT/config, JSON). An id is escaped so that distinct ids are distinct
// topics.
#include "extensions/mqtt/mqtt_topics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/sensor/sensor.h"
#include "scene/thing_kind.h"
#include "sense/formats/reading_fields.h"
#include "server/role_answer.h"

namespace ispace::mqtt {

namespace {

constexpr double kPerCent = 100, kFullColor = 255;

bool isShare(std::string_view key) { return key == "level"; }
bool isColor(std::string_view key) { return key == "color"; }
/// Returns true for states that are on or off: any other 0 or 1 is a number.
bool isFlag(std::string_view key) {
    return key == "on" || key == "open" || key == "blind" || key == "motion" || key == "broken" ||
           key == "occupied" || key == "touched";
}

/// Rounds to significant digits.
double roundedTo(double value, int digits) {
    if (value == 0 || !std::isfinite(value)) return value;
    const double scale = std::pow(10, digits - std::ceil(std::log10(std::abs(value))));
    return std::round(value * scale) / scale;
}

/// Multiplies each number of a list; "" if one is none.
std::string scaled(std::string_view list, double factor, bool is_whole) {
    std::string out;
    while (true) {
        const std::string_view part = list.substr(0, list.find(','));
        const auto number = parseDouble(part);
        if (!number) return "";
        // A share of 0.55 is 55 per cent: the product of two doubles is 55.00000000000001.
        constexpr int kDigits = 12;
        const double value = roundedTo(*number * factor, kDigits);
        out.append(out.empty() ? "" : ",");
        out += is_whole ? std::to_string(std::llround(value)) : formatDouble(value);
        if (part.size() == list.size()) return out;
        list.remove_prefix(part.size() + 1);
    }
}

/// A component of Home Assistant for the records of a keyword, whose entity holds the first key.
struct Component {
    std::string_view keyword, component, device_class, unit;
    std::string_view state_class = {};  ///< of numbers; of those with a unit `measurement`
    std::string_view form = {};         ///< of the state in its payload, if that is not the state
};
constexpr Component kComponents[] = {
    {kRobotThing, "vacuum", "", ""},
    {kPersonThing, "device_tracker", "", ""},
    {kPictureThing, "camera", "", ""},
    {"mat", "binary_sensor", "occupancy", "", "", "{{ 'ON' if value | int > 0 else 'OFF' }}"},
    {"gate", "sensor", "", "", "total_increasing"},
    {"lamp", "light", "", ""},
    {"projector", "light", "", ""},
    {"switch", "switch", "", ""},
    {"speaker", "switch", "", ""},
    {"heater", "switch", "", ""},
    {"door", "cover", "door", ""},
    {"window", "cover", "window", ""},
    {"pir", "binary_sensor", "motion", ""},
    {"contact", "binary_sensor", "door", ""},
    {"lux", "sensor", "illuminance", "lx"},
    {"mote", "sensor", "illuminance", "lx"},
    {"microphone", "sensor", "sound_pressure", "dB"},
    {"thermometer", "sensor", "temperature", "°C"}};

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

std::string payloadOf(std::string_view key, std::string_view value, bool is_actuator,
                      const KeySpec* spec) {
    std::string scaled_value;
    if (is_actuator && isShare(key)) scaled_value = scaled(value, kPerCent, false);
    if (is_actuator && isColor(key)) scaled_value = scaled(value, kFullColor, true);
    if (!scaled_value.empty()) return scaled_value;
    const bool is_flag = isFlag(key) || (spec != nullptr && spec->type == KeyType::Flag);
    if (is_flag && value == "1") return "ON";
    if (is_flag && value == "0") return "OFF";
    return std::string(value);
}

std::string wantedPayload(std::string_view key, const KeySpec* spec, std::string_view payload) {
    if (isColor(key)) {
        const std::string color = scaled(payload, 1, false);
        std::size_t numbers = 0;
        bool is_good = !color.empty();
        for (std::string_view rest = color; is_good && !rest.empty(); ++numbers) {
            const std::size_t end = std::min(rest.find(','), rest.size());
            const double number = parseDouble(rest.substr(0, end)).value_or(-1);
            is_good = number >= 0 && number <= kFullColor;
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        constexpr std::size_t kColors = 3;
        return is_good && numbers == kColors ? "" : "three numbers R,G,B from 0 to 255";
    }
    if (spec == nullptr) return "";
    if (spec->type == KeyType::Flag) {
        const std::string word = valueOfPayload(key, payload);
        for (const char* known : {"on", "off", "true", "false", "yes", "no", "1", "0"})
            if (word == known) return "";
        return "ON or OFF";
    }
    if (spec->type == KeyType::Choice) {
        const auto& choices = spec->choices;
        const std::string word = valueOfPayload(key, payload);
        if (std::find(choices.begin(), choices.end(), word) != choices.end()) return "";
        return "one of " + joined(choices, ", ");
    }
    if (spec->type != KeyType::Number) return "";
    const double scale = isShare(key) ? kPerCent : 1;
    const std::optional<double> number = parseDouble(payload);
    if (number && *number >= scale * spec->lower && *number <= scale * spec->upper) return "";
    if (!std::isfinite(spec->lower) || !std::isfinite(spec->upper)) return number ? "" : "a number";
    return "a number from " + formatDouble(scale * spec->lower) + " to " +
           formatDouble(scale * spec->upper);
}

std::string valueOfPayload(std::string_view key, std::string_view payload) {
    if (isShare(key)) return std::string(payload) + '%';
    if (isColor(key)) return scaled(payload, 1 / kFullColor, false);
    std::string value(payload);
    for (char& c : value)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return value;
}

namespace {

/// Begins the description of an entity, with its states and commands.
class Entity {
  public:
    Entity(const std::string& name, const std::string& unique_id) : id_(unique_id) {
        json_.beginObject().key("name").value(name).key("unique_id").value(unique_id);
    }
    JsonWriter& json() { return json_; }
    void addTopics(std::string_view name, const MqttKey& key) {
        json_.key(std::string(name) + "state_topic").value(key.topic);
        if (key.spec != nullptr)
            json_.key(std::string(name) + "command_topic").value(key.topic + "/set");
    }
    MqttMessage message(std::string_view component, const std::string& prefix) {
        json_.key("availability_topic").value(statusTopic(prefix));
        json_.key("device").beginObject().key("identifiers").beginArray().value(prefix).endArray();
        json_.key("name").value(prefix).key("manufacturer").value("ispace").endObject();
        json_.key("origin").beginObject().key("name").value("ispace");
        json_.key("sw_version").value(version()).endObject();
        json_.endObject();
        return {.topic = "homeassistant/" + std::string(component) + '/' + id_ + "/config",
                .payload = json_.take(),
                .retain = true};
    }

  private:
    std::string id_;
    JsonWriter json_;
};

/// A unit that Home Assistant knows, of keys with that name which no command sets.
struct Measure {
    std::string_view key, device_class, unit, state_class;
};
constexpr Measure kMeasures[] = {{"power", "power", "W", "measurement"},
                                 {"energy", "energy", "kWh", "total_increasing"},
                                 {"in", "", "", "total_increasing"},
                                 {"out", "", "", "total_increasing"}};

/// Returns the state class of a sensor's field by the marks of its kind, which an extension added;
/// "" without one.
std::string_view stateClassOf(std::string_view keyword, std::string_view key) {
    const SensorKind* const kind = sensorKind(keyword);
    if (kind == nullptr || kind->reading == nullptr) return "";
    for (const ReadingField& field : kind->reading->fields) {
        if (field.name != key || (field.uses & kIsState) == 0) continue;
        if ((field.uses & kIsTotal) != 0) return "total_increasing";
        if ((field.uses & kIsLevel) != 0) return "measurement";
    }
    return "";
}

/// Returns the entity that a kind names for a state, or null.
const StateEntity* entityOf(std::string_view keyword, std::string_view key) {
    const ThingKind* const kind = thingKind(keyword);
    if (kind == nullptr) return nullptr;
    const auto found = std::find_if(kind->entities.begin(), kind->entities.end(),
                                    [key](const StateEntity& one) { return one.key == key; });
    return found == kind->entities.end() ? nullptr : &*found;
}

/// Describes a share of cloth that is drawn, 1 where it is shut, as a cover with a position.
MqttMessage describeCover(const StateEntity& named, Entity entity, const MqttKey& key,
                          const std::string& prefix) {
    const std::string command = key.topic + "/set";
    JsonWriter& json = entity.json();
    if (!named.device_class.empty()) json.key("device_class").value(named.device_class);
    json.key("command_topic").value(command).key("payload_open").value("0");
    json.key("payload_close").value("1").key("payload_stop").null();
    json.key("position_topic").value(key.topic);
    json.key("position_template").value("{{ (100 - 100 * (value | float)) | round }}");
    json.key("set_position_topic").value(command);
    json.key("set_position_template").value("{{ (100 - position) / 100 }}");
    return entity.message(named.component, prefix);
}

/// Describes a key as the entity that its kind names. Only covers, locks and switches take
/// commands.
MqttMessage describeAs(const StateEntity& named, Entity entity, MqttKey key,
                       const std::string& prefix) {
    if (named.component == "cover") return describeCover(named, std::move(entity), key, prefix);
    const bool is_lock = named.component == "lock";
    if (!is_lock && named.component != "switch") key.spec = nullptr;
    entity.addTopics("", key);
    if (!named.device_class.empty()) entity.json().key("device_class").value(named.device_class);
    if (is_lock) {
        entity.json().key("payload_lock").value("ON").key("payload_unlock").value("OFF");
        entity.json().key("state_locked").value("ON").key("state_unlocked").value("OFF");
    }
    return entity.message(named.component, prefix);
}

/// A robot goes as a vacuum cleaner does: it stops, and returns to where it began.
void addVacuum(Entity& entity, const MqttKey& key) {
    entity.json().key("command_topic").value(key.topic + "/set");
    entity.json().key("supported_features").beginArray();
    for (const char* feature : {"stop", "return_home"}) entity.json().value(feature);
    entity.json().endArray();
    entity.json().key("payload_stop").value(kStopRobot);
    entity.json().key("payload_return_to_base").value(kReturnRobot);
}

/// Describes a blind, which is on while it is down, as a cover.
MqttMessage describeBlind(Entity entity, const MqttKey& key, const std::string& prefix) {
    entity.addTopics("", key);
    JsonWriter& json = entity.json();
    json.key("device_class").value("blind");
    json.key("payload_open").value("OFF").key("payload_close").value("ON");
    json.key("state_open").value("OFF").key("state_closed").value("ON");
    json.key("payload_stop").null();
    return entity.message("cover", prefix);
}

/// Describes a key that the entity of its thing does not hold.
MqttMessage describeKey(Entity entity, std::string_view keyword, const MqttKey& key,
                        const std::string& prefix) {
    if (key.name == "blind" && key.spec != nullptr)
        return describeBlind(std::move(entity), key, prefix);
    entity.addTopics("", key);
    if (key.spec == nullptr) {
        for (const Measure& measure : kMeasures) {
            if (measure.key != key.name) continue;
            if (!measure.device_class.empty())
                entity.json().key("device_class").value(measure.device_class);
            if (!measure.unit.empty()) entity.json().key("unit_of_measurement").value(measure.unit);
            entity.json().key("state_class").value(measure.state_class);
        }
        if (const auto known = stateClassOf(keyword, key.name); !known.empty())
            entity.json().key("state_class").value(known);
        // On a mat are movers, by their ids.
        if (!isFlag(key.name) || key.name == "on") return entity.message("sensor", prefix);
        if (key.name == "broken" || key.name == "occupied")
            entity.json().key("device_class").value("occupancy");
        return entity.message("binary_sensor", prefix);
    }
    if (key.spec->type == KeyType::Flag) return entity.message("switch", prefix);
    if (key.spec->type == KeyType::Choice) {
        entity.json().key("options").beginArray();
        for (const std::string& choice : key.spec->choices) entity.json().value(choice);
        entity.json().endArray();
        return entity.message("select", prefix);
    }
    if (key.spec->type != KeyType::Number) return entity.message("text", prefix);
    const bool is_share = isShare(key.name);
    const double scale = is_share ? kPerCent : 1;
    entity.json().key("min").value(scale * key.spec->lower);
    entity.json().key("max").value(scale * key.spec->upper);
    constexpr double kStep = 0.1;
    entity.json().key("step").value(kStep);
    if (is_share) entity.json().key("unit_of_measurement").value("%");
    if (key.spec->unit == Unit::Angle) entity.json().key("unit_of_measurement").value("°");
    return entity.message("number", prefix);
}

}  // namespace

std::vector<MqttMessage> discoveryOf(const MqttEntity& thing, const std::string& prefix) {
    const auto* const found =
        std::find_if(std::begin(kComponents), std::end(kComponents),
                     [&](const Component& one) { return one.keyword == thing.keyword; });
    const bool is_commanded = isActuator(thing.keyword);
    const std::string plain = prefix + '_' + escapedId(thing.id, isPlain);
    std::vector<MqttMessage> messages;
    std::size_t held = 0;  // keys that the entity of the thing holds, the first ones
    if (found != std::end(kComponents) || !is_commanded) {
        const Component component =
            found == std::end(kComponents) ? Component{thing.keyword, "sensor", "", ""} : *found;
        Entity entity(thing.id, plain);
        if (!component.device_class.empty())
            entity.json().key("device_class").value(component.device_class);
        // Home Assistant keeps statistics of numbers that say so.
        std::string_view state_class = component.state_class;
        if (!component.unit.empty()) {
            entity.json().key("unit_of_measurement").value(component.unit);
            state_class = "measurement";
        }
        if (state_class.empty()) state_class = stateClassOf(thing.keyword, thing.keys[0].name);
        if (!state_class.empty()) entity.json().key("state_class").value(state_class);
        if (!component.form.empty()) entity.json().key("value_template").value(component.form);
        if (component.component == "camera")
            entity.json().key("topic").value(thing.keys[held++].topic);
        else
            entity.addTopics("", thing.keys[held++]);
        if (component.component == "vacuum") addVacuum(entity, thing.keys.front());
        for (; component.component == "light" && held < thing.keys.size(); ++held) {
            const MqttKey& key = thing.keys[held];
            if (isShare(key.name)) {
                entity.addTopics("brightness_", key);
                entity.json().key("brightness_scale").value(static_cast<std::int64_t>(kPerCent));
            } else if (isColor(key.name)) {
                entity.addTopics("rgb_", key);
            } else {
                break;
            }
        }
        if (component.component == "cover") {
            entity.json().key("payload_open").value("ON").key("payload_close").value("OFF");
            entity.json().key("state_open").value("ON").key("state_closed").value("OFF");
            entity.json().key("payload_stop").null();
        }
        messages.push_back(entity.message(component.component, prefix));
    }
    // No escaped id has three underscores.
    for (; held < thing.keys.size(); ++held) {
        const MqttKey& key = thing.keys[held];
        Entity entity(thing.id + ' ' + key.name, plain + "___" + key.name);
        const StateEntity* const named = entityOf(thing.keyword, key.name);
        messages.push_back(named == nullptr
                               ? describeKey(std::move(entity), thing.keyword, key, prefix)
                               : describeAs(*named, std::move(entity), key, prefix));
    }
    return messages;
}

}  // namespace ispace::mqtt
