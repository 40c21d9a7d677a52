// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sense/sensors.h"

namespace ispace {

/// What a user may not have meant, a phrase each: sensors without a place, which are left out, and
/// sensors that stand inside something solid or outside the room.
/// \param with_receivers receivers count, too, where no tag is among the sensors
std::vector<std::string> sensorWarnings(const Scene& scene, const Sensors& sensors,
                                        const std::vector<std::string>& globs,
                                        bool with_receivers = false);

}  // namespace ispace
