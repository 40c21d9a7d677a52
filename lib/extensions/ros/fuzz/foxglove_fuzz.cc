// SPDX-License-Identifier: GPL-3.0-or-later
// The Foxglove WebSocket protocol: whatever comes is answered by JSON objects and whole binary
// messages.
#include <nlohmann/json.hpp>

#include "extensions/ros/foxglove_dialogue.h"
#include "topic_client.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const auto check = [](const std::string& message, bool is_text) {
        if (is_text) {
            const auto json = nlohmann::json::parse(message, nullptr, false);
            return require(json.is_object() && json.contains("op"), "a text that is no answer");
        }
        constexpr std::size_t kTime = 9;
        require(!message.empty() && message[0] >= 1 && message[0] <= 4, "an unknown opcode");
        require(message[0] != 2 || message.size() == kTime, "a time of another length");
    };
    talkAboutTopics<ros::FoxgloveDialogue>(bytes, check, std::string("room"), std::string("1"));
}
