// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "server/server.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// Addresses of the ports besides that of the protocol; "" without.
struct ServedAddresses {
    std::string web, foxglove, rosbridge;
    std::optional<int> ros_domain;  ///< of DDS
    DeviceAddresses devices;
};
/// Opens the ports that options ask for. \param title of the room or the record
/// \throws std::system_error, UsageError naming the option
ServedAddresses servePorts(Server& server, const SimrunOptions& options, const std::string& title);

/// Writes the first line of output: clients can connect now.
void announce(const Server& server, const ServedAddresses& addresses);

/// Returns writers of the room's map and mesh for clients of topics.
RosScenery rosScenery();

}  // namespace ispace
