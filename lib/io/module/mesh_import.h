// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/mesh_parts.h"

namespace ispace {

/// Reads the mesh on standard input with assimp, as loadMesh says. \param size in bytes
/// \param whole all in one part, else one for each node that has triangles
/// \throws std::runtime_error with what is wrong with the file
std::vector<MeshPart> importMesh(MeshFormat format, std::size_t size, const std::string& up,
                                 bool whole);

}  // namespace ispace
