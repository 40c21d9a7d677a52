// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server/mqtt: the payloads of states and the messages of Home Assistant's
// discovery.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/room_state.h"
#include "server/mqtt/mqtt_client.h"

namespace ispace {

/// Returns an id as a part of topics: the characters that these reserve are written as two
/// underscores and two hexadecimal digits. Distinct ids stay distinct.
std::string topicId(std::string_view id);

/// Converts a state to its payload: ON or OFF, per cent, R,G,B to 255, or the value itself.
std::string payloadOf(std::string_view key, std::string_view value);
/// Converts a payload to a value of the record language, which may be invalid.
std::string valueOfPayload(std::string_view key, std::string_view payload);

/// A sensor or actuator with all keys of its state.
struct MqttThing {
    std::string id, keyword;
    std::vector<std::string> keys;
};

/// Returns the message of Home Assistant's discovery for a thing, retained.
/// \param topic_of returns the topic of a key's state
MqttMessage discoveryOf(const MqttThing& thing, const std::string& prefix,
                        const std::vector<std::string>& topics);

}  // namespace ispace
