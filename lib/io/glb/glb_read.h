// SPDX-License-Identifier: GPL-3.0-or-later
// lib/io: file formats of others, and the compiled form. Uses plan and what is below it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/glb/glb_write.h"
#include "record/record.h"

namespace ispace {

/// True if the bytes begin as a binary glTF does.
bool isGlb(std::string_view bytes);

/// False for a sound binary glTF file without our records: a mesh of another program. True for
/// damaged files, which readGlb() explains. \pre isGlb(bytes)
bool glbHasRecords(std::string_view bytes);

/// The records of a compiled file, meshes loaded, bit by bit as they were. The JSON is streamed, no
/// further than needed; what is only drawn is not read. O(records + meshes). \throws FormatError
/// for truncated, foreign ("no ispace records") or damaged files
Document readGlb(std::string_view bytes, const std::string& name, const Schemas& schemas);

/// The same of a file, of which only what is needed is read: its beginning, and the views of the
/// records and of the meshes that they name. Nothing where it is no regular file, no sound binary
/// glTF or has no records of ours, which readers of all its bytes tell.
/// \throws FormatError as readGlb; std::system_error
std::optional<Document> readGlbFile(const std::string& file, const Schemas& schemas);

}  // namespace ispace
