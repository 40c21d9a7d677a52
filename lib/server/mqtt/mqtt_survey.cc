// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/mqtt/mqtt_survey.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "base/error.h"

namespace ispace {

namespace {

constexpr std::string_view kAsk = "ask ", kHere = "here ";
constexpr auto kPatience = std::chrono::seconds(1);
constexpr auto kPause = std::chrono::milliseconds(5);
constexpr const char* kDescriptions = "homeassistant/+/+/config";

/// Returns a name that no other run has.
std::string ownId() {
    std::random_device random;
    return std::to_string(random()) + '-' + std::to_string(random());
}

}  // namespace

MqttSurvey::MqttSurvey(MqttClient& client, const std::string& prefix)
    : client_(&client), prefix_(prefix), topic_(prefix + "/run"), id_(ownId()) {
    const std::string status = statusTopic(prefix);
    client.subscribe(topic_);
    client.subscribe(status);
    client.subscribe(kDescriptions);
    // The broker sends retained messages before this one.
    client.publish({topic_, std::string(kAsk) + id_, false});
    bool is_answered = false, is_online = false;
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end && (!is_answered || is_online)) {
        for (const MqttMessage& message : client.take()) {
            if (message.topic == status && message.retain) is_online = message.payload == "online";
            if (message.topic == topic_ && message.payload == std::string(kAsk) + id_)
                is_answered = true;
            if (message.topic == topic_ && message.payload.starts_with(kHere))
                throw FormatError({"", 0, 0,
                                   "another run serves the topics " + prefix +
                                       "/... of this broker: end it, or take another prefix "
                                       "(--mqtt-prefix)"});
            collect(message);
        }
        std::this_thread::sleep_for(kPause);
    }
    client.unsubscribe(status);
    client.unsubscribe(kDescriptions);
}

/// Keeps a description of this prefix, and the topics of states in it.
void MqttSurvey::collect(const MqttMessage& message) {
    if (!message.retain || !message.topic.starts_with("homeassistant/")) return;
    const nlohmann::json entity = nlohmann::json::parse(message.payload, nullptr, false);
    if (!entity.is_object()) return;
    const auto device = entity.find("device");
    if (device == entity.end() || !device->is_object() ||
        device->value("manufacturer", "") != "ispace" || device->value("name", "") != prefix_)
        return;
    leftovers_.insert(message.topic);
    for (const auto& [key, value] : entity.items())
        if (key.ends_with("state_topic") && value.is_string())
            if (const auto topic = value.get<std::string>(); topic.starts_with(prefix_ + '/'))
                leftovers_.insert(topic);
}

bool MqttSurvey::answer(const MqttMessage& message) {
    if (message.topic != topic_) return false;
    if (message.payload.starts_with(kAsk) && message.payload.substr(kAsk.size()) != id_)
        client_->publish({topic_, std::string(kHere) + id_, false});
    return true;
}

}  // namespace ispace
