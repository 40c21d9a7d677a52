// SPDX-License-Identifier: GPL-3.0-or-later
// Two runs under one prefix would fight over retained messages. A run asks before it publishes; one
// that lives answers at once. A status "online" without an answer within a second is that of a run
// that died.
#include "extensions/mqtt/mqtt_survey.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <utility>

#include "base/error.h"

namespace ispace::mqtt {

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
    // A run that is marked offline by the end of another one still answers at once.
    constexpr auto kGrace = std::chrono::milliseconds(100);
    bool is_answered = false, is_online = false, has_grace = false;
    auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
        for (const MqttMessage& message : client.take()) {
            if (message.topic == status && message.retain) is_online = message.payload == "online";
            if (message.topic == topic_ && message.payload == std::string(kAsk) + id_)
                is_answered = true;
            // Of two that start at once, the one with the smaller id goes on.
            const bool is_rival = message.topic == topic_ && message.payload.starts_with(kAsk) &&
                                  message.payload.substr(kAsk.size()) < id_;
            if (message.topic == topic_ && !is_rival) answer(message);
            if (is_rival || (message.topic == topic_ && message.payload.starts_with(kHere) &&
                             message.payload.substr(kHere.size()) != id_))
                throw FormatError({"", 0, 0,
                                   "another run serves the topics " + prefix +
                                       "/... of this broker: end it, or take another prefix "
                                       "(--mqtt-prefix)"});
            collect(message);
        }
        if (is_answered && !is_online && !std::exchange(has_grace, true))
            end = std::min(end, std::chrono::steady_clock::now() + kGrace);
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
    if (device == entity.end() || !device->is_object()) return;
    // Others' descriptions may hold anything.
    const auto is = [&device](const char* key, const std::string& wanted) {
        const auto found = device->find(key);
        return found != device->end() && found->is_string() && found->get<std::string>() == wanted;
    };
    if (!is("manufacturer", "ispace") || !is("name", prefix_)) return;
    leftovers_.insert(message.topic);
    for (const auto& [key, value] : entity.items())
        if ((key.ends_with("state_topic") || key == "topic") && value.is_string())
            if (const auto topic = value.get<std::string>(); topic.starts_with(prefix_ + '/'))
                leftovers_.insert(topic);
}

bool MqttSurvey::answer(const MqttMessage& message) {
    if (message.topic != topic_) return false;
    if (message.payload.starts_with(kAsk) && message.payload.substr(kAsk.size()) != id_)
        client_->publish({topic_, std::string(kHere) + id_, false});
    return true;
}

}  // namespace ispace::mqtt
