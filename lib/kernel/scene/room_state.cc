// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/room_state.h"

#include <algorithm>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/thing_kind.h"

namespace ispace {

namespace {

constexpr StateKey kStateKeys[] = {
    {"door", "open"},       {"window", "open"},    {"window", "blind"},   {"lamp", "on"},
    {"lamp", "level"},      {"lamp", "color"},     {"projector", "on"},   {"projector", "level"},
    {"projector", "color"}, {"projector", "pan"},  {"projector", "tilt"}, {"switch", "on"},
    {"speaker", "on"},      {"speaker", "volume"}, {"heater", "on"},      {"heater", "level"},
    {"weather", "celsius"}, {"weather", "sun"}};

std::string valueText(const Record& record, std::string_view key) {
    const KeySpec& spec = *record.schema().find(key);
    if (spec.type == KeyType::Flag && record.find(key) == nullptr) return "0";
    if (spec.type == KeyType::Flag) return record.flag(key) ? "1" : "0";
    if (spec.type == KeyType::Number) return formatDouble(record.number(key));
    if (spec.type == KeyType::Choice || spec.type == KeyType::Word) return record.text(key);
    std::string text;
    for (const double part : record.tuple(key))
        text.append(text.empty() ? "" : ",").append(formatDouble(part));
    return text;
}

/// Returns false for a key without value and default; flags without them are off.
bool hasValue(const Record& record, std::string_view key) {
    return record.find(key) != nullptr || record.schema().find(key)->type == KeyType::Flag;
}

}  // namespace

std::span<const StateKey> stateKeys() { return kStateKeys; }

std::vector<std::string> stateKeysOf(std::string_view keyword) {
    std::vector<std::string> keys;
    for (const StateKey& state : kStateKeys)
        if (state.keyword == keyword) keys.emplace_back(state.key);
    if (const ThingKind* const kind = thingKind(keyword))
        keys.insert(keys.end(), kind->states.begin(), kind->states.end());
    return keys;
}

bool isActuator(std::string_view keyword) {
    const ThingKind* const kind = thingKind(keyword);
    return (kind != nullptr && !kind->states.empty()) ||
           std::any_of(std::begin(kStateKeys), std::end(kStateKeys),
                       [&](const StateKey& state) { return state.keyword == keyword; });
}

std::vector<RoomState> roomStates(const Scene& scene) {
    std::vector<RoomState> states;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        const std::string& id = scene.ids[i];
        for (const StateKey& state : kStateKeys)
            if (record.keyword() == state.keyword)
                states.push_back({id, std::string(state.key), valueText(record, state.key)});
        const ThingKind* const kind = thingKind(record.keyword());
        if (kind != nullptr && (kind->has_states == nullptr || kind->has_states(record)))
            for (const std::string& key : kind->states)
                if (hasValue(record, key)) states.push_back({id, key, valueText(record, key)});
        if (const auto emission = emissionOf(record))
            states.push_back({id, "power", formatDouble(emission->watts)});
    }
    return states;
}

std::string stateEdit(const Scene& scene, std::string_view id, std::string_view assignment) {
    const auto found = std::find(scene.ids.begin(), scene.ids.end(), id);
    std::vector<std::string> actuators;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (isActuator(scene.records[i].keyword())) actuators.push_back(scene.ids[i]);
    if (found == scene.ids.end())
        throw UsageError("no record has the id " + excerpt(id) + didYouMean(id, actuators));
    const Record& record = scene.records[static_cast<std::size_t>(found - scene.ids.begin())];
    const std::vector<std::string> keys = stateKeysOf(record.keyword());
    if (keys.empty())
        throw UsageError(std::string(id) + " is a " + record.keyword() + ", which has no state");
    const std::size_t equals = assignment.find('=');
    const std::string_view key = assignment.substr(0, equals);
    const bool is_known = std::find(keys.begin(), keys.end(), key) != keys.end();
    if (equals == std::string_view::npos || !is_known)
        throw UsageError("wanted a state of " + std::string(id) + " as " + keys.front() +
                         "=value, found " + excerpt(assignment) +
                         (is_known ? "" : didYouMean(key, keys)));
    std::string value(assignment.substr(equals + 1));
    if (record.schema().find(key)->type == KeyType::Flag && (value == "1" || value == "0"))
        value = value == "1" ? "yes" : "no";
    return std::string(id) + '.' + std::string(key) + '=' + value;
}

std::string stateChange(const Scene& scene, std::string_view id,
                        std::span<const std::string_view> assignments) {
    if (assignments.size() == 1) return "SET " + stateEdit(scene, id, assignments.front());
    std::string change = "ACT " + std::string(id);
    std::vector<std::string> keys;
    for (const std::string_view assignment : assignments) {
        const std::string state = stateEdit(scene, id, assignment).substr(id.size() + 1);
        std::string key = state.substr(0, state.find('='));
        if (std::find(keys.begin(), keys.end(), key) != keys.end())
            throw UsageError("`" + key + "` of " + std::string(id) + " is set twice");
        keys.push_back(std::move(key));
        change.append(" ").append(state);
    }
    return change;
}

}  // namespace ispace
