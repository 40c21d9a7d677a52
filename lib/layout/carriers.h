// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/layout only: where sensors stand that have `on`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "record/record.h"
#include "sensor/sensor.h"

namespace ispace {

/// Everything in a scene by its id: what `on` of a sensor may mean.
class Carriers {
  public:
    Carriers(const std::vector<Record>& records, const std::vector<std::string>& ids);

    struct Place {
        Pose3 pose;  ///< in the world; on a robot where that starts
        std::optional<Mount> mount;
    };
    /// Where a sensor with `on` is. \throws FormatError if that names no carrier
    [[nodiscard]] Place place(const Record& sensor);

  private:
    struct Thing {
        const Record* record;
        std::size_t robot;  // index among the robots, if it is one
        std::optional<double> top = {};
    };

    std::map<std::string, Thing> things_;
    std::vector<std::string> candidates_;  // ids, for hints
};

}  // namespace ispace
