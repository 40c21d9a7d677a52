// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sense/sensors.h"

namespace ispace {

/// Tells which places are buried, see Level. Each height costs a slice, so it looks at the first 64
/// only and says no at others. An index of the solids at a height is made for the fifth place.
class BurialTest {
  public:
    explicit BurialTest(const Environment& environment) : environment_(environment) {}
    [[nodiscard]] bool isBuried(Point3 place);

  private:
    /// A height, and how many places were looked at.
    struct Known {
        std::shared_ptr<const Level> level;
        std::size_t asked = 0;
    };

    const Environment& environment_;
    std::map<double, Known> levels_;
};

/// What a user may not have meant, a phrase each: sensors without a place, which are left out, and
/// sensors that stand inside something solid or outside the room.
/// \param with_receivers receivers count, too, where no tag is among the sensors
std::vector<std::string> sensorWarnings(const Scene& scene, const Sensors& sensors,
                                        const std::vector<std::string>& globs,
                                        bool with_receivers = false);

}  // namespace ispace
