// SPDX-License-Identifier: GPL-3.0-or-later
// States of actuators: values of records that change while the world runs, and the edits that
// change them.
//
// Values are text of the record language (metres, degrees), except that flags are 1 and 0.
// Functions here check names; a value is checked when its edit is applied. O(records).
//
//     const std::string_view open = "open=1";
//     const std::string request = stateChange(scene, "door1", {&open, 1});
//     const std::vector<Edit> edits = parseEdits(request);  // of "SET door1.open=yes"
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/record.h"
#include "scene/scene.h"

namespace ispace {

/// A key of a record whose value may change while the world runs: the state of an actuator.
struct StateKey {
    std::string_view keyword;
    std::string_view key;
};

/// Returns those of the core, the keys of a keyword one after another; extensions have others, see
/// ThingKind.
std::span<const StateKey> stateKeys();
/// Returns the keys of the states of records with this keyword, also those of its ThingKind.
std::vector<std::string> stateKeysOf(std::string_view keyword);
/// Returns true if records with this keyword have a state.
bool isActuator(std::string_view keyword);

/// A state of the room.
struct RoomState {
    std::string id, key;
    std::string value;  ///< text of the record language, but 1 and 0 for yes and no
    friend bool operator==(const RoomState&, const RoomState&) = default;
};

/// Returns the states of a scene, in the order of its records; keys without a value are left out.
/// Records with an emission have a `power` in watts behind their keys, which follows from these.
std::vector<RoomState> roomStates(const Scene& scene);

/// Returns the edit that sets a state: `id.key=value`, of `key=value` with 1 and 0 for yes and no,
/// too. \throws UsageError if the record `id` has no such state, with a hint; the value is checked
/// by the edit
std::string stateEdit(const Scene& scene, std::string_view id, std::string_view assignment);

/// Returns the request of parseEdits() that sets some states of a record at once:
/// `SET id.key=value`, or `ACT id key=value key=value`. \param assignments at least one
/// \throws UsageError as stateEdit(), and for a key that is set twice
std::string stateChange(const Scene& scene, std::string_view id,
                        std::span<const std::string_view> assignments);

}  // namespace ispace
