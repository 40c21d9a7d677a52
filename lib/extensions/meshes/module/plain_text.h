// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of meshes, rewritten as assimp 5.2 understands them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "extensions/meshes/mesh_parts.h"

namespace ispace::meshes {

/// Rewrites texts that are valid, but that assimp rejects: COLLADA with blanks before the first
/// number of an element, and STL with its words in capitals or behind blanks. O(bytes)
/// \return std::nullopt if assimp reads the file as it is
std::optional<std::string> plainMeshText(MeshFormat format, std::string_view bytes);

}  // namespace ispace::meshes
