// SPDX-License-Identifier: GPL-3.0-or-later
// For tests and fuzzers of lib/extensions/mqtt: a broker in memory.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "extensions/mqtt/mqtt_client.h"

namespace ispace::testing {

struct MemoryBroker {
    std::vector<mqtt::MqttMessage> published, incoming;
    std::vector<std::string> subscriptions;
    int connections = 1;
    bool is_closed = false;

    /// The last payload of a topic; "" without.
    [[nodiscard]] std::string last(const std::string& topic) const {
        const auto found =
            std::find_if(published.rbegin(), published.rend(),
                         [&](const mqtt::MqttMessage& m) { return m.topic == topic; });
        return found == published.rend() ? "" : found->payload;
    }
};

/// The broker must outlive it.
class MemoryClient final : public mqtt::MqttClient {
  public:
    explicit MemoryClient(MemoryBroker& broker) : broker_(&broker) {}
    void publish(mqtt::MqttMessage message) override {
        const auto& topics = broker_->subscriptions;
        if (std::find(topics.begin(), topics.end(), message.topic) != topics.end())
            broker_->incoming.push_back({message.topic, message.payload, false});
        broker_->published.push_back(std::move(message));
    }
    void subscribe(const std::string& topic) override { broker_->subscriptions.push_back(topic); }
    void unsubscribe(const std::string& topic) override {
        std::erase(broker_->subscriptions, topic);
    }
    std::vector<mqtt::MqttMessage> take() override { return std::exchange(broker_->incoming, {}); }
    [[nodiscard]] int connections() const override { return broker_->connections; }
    void close() override { broker_->is_closed = true; }

  private:
    MemoryBroker* broker_;
};

}  // namespace ispace::testing
