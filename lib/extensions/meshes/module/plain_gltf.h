// SPDX-License-Identifier: GPL-3.0-or-later
// glTF whose geometry is packed by extensions, rewritten as glTF that every reader understands.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/budget.h"
#include "extensions/meshes/mesh_parts.h"

namespace ispace::meshes {

/// Reads a buffer that the file names by its URI; std::nullopt if there is none.
using ReadBuffer = std::function<std::optional<std::string>(const std::string& uri)>;

/// A glTF file and the buffers that it names.
struct PlainGltf {
    std::string json;
    std::map<std::string, std::string> buffers;  ///< by URI
};

/// Rewrites glTF 2 whose geometry needs extensions: the triangles of all meshes with positions as
/// floats and indices as 32-bit integers, its nodes, and the names of its materials.
///
/// Reads KHR_mesh_quantization (positions as integers) and EXT_meshopt_compression (buffers packed
/// by gltfpack, with their filters); checkMesh() rejects others. Positions as integers without
/// this extension, which some exporters write, are read likewise. The work is charged before memory
/// is allocated: a unit for 8 numbers.
///
/// \param format Gltf or Glb \param bytes of the file, see checkMesh()
/// \return std::nullopt if assimp reads the file as it is
/// \throws std::runtime_error for files whose accessors, views or buffers contradict each other;
/// TooMuchWork
///
/// Sources: the specifications of glTF 2.0 (3.6.2, 3.11) and of both extensions, Khronos Group.
std::optional<PlainGltf> plainGltf(MeshFormat format, std::string_view bytes,
                                   const ReadBuffer& read_buffer, Budget& work);

}  // namespace ispace::meshes
