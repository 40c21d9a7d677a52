// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sense/sensors.h"

namespace ispace {

/// Tells what stands inside something solid. Keeps the slices of 64 heights; at others it says no.
class SolidJudge {
  public:
    explicit SolidJudge(const Environment& environment);
    ~SolidJudge();
    SolidJudge(const SolidJudge&) = delete;
    SolidJudge& operator=(const SolidJudge&) = delete;
    /// Strictly inside a solid, and farther from its surface than what touches it.
    [[nodiscard]] bool isInside(Point3 place);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// What a user may not have meant, a phrase each: sensors without a place, which are left out, and
/// sensors that stand inside something solid or outside the room.
/// \param with_receivers receivers count, too, where no tag is among the sensors
std::vector<std::string> sensorWarnings(const Scene& scene, const Sensors& sensors,
                                        const std::vector<std::string>& globs,
                                        bool with_receivers = false);

}  // namespace ispace
