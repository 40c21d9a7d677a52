// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/device_ports.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/message.h"
#include "cli/common_options.h"

namespace ispace {

namespace {

std::string optionOf(const WireProtocol& protocol) { return "--" + std::string(protocol.name); }

/// Reads "l1=10940" or "l1=127.0.0.2:10940".
DevicePortOption parsePort(const WireProtocol& protocol, const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw UsageError(excerpt(text) + ": wanted " + std::string(protocol.device) +
                         "=[ADDR:]PORT with its id, like " +
                         static_cast<char>(std::tolower(protocol.device.front())) +
                         "1=" + std::to_string(protocol.port));
    const std::string where = text.substr(equals + 1);
    const bool is_port = where.find(':') == std::string::npos;
    return {&protocol, text.substr(0, equals),
            parseEndpoint(is_port ? "127.0.0.1:" + where : where)};
}

}  // namespace

void DevicePortOptions::declare(CommandLine& line) {
    for (const WireProtocol* const protocol : wireProtocols())
        line.texts(optionOf(*protocol), std::string(protocol->device) + "=[ADDR:]PORT",
                   texts_[protocol], std::string(protocol->help), Enters::Nothing);
    if (texts_.empty()) return;
    line.texts("--allow", "CIDR", allowed_,
               "machines that may use such ports besides this one, e.g. 192.168.1.0/24",
               Enters::Nothing);
    line.choice("--device-clock", clock_, {"simulated", "wall"},
                "what time stamps of such ports count (default simulated)", Enters::Nothing);
}

void DevicePortOptions::take(const CommandLine& line, ServerLimits& limits) {
    for (const WireProtocol* const protocol : wireProtocols()) {
        for (const std::string& text : texts_[protocol]) {
            DevicePortOption port =
                ofOption(optionOf(*protocol), [&] { return parsePort(*protocol, text); });
            const bool known = std::any_of(ports_.begin(), ports_.end(), [&](const auto& other) {
                return other.protocol == protocol && other.id == port.id;
            });
            if (known)
                throw UsageError(optionOf(*protocol) + ": " + excerpt(port.id) + " is given twice");
            if (!port.endpoint.is_loopback && allowed_.empty())
                throw UsageError(optionOf(*protocol) + ": `" + port.endpoint.address +
                                 "`: programs for real devices know no token, so say with --allow "
                                 "which machines may connect, like --allow 192.168.1.0/24; or use "
                                 "127.0.0.1");
            ports_.push_back(std::move(port));
        }
    }
    for (const char* option : {"--allow", "--device-clock"})
        if (ports_.empty() && !texts_.empty() && line.given(option))
            throw UsageError(std::string(option) +
                             " is about ports of devices, and none is asked for");
    for (const std::string& text : allowed_)
        limits.allowed.push_back(ofOption("--allow", [&text] { return parseNetwork(text); }));
    limits.wall_clock = clock_ == "wall";
}

std::size_t DevicePortOptions::connections() const {
    std::size_t count = 0;
    for (const DevicePortOption& port : ports_) count += port.protocol->clients + 1;
    return count;
}

DeviceAddresses serveDevices(Server& server, const DevicePortOptions& options) {
    DeviceAddresses out;
    for (const auto& [protocol, id, endpoint] : options.ports())
        out[protocol][id] =
            ofOption(optionOf(*protocol), [&, where = &endpoint, which = protocol, whose = &id] {
                return server.serveDevice(*which, *whose, *where);
            });
    return out;
}

}  // namespace ispace
