// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/operands.h"

#include "cli/common_options.h"

namespace ispace {

RunChanges changesOfRun(const std::string& folder, const Scene& start) {
    return {folder, start, shippedDevices(), [](const std::string& file) {
                return readScene({{file}, {.same_environment = true}, false}).scene;
            }};
}

}  // namespace ispace
