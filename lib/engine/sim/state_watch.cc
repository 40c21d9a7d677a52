// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/state_watch.h"

#include <algorithm>
#include <utility>

#include "base/number.h"
#include "sense/formats/reading_fields.h"
#include "sim/world.h"

namespace ispace {

namespace {

/// Writes a field that is a state; "" for types that none has.
struct StateText {
    std::string operator()(bool value) const { return value ? "1" : "0"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return formatDouble(value); }
    std::string operator()(const FieldText& value) const { return value.value_or("-"); }
    std::string operator()(const std::vector<std::string>& values) const {
        std::string text;
        for (const std::string& value : values) text.append(text.empty() ? "" : ",").append(value);
        return text.empty() ? "-" : text;
    }
    template <typename Value>
    std::string operator()(const Value& /*value*/) const {
        return "";
    }
};

std::string nameOf(const RoomState& state) { return state.id + '.' + state.key; }

bool isState(const ReadingField& field) { return (field.uses & kIsState) != 0; }

bool reports(const Sensor& sensor) {
    const auto fields = readingKind(sensor.model).fields;
    return std::any_of(fields.begin(), fields.end(), isState);
}

template <typename Take>
void forEachState(const World& world, std::size_t index, Take take) {
    const Sensor& sensor = world.sensors()[index];
    const ReadingView view = viewOf(sensor, world.reading(index));
    for (const ReadingField& field : readingKind(sensor.model).fields)
        if (isState(field))
            take(RoomState{sensor.id, std::string(field.name),
                           std::visit(StateText(), field.value(view))});
}

}  // namespace

std::vector<RoomState> statesOf(const World& world) {
    std::vector<RoomState> states = roomStates(world.scene());
    for (std::size_t i = 0; i < world.sensors().size(); ++i)
        if (reports(world.sensors()[i]))
            forEachState(world, i, [&](RoomState state) { states.push_back(std::move(state)); });
    return states;
}

StateWatch::StateWatch(const World& world) : world_(&world) {
    learnActuators(nullptr);
    for (const std::size_t sensor : reporting_) learnSensor(sensor, nullptr);
}

std::vector<RoomState> StateWatch::changed() {
    std::vector<RoomState> changed;
    if (changes_ != world_->changes()) learnActuators(&changed);
    if (reporting_.empty()) return changed;
    const std::span<const std::size_t> read = world_->latestReadings();
    for (const std::size_t sensor : reporting_)
        if (std::binary_search(read.begin(), read.end(), sensor)) learnSensor(sensor, &changed);
    return changed;
}

/// Reads the records, of which a change may have made others.
void StateWatch::learnActuators(std::vector<RoomState>* changed) {
    changes_ = world_->changes();
    // A thing that is gone is forgotten: if it comes again, its state is new.
    auto before = std::exchange(known_, {});
    const auto keep = [&](const RoomState& state) { known_.insert(before.extract(nameOf(state))); };
    for (RoomState& state : roomStates(world_->scene())) {
        keep(state);
        learn(std::move(state), changed);
    }
    reporting_.clear();
    for (std::size_t i = 0; i < world_->sensors().size(); ++i) {
        if (!reports(world_->sensors()[i])) continue;
        reporting_.push_back(i);
        forEachState(*world_, i, keep);
    }
}

void StateWatch::learnSensor(std::size_t sensor, std::vector<RoomState>* changed) {
    forEachState(*world_, sensor, [&](RoomState state) { learn(std::move(state), changed); });
}

void StateWatch::learn(RoomState state, std::vector<RoomState>* changed) {
    std::string& known = known_[nameOf(state)];
    if (known == state.value) return;
    known = state.value;
    if (changed != nullptr) changed->push_back(std::move(state));
}

}  // namespace ispace
