// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ispace {

/// Triangles as a file of meshes holds them, in the file's own units and axes. Floats, as all those
/// formats and their readers have them. Indices lie within `vertices`.
struct TriangleMesh {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::string digest;  ///< sha256 over both, see meshDigest
};

}  // namespace ispace
