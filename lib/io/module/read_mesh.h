// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_parts.h"

namespace ispace {

/// Takes from this process what a reader of strangers' bytes does not need: memory and time beyond
/// the limits, files (those that are open stay), programs, the network, a core, and its life when
/// the parent ends. Where the system has no seccomp, or refuses it, the limits hold all the same.
/// Under sanitizers, which need more, only time is limited.
void confine(const MeshLimits& limits, int parent);

/// By content; where that leaves it open by suffix (".obj", lower case).
/// \throws std::runtime_error if neither tells
MeshFormat meshFormat(std::string_view bytes, const std::string& suffix);

/// Where assimp 5.2 crashes, hangs or takes what the file says for true, and where a look
/// beforehand gives a better message than its end: headers of PLY, chunks of GLB, and the nodes of
/// glTF and COLLADA, which may hang on each other in a circle, too deep, or too many times. \throws
/// std::runtime_error
void checkMesh(MeshFormat format, std::string_view bytes);

/// Reads the mesh on standard input with assimp, as loadMesh says. \param size in bytes
/// \param whole all in one part, else one for each node that has triangles
/// \throws std::runtime_error with what is wrong with the file
std::vector<MeshPart> importMesh(MeshFormat format, std::size_t size, const std::string& up,
                                 bool whole);

}  // namespace ispace
