// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arrange/options.h"
#include "cli/operands.h"
#include "place/arrangement.h"

namespace ispace {

/// What is read before the search.
struct ArrangeWork {
    SceneInput input;
    std::vector<SensorGroup> groups;
    ArrangeOptions how;
    std::vector<std::string> files;  ///< for -MD
    std::string places;              ///< the text of --places
};

/// Reads room, layout, sensors, zones and places. \throws UsageError if nothing is to be placed,
/// and as the readers
ArrangeWork readWork(const ArrangeToolOptions& options);

}  // namespace ispace
