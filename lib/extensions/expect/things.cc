// SPDX-License-Identifier: GPL-3.0-or-later
// States are read from the records at the start and after changes, and from events in between.
// Energy is power times the time of a step, by the power before it. A state that the thing is never
// told counts as 0, and is reported as untold, since a slip in its name would otherwise pass.
#include "extensions/expect/things.h"

#include <algorithm>
#include <utility>

#include "base/number.h"
#include "scene/thing_kind.h"
#include "sim/state_watch.h"

namespace ispace::expect {

namespace {

constexpr std::string_view kWatts = "watts", kEnergy = "kwh", kPower = "power";

std::string stateName(std::string_view name, std::string_view key) {
    std::string text(name);
    return text.append(".").append(key);
}

std::string prefixOf(const JudgedWorld& world) { return world.id.empty() ? "" : world.id + '/'; }

std::optional<Point2> placeOf(const World& world, std::size_t record) {
    const Scene& scene = world.scene();
    if (const auto sensor = world.sensorNamed(scene.ids[record])) {
        const Point3 p = world.sensors()[*sensor].pose.position;
        return Point2{p.x, p.y};
    }
    const Record& placed = scene.records[record];
    const Value* const at = placed.schema().find("at") == nullptr ? nullptr : placed.find("at");
    const Tuple* const tuple = at == nullptr ? nullptr : std::get_if<Tuple>(at);
    if (tuple == nullptr || tuple->size() < 2) return std::nullopt;
    return Point2{(*tuple)[0], (*tuple)[1]};
}

/// Returns the power of a record in watts; empty if it has none.
std::optional<double> recordPower(const Record& record) {
    const Schema& schema = record.schema();
    if (schema.find(kWatts) == nullptr || schema.find("on") == nullptr) return std::nullopt;
    if (!record.flag("on")) return 0;
    return record.number(kWatts) * (schema.find("level") == nullptr ? 1 : record.number("level"));
}

}  // namespace

ThingStates::ThingStates(std::span<const JudgedWorld> worlds)
    : worlds_(worlds.begin(), worlds.end()),
      changes_(worlds.size()),
      next_(worlds.size()),
      time_(worlds.front().world->time()) {
    for (std::size_t room = 0; room < worlds_.size(); ++room) {
        const JudgedWorld& judged = worlds_[room];
        const Scene& scene = judged.world->scene();
        for (std::size_t i = 0; i < scene.records.size(); ++i)
            things_.push_back({.name = prefixOf(judged) + scene.ids[i],
                               .keyword = scene.records[i].keyword(),
                               .room = room,
                               .at = placeOf(*judged.world, i)});
        if (judged.events == nullptr) continue;
        judged.events->want({EventKind::State});
        next_[room] = judged.events->next();
    }
    for (std::size_t room = 0; room < worlds_.size(); ++room) read(room, true);
    for (Thing& thing : things_) {
        const std::string prefix = thing.name + '.';
        for (auto it = states_.lower_bound(prefix);
             it != states_.end() && it->first.starts_with(prefix); ++it)
            thing.keys.push_back(it->first.substr(prefix.size()));
    }
}

void ThingStates::set(std::size_t room, const std::string& name, std::string_view key,
                      std::string text) {
    ThingState& state = states_[stateName(name, key)];
    state.is_there = true;
    state.is_told = true;
    if (key == kPower)
        if (const auto watts = parseDouble(text)) {
            powers_[name].room = room;
            powers_[name].watts = *watts;
        }
    if (state.text == text) return;
    const auto number = parseDouble(text);
    state.number = number.value_or(std::numeric_limits<double>::quiet_NaN());
    state.is_on = !text.empty() && text != "-" && number != 0.0;
    state.text = std::move(text);
}

/// Reads all states of a world, after a change of its records.
void ThingStates::read(std::size_t room, bool is_first) {
    const JudgedWorld& judged = worlds_[room];
    const std::string prefix = prefixOf(judged);
    const Scene& scene = judged.world->scene();
    changes_[room] = judged.world->changes();
    if (!is_first)
        for (const Thing& thing : things_)
            if (thing.room == room)
                for (const std::string& key : thing.keys)
                    states_.find(stateName(thing.name, key))->second.is_there = false;
    for (auto& [name, power] : powers_)
        if (power.room == room) power.watts = 0;
    for (RoomState& state : statesOf(*judged.world))
        set(room, prefix + state.id, state.key, std::move(state.value));
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        if (const ThingKind* const kind = thingKind(scene.records[i].keyword()))
            for (const std::string& key : kind->told) {
                const auto known = states_.find(stateName(prefix + scene.ids[i], key));
                set(room, prefix + scene.ids[i], key,
                    known == states_.end() ? "0" : std::string(known->second.text));
            }
        if (const auto watts = recordPower(scene.records[i])) {
            Power& power = powers_[prefix + scene.ids[i]];
            power.room = room;
            power.watts = *watts;
        }
    }
    for (const auto& [name, power] : powers_) {
        if (power.room != room) continue;
        set(room, name, kWatts, formatDouble(power.watts));
        ThingState& energy = states_[stateName(name, kEnergy)];
        energy.is_there = true;
    }
}

void ThingStates::observe() {
    const SimTime now = worlds_.front().world->time();
    const double passed = seconds(now - std::exchange(time_, now));
    for (auto& [name, power] : powers_) {
        if (power.watts == 0 || passed <= 0) continue;
        constexpr double kJoules = 3.6e6;  // in a kilowatt-hour
        power.joules += power.watts * passed;
        ThingState& energy = states_[stateName(name, kEnergy)];
        energy.number = power.joules / kJoules;
        energy.text = formatDouble(roundSignificant(energy.number, 6));
        energy.is_on = true;
    }
    for (std::size_t room = 0; room < worlds_.size(); ++room) {
        const JudgedWorld& judged = worlds_[room];
        if (judged.world->changes() != changes_[room] || judged.events == nullptr)
            read(room, false);
        if (judged.events == nullptr) continue;
        const std::string prefix = prefixOf(judged);
        const EventLog& events = *judged.events;
        for (next_[room] = std::max(next_[room], events.first()); next_[room] < events.next();
             ++next_[room]) {
            const Event& event = events.at(next_[room]);
            if (event.kind == EventKind::State)
                set(room, prefix + event.id, event.other, event.text);
        }
    }
}

const ThingState* ThingStates::find(const Thing& thing, std::string_view key) {
    const std::string name = stateName(thing.name, key);
    if (const auto found = states_.find(name); found != states_.end()) return &found->second;
    if (!thing.keys.empty()) return nullptr;
    ThingState& state = states_[name];
    state.is_told = false;
    return &state;
}

std::vector<std::string> ThingStates::untold() const {
    std::vector<std::string> names;
    for (const auto& [name, state] : states_)
        if (!state.is_told) names.push_back(name);
    return names;
}

}  // namespace ispace::expect
