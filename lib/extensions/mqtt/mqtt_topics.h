// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/mqtt: the payloads of states and the messages of Home Assistant's
// discovery.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/mqtt/mqtt_client.h"
#include "scene/room_state.h"

namespace ispace::mqtt {

/// Returns an id as a part of topics: the characters that these reserve are written as two
/// underscores and two hexadecimal digits. Distinct ids stay distinct.
std::string topicId(std::string_view id);

/// Converts a state to its payload: ON or OFF, of an actuator per cent or R,G,B to 255, or the
/// value itself. \param spec of the key; null unless an actuator's record has it
std::string payloadOf(std::string_view key, std::string_view value, bool is_actuator,
                      const KeySpec* spec = nullptr);
/// Returns what a command has to be, in the words of its topic, if the payload is not that: "ON or
/// OFF", "0 to 100"; "" for a good one, and for a state whose values the records know alone.
/// \param spec of the key
std::string wantedPayload(std::string_view key, const KeySpec* spec, std::string_view payload);
/// Converts a payload to a value of the record language, which may be invalid.
std::string valueOfPayload(std::string_view key, std::string_view payload);

/// A key of a thing's state.
struct MqttKey {
    std::string name, topic;
    const KeySpec* spec = nullptr;  ///< of an actuator's record; null: a sensor reports it
};

/// A sensor or actuator with all keys of its state.
struct MqttEntity {
    std::string id, keyword;
    std::vector<MqttKey> keys;
};

/// Keywords of things that have no record of states: a robot, a person and the pictures of a
/// camera, beside what else of them has states.
inline constexpr const char *kRobotThing = "robot as vacuum", *kPersonThing = "person as tracker",
                            *kPictureThing = "camera as pictures";
/// Commands to a robot, of Home Assistant's vacuum cleaners.
inline constexpr std::string_view kStopRobot = "stop", kReturnRobot = "return_to_base";

/// Returns the messages of Home Assistant's discovery for a thing, retained: an entity of its
/// keyword, and one for each key that this entity does not hold, such as the `pan` of a projector:
/// of the component that the kind of the thing names (ThingKind::entities), else of the key's type.
std::vector<MqttMessage> discoveryOf(const MqttEntity& thing, const std::string& prefix);

}  // namespace ispace::mqtt
