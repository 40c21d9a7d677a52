// SPDX-License-Identifier: GPL-3.0-or-later
// Grid maps of MovingAI's benchmarks.
#include "extensions/maps/maps.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    tryPlan(maps::readGridMap, bytes, "plan.map");
}
