// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_load.h"

namespace ispace {

/// loadMeshParts in a program of its own, `lib/ispace/read-building` beside the one that runs:
/// assimp's reader of IFC follows references to what is missing, or of another type, and ends by a
/// signal; a damaged building is an error here, as any other file.
/// \throws FormatError
std::vector<MeshPart> loadBuildingParts(const std::string& path, const std::string& up);

/// What that program writes: parts as bytes of this machine, or what is wrong.
std::string packedParts(const std::vector<MeshPart>& parts);
std::string packedError(std::string_view message);

/// Reads it back. \param path the building, for messages
/// \throws FormatError: an error was packed, or the bytes are not whole
std::vector<MeshPart> unpackedParts(std::string_view bytes, const std::string& path);

}  // namespace ispace
