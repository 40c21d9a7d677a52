// SPDX-License-Identifier: GPL-3.0-or-later
// For tests: scenes from text.
#pragma once

#include <string>

#include "coverage/coverage.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

namespace ispace {

/// Builds the scene of record lines, without magic line; only bare lasers.
inline Scene sceneOf(const std::string& lines) {
    return makeScene(readRecordText("#env 1\n" + lines, "test.env", sceneSchemas()), nullptr, {});
}

inline Coverage coverageOf(const Scene& scene, int columns = 100, int rows = 100) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, {.cells = CellCount{columns, rows}});
}

}  // namespace ispace
