// SPDX-License-Identifier: GPL-3.0-or-later
// The access rule of DDS: a filter of the kernel in front of Cyclone's sockets.
#pragma once

#include <span>

#include "server/network.h"

namespace ispace::ros {

/// Makes the kernel drop the packets that reach UDP sockets of this process, unless they come from
/// this machine or an allowed network: Cyclone binds its sockets to all addresses. Packets over the
/// loopback interface are from this machine, whatever their addresses.
/// \throws std::system_error
void admitOnly(std::span<const Network> allowed);

}  // namespace ispace::ros
