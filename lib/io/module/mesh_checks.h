// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/mesh_parts.h"

namespace ispace {

/// By content; where that leaves it open by suffix (".obj", lower case).
/// \throws std::runtime_error if neither tells
MeshFormat meshFormat(std::string_view bytes, const std::string& suffix);

/// Where assimp 5.2 crashes, hangs or takes what the file says for true, and where a look
/// beforehand gives a better message than its end: headers of PLY, chunks of GLB, and the nodes of
/// glTF and COLLADA, which may hang on each other in a circle, too deep, or too many times. \throws
/// std::runtime_error
void checkMesh(MeshFormat format, std::string_view bytes);

}  // namespace ispace
