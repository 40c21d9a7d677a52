// SPDX-License-Identifier: GPL-3.0-or-later
// Formats of meshes, recognised by their content.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/packed_mesh.h"

namespace ispace::meshes {

/// Formats of meshes that are read.
enum class MeshFormat { Obj, Stl, Ply, Collada, Gltf, Glb };

/// The suffix of each, in lower case.
struct MeshSuffix {
    std::string_view suffix;
    MeshFormat format;
};
constexpr std::array<MeshSuffix, 6> kMeshSuffixes{{{".obj", MeshFormat::Obj},
                                                   {".stl", MeshFormat::Stl},
                                                   {".ply", MeshFormat::Ply},
                                                   {".dae", MeshFormat::Collada},
                                                   {".gltf", MeshFormat::Gltf},
                                                   {".glb", MeshFormat::Glb}}};

/// Returns true for STL as text, with its words in any case.
bool isTextStl(std::string_view bytes);

/// Recognises OBJ, STL, PLY or COLLADA by content; std::nullopt for other bytes.
std::optional<MeshFormat> meshFormatOf(std::string_view bytes);

/// Finds the upward axis, "y" or "z", in a comment of OBJ before the first vertex ("y up", "z-up");
/// std::nullopt if there is no such comment.
std::optional<std::string> objUpComment(std::string_view bytes);

/// Returns the upward axis of OBJ, "y" or "z", which the format does not define: objUpComment();
/// else y, as most programs write it, unless the extent is that of a room or building with z
/// upwards: less high than wide, over 4 m2 or more.
/// \param metres length of its unit
std::string objUpAxis(std::string_view bytes, double metres);

/// Returns true if the bytes are OBJ, STL, PLY or COLLADA.
bool isMeshFile(std::string_view bytes);

/// Limits of one file; larger files are rejected. See also kMaxMeshTriangles.
constexpr std::size_t kMaxMeshNodes = 1'000'000;  ///< each instance counts
constexpr std::size_t kMaxMeshNodeDepth = 1000;

}  // namespace ispace::meshes
