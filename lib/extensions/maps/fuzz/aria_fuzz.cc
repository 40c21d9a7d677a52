// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of ARIA and MobileSim, with the points of their DATA as obstacles.
#include "extensions/maps/maps.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    ImportOptions options;
    options.own.edit<ispace::maps::AriaPoints>().are_obstacles = true;
    tryPlan(maps::readAriaMap, bytes, "plan.map", options);
}
