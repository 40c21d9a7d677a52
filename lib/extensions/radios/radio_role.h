// SPDX-License-Identifier: GPL-3.0-or-later
// Radios of a run: messages between programs by the places of their radios.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "server/client_role.h"

namespace ispace::radios {

/// Makes the role RADIO of a run that has radios; null without any.
///
/// Programs, any number of them, take it by `RADIO GLOB` for the radios that match. SEND sends a
/// text from a radio; all radios of its kind and channel in the same room whose signal suffices at
/// that moment receive it, see signalMargin(), and their programs hear `EVENT message`. READ tells
/// counts. Each radio has the state `heard`, the number of messages received, as events of the run.
/// A message costs O(radios of the room) and a ray for each that is near enough.
/// \param seed of the drops: the same requests at the same times lose the same messages
/// \throws FormatError as radioCarrier()
std::unique_ptr<RoleService> makeRadios(std::span<const RunRoom> rooms, std::uint64_t seed);

}  // namespace ispace::radios
