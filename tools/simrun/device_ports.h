// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "net/server.h"
#include "wire/wire_session.h"

namespace ispace {

/// A robot or sensor behind the port of a real device, as an option asks for it.
struct DevicePortOption {
    const WireProtocol* protocol = nullptr;
    std::string id;
    Endpoint endpoint;
};

/// The options of device ports, one for each row of wireProtocols(), and who may use them.
class DevicePortOptions {
  public:
    void declare(CommandLine& line);
    /// Once the line is parsed. \throws UsageError
    void take(const CommandLine& line, ServerLimits& limits);
    [[nodiscard]] const std::vector<DevicePortOption>& ports() const { return ports_; }
    /// Connections they may take at once.
    [[nodiscard]] std::size_t connections() const;

  private:
    std::map<const WireProtocol*, std::vector<std::string>> texts_;
    std::vector<std::string> allowed_;
    std::string clock_ = "simulated";
    std::vector<DevicePortOption> ports_;
};

/// The addresses of device ports, by the id of their robot or sensor.
using DeviceAddresses = std::map<const WireProtocol*, std::map<std::string, std::string>>;
/// \throws UsageError naming the option, std::system_error
DeviceAddresses serveDevices(Server& server, const DevicePortOptions& options);

}  // namespace ispace
