// SPDX-License-Identifier: GPL-3.0-or-later
// How an extension makes the service of its role, for headers that need no more of it than its
// name. See server/client_role.h.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace ispace {

class RoleService;
struct RunRoom;

/// Makes the service of an extension for a run; null if the scenes ask for none. \param rooms of
/// the run; \param seed of the run \throws FormatError for records that contradict each other
using MakeRoleService = std::unique_ptr<RoleService> (*)(std::span<const RunRoom> rooms,
                                                         std::uint64_t seed);

}  // namespace ispace
