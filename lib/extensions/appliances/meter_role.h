// SPDX-License-Identifier: GPL-3.0-or-later
// Meters of a run: what plugs count, told to programs and as events.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "server/client_role.h"

namespace ispace::appliances {

/// Makes the service of a run that has appliances or plugs; null without any.
///
/// It leads appliances through their phases by changes of their records, which a record of the run
/// has; a replay repeats those. Programs, any number of them, take the role METER by `METER GLOB`
/// for the plugs that match, read them (READ), and hear when their power or count changes (WATCH).
/// Each plug has the states `power` and `energy`, in W and kWh since the start, as events of the
/// run. A step costs O(plugs), and O(appliances) after a change of their world.
std::unique_ptr<RoleService> makeMeters(std::span<const RunRoom> rooms, std::uint64_t seed);

}  // namespace ispace::appliances
