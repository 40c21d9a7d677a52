// SPDX-License-Identifier: GPL-3.0-or-later
// Time and memory of the confined program that reads buildings, by the size of the file;
// base/confined.h enforces them.
#pragma once

#include <algorithm>
#include <cstddef>

#include "io/packed_mesh.h"

namespace ispace::ifc {

/// Limits of lib/ispace/read-building: those of meshes, but more time, since solids of a building
/// are cut by each other.
inline ConfinedLimits buildingLimits(std::size_t file_bytes) {
    constexpr std::size_t kMega = 1U << 20U;
    ConfinedLimits limits = meshLimits(file_bytes);
    limits.seconds = 60 + 10 * std::min<std::size_t>(file_bytes / kMega, 1024);
    return limits;
}

}  // namespace ispace::ifc
