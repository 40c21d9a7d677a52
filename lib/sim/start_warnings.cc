// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/start_warnings.h"

namespace ispace {

std::vector<std::string> startWarnings(const World& world, std::string_view id) {
    std::vector<std::string> warnings;
    for (const std::size_t robot : world.keptStarts()) {
        const std::string& name = world.robots()[robot].id;
        if (id.empty() || name == id)
            warnings.push_back("the start_noise of " + name +
                               " leads nowhere free: it starts where its record says");
    }
    return warnings;
}

}  // namespace ispace
