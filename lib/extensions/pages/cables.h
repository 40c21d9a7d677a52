// SPDX-License-Identifier: GPL-3.0-or-later
// Cables from sensors to the panels of a room, for the material and the sheet of the installer.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace ispace::pages {

/// The cable of a sensor that stands still.
struct Cable {
    std::size_t sensor = 0;  ///< index in Scene::sensors
    std::string panel;       ///< id of the record `panel` at which it ends
    double length = 0;       ///< metres
    double cost = 0;         ///< of its length
};

/// Lays a cable from each sensor that stands still to the `panel` record that it reaches by the
/// shortest one: from the sensor straight to the nearest wall, along walls and over doors to the
/// panel, and up or down by the difference of their heights. Empty without panels. In the order of
/// the scene; O(panels * walls log walls + sensors * walls).
std::vector<Cable> cablesOf(const Scene& scene);

}  // namespace ispace::pages
