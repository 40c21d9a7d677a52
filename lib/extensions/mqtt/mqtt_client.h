// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/mqtt: the states of a running world on a broker of MQTT, and commands to its
// actuators from there.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ispace::mqtt {

/// A message of MQTT.
struct MqttMessage {
    std::string topic, payload;
    bool retain = false;  ///< the broker keeps it for later subscribers
    friend bool operator==(const MqttMessage&, const MqttMessage&) = default;
};

/// A connection to a broker.
class MqttClient {
  public:
    virtual ~MqttClient() = default;
    /// Sends a message once those before it have arrived, after a reconnection if need be.
    virtual void publish(MqttMessage message) = 0;
    /// Subscribes to a topic, at each reconnection anew.
    virtual void subscribe(const std::string& topic) = 0;
    virtual void unsubscribe(const std::string& topic) = 0;
    /// Returns and clears the messages that have arrived, in order: 10 000 at most, of 2 kB each.
    virtual std::vector<MqttMessage> take() = 0;
    /// Returns the number of connections so far: the broker may have lost its messages since.
    [[nodiscard]] virtual int connections() const = 0;
    /// Waits half a second at most until all messages have arrived, and disconnects.
    virtual void close() = 0;
};

struct MqttOptions {
    std::string host = "127.0.0.1";
    std::uint16_t port = 1883;
    std::string user, password;     ///< "": none
    std::string prefix = "ispace";  ///< of topics
};

/// Parses HOST:PORT. \throws UsageError
MqttOptions parseBroker(const std::string& text);
/// Reads `USER:PASSWORD`, the first line of a file. \throws UsageError if it holds no colon
void readLogin(const std::string& file, MqttOptions& options);

/// Returns the topic of a run's availability: online, and offline at its end or after its death.
std::string statusTopic(const std::string& prefix);

/// Connects to a broker by libmosquitto, which is loaded now. The client reconnects by itself.
/// \param wake is called in another thread when messages or a connection have arrived
/// \throws FormatError if the library is missing, or the broker cannot be reached or refuses
std::unique_ptr<MqttClient> connectMqtt(const MqttOptions& options, std::function<void()> wake);

}  // namespace ispace::mqtt
