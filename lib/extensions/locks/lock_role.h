// SPDX-License-Identifier: GPL-3.0-or-later
// Locks of a run: readers of tags, drives, and robots that force doors.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "server/client_role.h"

namespace ispace::locks {

/// Makes the service of a run that has doors with `access`, `drive` or `strength`; else null.
///
/// A robot that runs into a locked door forces it if the energy of its mass at its speed across the
/// door reaches the door's `strength`. A door that opens or closes switches its `drive` on.
/// Programs such as card readers and keypads, any number of them, take the role LOCK by `LOCK GLOB`
/// for the doors that match, and show them tags (TRY): a door opens to those of its `access` for
/// kHeldOpen seconds, and shuts once its doorway is free. One that people have opened on their ways
/// stays open as long at least, and is shut behind them; one that a change has opened stays so. All
/// of this are changes of records, which a replay repeats. A step costs O(movers) if a door has
/// `strength`, and O(doors).
std::unique_ptr<RoleService> makeLocks(std::span<const RunRoom> rooms, std::uint64_t seed);

/// Seconds for which a tag opens a door.
constexpr double kHeldOpen = 5;

}  // namespace ispace::locks
