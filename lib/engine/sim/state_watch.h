// SPDX-License-Identifier: GPL-3.0-or-later
// States of a world as words: doors, lamps, mats, motion detectors. See room_state.h.
//
//     StateWatch watch(world);
//     world.step();
//     for (const RoomState& state : watch.changed()) print(state.id, state.key, state.value);
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scene/room_state.h"

namespace ispace {

class World;

/// Returns the states that sensors report and those of the room's actuators, at the newest
/// readings: actuators first, then sensors in their order. Numbers have their shortest text, lists
/// commas, and an empty one is "-".
std::vector<RoomState> statesOf(const World& world);

/// Reports the states of a world that change, compared with those at its beginning. Reads only the
/// sensors of the last step; records only after a change of the world.
class StateWatch {
  public:
    /// The world must outlive it.
    explicit StateWatch(const World& world);
    /// Returns the states that differ from the last call, the actuators' first. Call it after each
    /// step. States of new records are returned, those of removed ones are not.
    std::vector<RoomState> changed();

  private:
    void learnActuators(std::vector<RoomState>* changed);
    void learnSensor(std::size_t sensor, std::vector<RoomState>* changed);
    void learn(RoomState state, std::vector<RoomState>* changed);

    const World* world_;
    std::int64_t changes_ = -1;                           // of the world when its records were read
    std::vector<std::size_t> reporting_;                  // sensors with states, ascending
    std::unordered_map<std::string, std::string> known_;  // value of ID.KEY
};

}  // namespace ispace
