// SPDX-License-Identifier: GPL-3.0-or-later
// Presence of a building as the sum of its storeys.
#pragma once

#include <span>

#include "extensions/presence/presence.h"
#include "site/site_scene.h"

namespace ispace::presence {

/// Puts the storey before the ids of sensors. \param of_people also before those of people: they
/// are others on each storey
void nameWholly(const Storey& storey, bool of_people, Presence& presence);

/// Adds up the presence on all storeys: lengths add up, shares are of all ways. People of one id
/// are one. \pre ids of sensors name their storeys
Presence sumOverStoreys(std::span<const Presence> storeys);

}  // namespace ispace::presence
