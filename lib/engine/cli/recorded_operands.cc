// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/recorded_operands.h"

#include "cli/storey_operands.h"
#include "scene/run/run_reader.h"

namespace ispace {

std::vector<std::string> operandsOrRecorded(std::vector<std::string> operands,
                                            const std::string& option, const std::string& folder) {
    if (!operands.empty() || folder.empty()) return operands;
    mustHoldRecord(option, folder);
    const std::string building = recordedBuilding(folder);
    operands.push_back(building.empty() ? fileOfRecord(folder, "scene.env") : building);
    return operands;
}

}  // namespace ispace
