// SPDX-License-Identifier: GPL-3.0-or-later
// Heads that turn by request of programs, with a speed.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "server/client_role.h"

namespace ispace::heads {

/// Makes the role HEAD of a run that has heads; null without any.
///
/// Programs, any number of them, take it by `HEAD GLOB` for the heads that match. TURN sends a head
/// to a pan and a tilt: both axes move evenly and arrive together, the one with the longer way at
/// the head's `speed`, and the client hears `EVENT turned`; HALT stops it; READ tells the angles.
/// A later TURN takes over. On the way the record changes every kTurnStep seconds, or every step of
/// a world with longer ones, which a replay repeats. A step costs O(turning heads), and
/// one change of the scene of each room in which heads turn. A turn ends where the head is, with
/// the event, if another request turns it, a smaller range forbids it, or the run is reset.
std::unique_ptr<RoleService> makeHeads(std::span<const RunRoom> rooms, std::uint64_t seed);

/// Seconds between two changes of a head that turns.
constexpr double kTurnStep = 0.05;

}  // namespace ispace::heads
