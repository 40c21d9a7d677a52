// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/robustness.
#pragma once

#include <string>

#include "coverage/coverage.h"
#include "trace/ray_world.h"

namespace ispace::robustness {

/// Five receivers below the ceiling.
inline const std::string kReceivers = [] {
    std::string lines;
    for (int i = 0; i < 5; ++i)
        lines += "ultrasound id=u" + std::to_string(i) + " at=" + std::to_string(i - 3) + "," +
                 std::to_string(i % 3 - 1) + ",2.9 tilt=-90 fov=100 range=9\n";
    return lines;
}();

inline CoverageOptions cellsOfTest(bool exact = true) {
    CoverageOptions options;
    options.cells = CellSize{0.1};
    options.exact = exact;
    return options;
}

inline Coverage measuredBy(const Scene& scene, const CoverageOptions& options) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, options);
}

}  // namespace ispace::robustness
