// SPDX-License-Identifier: GPL-3.0-or-later
// The ports of a run: bridges of extensions, and the line that tells clients where to connect.
#pragma once

#include <string>
#include <vector>

#include "server/server.h"
#include "sim/simulation.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// Opens the bridges that options ask for, and adds the roles of extensions to the protocol.
/// \param title of the room or the record \param replayed folders of the records that are replayed
/// \throws std::system_error, UsageError naming the option
void servePorts(Server& server, Simulation& simulation, const SimrunOptions& options,
                const std::string& title, std::vector<std::string> replayed);

/// Writes the first line of output: clients can connect now.
void announce(const Server& server, const SimrunOptions& options);

/// Says after the run how much slow readers have lost, if any.
void reportLosses(const Server& server, const SimrunOptions& options);

}  // namespace ispace
