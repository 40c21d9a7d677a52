// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/wire_options.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "extensions/wire/device_bridge.h"
#include "extensions/wire/wire_session.h"

namespace ispace::wire {

namespace {

/// A robot or sensor that is served at the port of a real device.
struct DevicePortOption {
    const WireProtocol* protocol = nullptr;
    std::string id;
    Endpoint endpoint;
    std::string address = {};  ///< once it is open
};

std::string optionOf(const WireProtocol& protocol) { return "--" + std::string(protocol.name); }

/// Parses "l1=10940" or "l1=127.0.0.2:10940".
DevicePortOption parseDevicePort(const WireProtocol& protocol, const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw UsageError(excerpt(text) + ": wanted " + std::string(protocol.device) +
                         "=[ADDR:]PORT with its id, like " +
                         static_cast<char>(std::tolower(protocol.device.front())) +
                         "1=" + std::to_string(protocol.port));
    return {&protocol, text.substr(0, equals), parsePort(text.substr(equals + 1))};
}

/// An option for each row of wireProtocols(), and the rules of access to such ports.
class WireOptions final : public BridgeGroup {
  public:
    void declare(CommandLine& line) override;
    void take(BridgeRules& rules) override;
    [[nodiscard]] std::size_t connections() const override;
    void open(Server& server, Simulation& simulation, const BridgeRun& run) override;
    void announce(JsonWriter& json) const override;

  private:
    std::map<const WireProtocol*, std::vector<std::string>> texts_;
    std::string clock_ = "simulated";
    std::vector<DevicePortOption> ports_;
};

void WireOptions::declare(CommandLine& line) {
    line.group("Ports of devices");
    for (const WireProtocol* const protocol : wireProtocols())
        line.texts(optionOf(*protocol), std::string(protocol->device) + "=[ADDR:]PORT",
                   texts_[protocol], std::string(protocol->help), Enters::Nothing);
    line.choice("--device-clock", clock_, {"simulated", "wall"},
                "what time stamps of such ports count (default simulated)", Enters::Nothing);
}

void WireOptions::take(BridgeRules& rules) {
    for (const WireProtocol* const protocol : wireProtocols()) {
        for (const std::string& text : texts_[protocol]) {
            DevicePortOption port =
                ofOption(optionOf(*protocol), [&] { return parseDevicePort(*protocol, text); });
            const bool known = std::any_of(ports_.begin(), ports_.end(), [&](const auto& other) {
                return other.protocol == protocol && other.id == port.id;
            });
            if (known)
                throw UsageError(optionOf(*protocol) + ": " + excerpt(port.id) + " is given twice");
            if (!port.endpoint.is_loopback && rules.limits.allowed.empty())
                throw UsageError(optionOf(*protocol) + ": `" + port.endpoint.address +
                                 "`: programs for real devices know no token, so say with --allow "
                                 "which machines may connect, like --allow 192.168.1.0/24; or use "
                                 "127.0.0.1");
            ports_.push_back(std::move(port));
        }
    }
    rules.heeds_networks = rules.heeds_networks || !ports_.empty();
    if (ports_.empty() && rules.line.given("--device-clock"))
        throw UsageError("--device-clock is about ports of devices, and none is asked for");
    rules.limits.wall_clock = clock_ == "wall";
}

std::size_t WireOptions::connections() const {
    std::size_t count = 0;
    for (const DevicePortOption& port : ports_) count += port.protocol->clients + 1;
    return count;
}

void WireOptions::open(Server& server, Simulation& /*simulation*/, const BridgeRun& /*run*/) {
    if (ports_.empty()) return;
    DeviceBridge& devices = server.add(std::make_unique<DeviceBridge>(server.host()));
    for (DevicePortOption& port : ports_)
        port.address = ofOption(optionOf(*port.protocol), [&] {
            return devices.open(*port.protocol, port.id, port.endpoint);
        });
}

void WireOptions::announce(JsonWriter& json) const {
    for (const WireProtocol* const protocol : wireProtocols()) {
        std::map<std::string_view, std::string_view> addresses;
        for (const DevicePortOption& port : ports_)
            if (port.protocol == protocol) addresses.emplace(port.id, port.address);
        // The first two are always listed; later ones would surprise old readers.
        if (addresses.empty() && protocol->name != "p2os" && protocol->name != "scip") continue;
        json.key(std::string(protocol->name)).beginObject();
        for (const auto& [id, address] : addresses)
            json.key(std::string(id)).value(std::string(address));
        json.endObject();
    }
}

}  // namespace

std::unique_ptr<BridgeGroup> makeWireOptions() { return std::make_unique<WireOptions>(); }

}  // namespace ispace::wire
