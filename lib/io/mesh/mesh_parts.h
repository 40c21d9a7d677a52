// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/confined.h"
#include "record/record.h"

namespace ispace {

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

/// OBJ, STL, PLY or COLLADA by content; nothing for other bytes.
std::optional<MeshFormat> meshFormatOf(std::string_view bytes);

/// The axis of OBJ that a comment before the first vertex says points up ("y up", "z-up"): "y" or
/// "z"; nothing without one.
std::optional<std::string> objUpComment(std::string_view bytes);

/// The axis of OBJ that points up, "y" or "z", which the format does not say: objUpComment(); else
/// y, as most programs write it, unless the extent is that of a room or building with z upwards:
/// less high than wide, over 4 m2 or more.
/// \param metres of one of its numbers
std::string objUpAxis(std::string_view bytes, double metres);

/// True if the bytes are OBJ, STL, PLY or COLLADA.
bool isMeshFile(std::string_view bytes);

/// True for `chair.obj` and the like, in any case.
bool hasMeshSuffix(const std::string& operand);

/// In lower case: ".obj".
std::string meshSuffix(const std::string& path);

/// For suffixes of meshes that are not read, what they are and how to convert them: "a .3ds mesh:
/// …"; "" for others.
std::string foreignMesh(const std::string& path);

/// Limits of one file; more is refused.
constexpr std::size_t kMaxMeshTriangles = 50'000'000;
constexpr std::size_t kMaxMeshNodes = 1'000'000;  ///< each instance counts
constexpr std::size_t kMaxMeshNodeDepth = 1000;

/// Limits of lib/ispace/read-mesh for files of so many bytes in all: 1 GB of memory and 20 s at
/// least, and never more than three quarters of the memory there is beyond that.
ConfinedLimits meshLimits(std::size_t file_bytes, bool is_building);

std::string packedMesh(const TriangleMesh& mesh);

/// Reads a packed mesh and trusts nothing: on return indices are valid and vertices finite.
/// \param path the mesh, for messages
/// \throws FormatError: the bytes are not what packedMesh writes
TriangleMesh unpackedMesh(std::string_view bytes, const std::string& path);

}  // namespace ispace
