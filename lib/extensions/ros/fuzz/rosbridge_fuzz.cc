// SPDX-License-Identifier: GPL-3.0-or-later
// The rosbridge protocol: whatever comes is answered by JSON objects and, where asked for, CBOR.
#include <nlohmann/json.hpp>

#include "extensions/ros/rosbridge_dialogue.h"
#include "topic_client.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const auto check = [](const std::string& message, bool is_text) {
        using nlohmann::json;
        const json answer =
            is_text ? json::parse(message, nullptr, false)
                    : json::from_cbor(message, true, false, json::cbor_tag_handler_t::ignore);
        require(answer.is_object() && answer.contains("op"), "bytes that are no answer");
    };
    talkAboutTopics<ros::RosbridgeDialogue>(bytes, check);
}
