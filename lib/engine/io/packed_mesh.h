// SPDX-License-Identifier: GPL-3.0-or-later
// The answer of confined programs that read mesh files, and the limits of such files. Packed bytes
// are for the two ends of a pipe on one machine, never for a file. O(bytes).
//
//     return packedMesh(mesh);                                     // in the confined program
//     const TriangleMesh mesh = unpackedMesh(answer, "desk.obj");  // in its caller
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/confined.h"
#include "record/record.h"

namespace ispace {

/// Limits of one file; larger files are rejected.
constexpr std::size_t kMaxMeshTriangles = 50'000'000;

/// Limits of a program that reads files of this total size: at least 1 GB of memory and 20 s; above
/// 1 GB at most three quarters of the machine's memory.
ConfinedLimits meshLimits(std::size_t file_bytes);

std::string packedMesh(const TriangleMesh& mesh);

/// Reads a packed mesh and validates it: on return indices are valid and vertices finite.
/// \param path the mesh, for messages
/// \throws FormatError: bytes that packedMesh() did not write
TriangleMesh unpackedMesh(std::string_view bytes, const std::string& path);

}  // namespace ispace
