// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cli/operands.h"
#include "net/server.h"
#include "simrun/options.h"

namespace ispace {

/// Limits of the server, with what clients need to know and may read. Raises the number of files
/// that this process may open, as every client takes one.
ServerLimits limitsOf(const SimrunOptions& options, const SceneInput& input);

/// The first line of output: clients can connect now.
/// \param web address of the page; "" without
/// \param devices where device ports are
void announce(const Server& server, const std::string& web, const DeviceAddresses& devices);

}  // namespace ispace
