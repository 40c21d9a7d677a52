// SPDX-License-Identifier: GPL-3.0-or-later
// Robots, people and cameras for home automation.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/mqtt/mqtt_client.h"
#include "extensions/mqtt/mqtt_topics.h"
#include "server/server_state.h"
#include "server/session.h"

namespace ispace::mqtt {

/// What home automation knows of robots, people and cameras, which have no states of the room:
/// PREFIX/ID/vacuum, the state and commands of a vacuum cleaner; PREFIX/ID/presence, home or
/// not_home; PREFIX/ID/image, a picture as PNG each kPictureEvery.
class MqttMovers {
  public:
    MqttMovers(ServerState& state, MqttClient& client, std::string prefix)
        : state_(&state), client_(&client), prefix_(std::move(prefix)) {}

    /// Returns a thing of each.
    [[nodiscard]] std::vector<MqttEntity> things() const;
    /// Publishes all anew.
    void publishAll();
    /// Its topic has been removed.
    void forget(const std::string& topic) { known_.erase(topic); }
    /// Call after each step: publishes changes.
    void stepped();
    /// Carries out a command to a robot. \returns the reason why it does not, or ""
    std::string command(const std::string& robot, const std::string& payload);
    /// Returns true for a topic of a robot's commands, without /set. \param robot its id
    [[nodiscard]] bool isRobot(std::string_view topic, std::string& robot) const;

    /// In simulated time.
    static constexpr SimTime kStateEvery = std::chrono::milliseconds(500),
                             kPictureEvery = std::chrono::seconds(10);

  private:
    [[nodiscard]] std::string topicOf(std::string_view id, std::string_view key) const;
    void publish(const std::string& topic, std::string payload);
    void publishStates();
    void takePictures(SimTime now);
    void followErrands();

    ServerState* state_;
    MqttClient* client_;
    std::string prefix_;
    std::map<std::string, std::string> known_;                 // states by topic
    std::map<std::string, std::unique_ptr<Session>> errands_;  // of robots that return
    /// Pictures under way, by topic.
    std::map<std::string, std::shared_ptr<const ServerState::PendingReply>> pictures_;
    SimTime next_{}, next_picture_{};
};

}  // namespace ispace::mqtt
