// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/mqtt/mqtt_options.h"

#include <optional>
#include <string>

#include "base/error.h"
#include "base/message.h"
#include "extensions/mqtt/mqtt_bridge.h"

namespace ispace::mqtt {

namespace {

class MqttGroup final : public BridgeGroup {
  public:
    void declare(CommandLine& line) override;
    void take(BridgeRules& rules) override;
    [[nodiscard]] std::size_t connections() const override { return 0; }
    void open(Server& server, Simulation& simulation, const BridgeRun& run) override;
    void announce(JsonWriter& /*json*/) const override {}

  private:
    std::optional<MqttOptions> broker_;
    std::string login_, prefix_;
};

void MqttGroup::declare(CommandLine& line) {
    line.group("MQTT");
    line.parsed(
        "--mqtt", "HOST:PORT", [this](const std::string& text) { broker_ = parseBroker(text); },
        "publish the states of sensors, lamps, doors and switches on a broker of MQTT, and carry "
        "out its commands (by custom port 1883)",
        Enters::Nothing);
    line.file("--mqtt-login", "FILE", login_, "log in there with the USER:PASSWORD in this file",
              Enters::Nothing);
    line.parsed(
        "--mqtt-prefix", "TOPIC", [this](const std::string& text) { prefix_ = text; },
        "begin the topics with this (default ispace)", Enters::Nothing);
    line.essential({"--mqtt"});
}

void MqttGroup::take(BridgeRules& rules) {
    for (const char* option : {"--mqtt-login", "--mqtt-prefix"})
        if (rules.line.given(option) && !broker_)
            throw UsageError(std::string(option) + " requires --mqtt HOST:PORT");
    if (!rules.line.given("--mqtt-prefix")) return;
    constexpr const char* kLetters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    if (prefix_.empty() || prefix_.find_first_not_of(kLetters) != std::string::npos)
        throw UsageError("--mqtt-prefix: " + excerpt(prefix_) +
                         " is no single level of a topic, wanted letters, digits, _ and -, like "
                         "ispace");
    broker_->prefix = prefix_;
}

void MqttGroup::open(Server& server, Simulation& /*simulation*/, const BridgeRun& /*run*/) {
    if (!broker_) return;
    MqttOptions options = *broker_;
    if (!login_.empty()) readLogin(login_, options);
    serveMqtt(server, options);
}

}  // namespace

std::unique_ptr<BridgeGroup> makeMqttOptions() { return std::make_unique<MqttGroup>(); }

}  // namespace ispace::mqtt
