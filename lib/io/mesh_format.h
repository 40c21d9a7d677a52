// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ispace {

/// Formats of meshes that are read.
enum class MeshFormat { Obj, Stl, Ply, Collada, Gltf, Glb, Ifc };

/// What the bytes say they are: OBJ, STL, PLY or COLLADA, or nothing of these.
std::optional<MeshFormat> meshFormatOf(std::string_view bytes);

/// True if the bytes are OBJ, STL, PLY or COLLADA.
bool isMeshFile(std::string_view bytes);

/// True for `chair.obj` and the like, in any case.
bool hasMeshSuffix(const std::string& operand);

/// In lower case: ".obj".
std::string meshSuffix(const std::string& path);

/// What a mesh is by its suffix that is not read, and what helps: "a .3ds mesh, …"; "" for others.
std::string foreignMesh(const std::string& path);

}  // namespace ispace
