// SPDX-License-Identifier: GPL-3.0-or-later
// The answer of the program that reads meshes, which may be any bytes: a bad file can control that
// program.
#include <algorithm>
#include <cmath>

#include "fuzz.h"
#include "io/packed_mesh.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const TriangleMesh mesh = unpackedMesh(bytes, "mesh");
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            require(std::isfinite(mesh.vertices.at(corner)[0]), "a vertex that is no place");
    require(packedMesh(mesh) == bytes, "other bytes after unpacking and packing");
}
