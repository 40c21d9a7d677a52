// SPDX-License-Identifier: GPL-3.0-or-later
// arrange over all storeys of a building.
#pragma once

#include "arrange/arrange_options.h"

namespace ispace {

/// Shares the sensors out over the storeys of a building and writes the layout. \return false,
/// without having done anything, if ENV is a room or a storey is chosen
/// \throws UsageError for options about one room, UnmetError for sensors without candidates
bool arrangeInBuilding(const ArrangeCommand& command);

}  // namespace ispace
