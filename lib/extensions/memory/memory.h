// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/memory: contents kept at places of a room, which tags touch: the role MEMORY of
// simrun. Uses server and below.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "extensions/memory/volume.h"
#include "server/client_role.h"

namespace ispace::memory {

/// Makes the role MEMORY of a run that has volumes or ultrasonic tags; null without any.
///
/// Programs, any number of them, take it by `MEMORY GLOB` for the tags that match, keep contents at
/// places (STORE, FORGET), find them (FIND, RECALL), and hear when a tag touches a volume, stays
/// there, and leaves: by the positions that the tag's readings have, with their errors. Each volume
/// has the state `touched`, as an event of the run: 1 while a tag is in it.
/// \throws FormatError as volumesOf()
std::unique_ptr<RoleService> makeMemory(std::span<const RunRoom> rooms, std::uint64_t seed);

}  // namespace ispace::memory
