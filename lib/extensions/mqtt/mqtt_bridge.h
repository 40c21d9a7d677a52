// SPDX-License-Identifier: GPL-3.0-or-later
// Carries states and commands between a run and a broker.
//
// Guarantees: the broker holds the newest state of each thing (retained, QoS 1), in the order of
// publication; after a reconnection all are published anew. Commands to things are carried out
// between steps, in the order of arrival, up to 1000 that wait; further ones are refused on
// PREFIX/error, and so are values of more than 256 bytes. Commands to robots do not wait.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/mqtt/mqtt_client.h"
#include "extensions/mqtt/mqtt_movers.h"
#include "extensions/mqtt/mqtt_survey.h"
#include "scene/room_state.h"
#include "server/bridge.h"
#include "server/server.h"
#include "server/session.h"

namespace ispace::mqtt {

/// Publishes the states of the room on a broker of MQTT, and carries out commands from there. Call
/// before Server::run(). \throws FormatError as connectMqtt()
void serveMqtt(Server& server, const MqttOptions& options);

/// Publishes the states of all worlds of the run, and carries out commands to its actuators: a
/// client of the protocol's role WORLD whose transport is a broker.
///
/// A state is the retained message PREFIX/ID/KEY: ON or OFF, a share in per cent, a colour as three
/// numbers up to 255, or the value as in events. A message to PREFIX/ID/KEY/set, in the same form,
/// is a command to an actuator; robots, people and cameras are those of MqttMovers; PREFIX/error
/// reports refused ones. The topics of Home Assistant's discovery describe all of them.
class MqttBridge final : public Bridge {
  public:
    /// \throws FormatError if another run serves the prefix
    MqttBridge(ServerState& state, std::unique_ptr<MqttClient> client, std::string prefix);

    /// Carries out commands that have arrived.
    void serve(bool has_made) override;
    /// Publishes the states that a step or a change of the world has changed.
    void stepped() override;
    [[nodiscard]] bool waitsToChange() const override { return session_.waitsToChange(); }
    [[nodiscard]] bool takesFrames() const override { return false; }
    /// Publishes that the run has ended, and disconnects.
    void end() override;
    [[nodiscard]] bool busy() override { return false; }
    void closeAll() override {}

  private:
    struct Topic {
        std::string id, key;
        bool is_actuator = false;
        const KeySpec* spec = nullptr;  ///< of an actuator
    };
    using Topics = std::map<std::string, Topic, std::less<>>;
    /// Topics of discovery, by id and keyword of their thing.
    using Descriptions = std::map<std::pair<std::string, std::string>, std::vector<std::string>>;
    [[nodiscard]] std::int64_t changesOfAll() const;
    void introduce(bool all);
    void publishAll();
    void publish(const RoomState& state);
    void receive(const MqttMessage& message);
    void refuse(const MqttMessage& message, const std::string& reason);
    void answer();
    void readLine(std::string_view line);
    [[nodiscard]] std::string topicOf(std::string_view id, std::string_view key) const;

    ServerState* state_;
    std::unique_ptr<MqttClient> client_;
    std::string prefix_;
    MqttSurvey survey_;
    MqttMovers movers_;
    Session session_;
    std::deque<std::string> requests_;
    Topics topics_;  // of all states
    Descriptions descriptions_;
    std::string names_;  // of the things when they were introduced
    int connections_ = 0;
    std::int64_t changes_ = -1;  // of the worlds when they were introduced
};

}  // namespace ispace::mqtt
