// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/operands.h"

#include "cli/common_options.h"

namespace ispace {

RunChanges changesOfRun(const std::string& folder, const Scene& start,
                        std::optional<std::uint64_t> max_work) {
    return {folder, start, shippedDevices(),
            [max_work](const std::string& file) {
                SceneRules rules;
                rules.same_environment = true;
                rules.max_work = max_work;
                return readScene({{file}, rules, false}).scene;
            },
            max_work};
}

}  // namespace ispace
