// SPDX-License-Identifier: GPL-3.0-or-later
// The confined program that reads a mesh: errors are std::runtime_error with a text for the user,
// as this side knows no records.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/budget.h"
#include "extensions/meshes/mesh_parts.h"

namespace ispace::meshes {

/// Finds the format by content, else by suffix (".obj", lower case).
/// \throws std::runtime_error if neither is known
MeshFormat meshFormat(std::string_view bytes, const std::string& suffix);

/// Rejects files that crash or hang assimp 5.2, or make it trust wrong sizes: bad headers of PLY,
/// bad chunks of GLB, and nodes of glTF and COLLADA that form circles or are too deep or too many.
/// \throws std::runtime_error
void checkMesh(MeshFormat format, std::string_view bytes);

/// Reads the mesh on standard input with assimp, as loadMesh says. \param size in bytes
/// \param up the upward axis, or auto \param obj_up the result of objUpComment(), for OBJ
/// \param work pays for nodes that repeat meshes
/// \throws std::runtime_error with the error of the file, TooMuchWork
TriangleMesh importMesh(MeshFormat format, std::size_t size, const std::string& up,
                        const std::optional<std::string>& obj_up, Budget& work);

}  // namespace ispace::meshes
