// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/building_runs.h"

namespace ispace {

RunInfo recordedInfo(const std::string& folder, const StoreyedDocument& building) {
    for (const Storey& storey : building.storeys)
        if (const auto info = recordedInfo(folder + '/' + storey.id)) return *info;
    // As after a killed run.
    for (const Storey& storey : building.storeys) {
        RunReader reader(folder + '/' + storey.id);
        if (reader.next() && reader.time() == 0 && reader.next())
            return {.step = reader.time(), .every = reader.time()};
    }
    throw FormatError(
        {folder, 0, 0, "holds no moment of a run, and no info.csv tells how long that was"});
}

}  // namespace ispace
