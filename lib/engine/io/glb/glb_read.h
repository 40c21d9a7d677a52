// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the compiled form: binary glTF with records. Bytes are untrusted: JSON is read as a stream,
// without a tree and without recursion, meshes may take no more bytes than the file has, and each
// mesh must have the digest by which a record names it. Geometry that is only drawn is not parsed,
// so that a compiled room opens in the time of its records.
//
//     if (isGlb(bytes) && glbHasRecords(bytes)) return readGlb(bytes, "room.3dm", schemas);
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/glb/glb_write.h"
#include "record/record.h"

namespace ispace {

/// Returns true if the bytes begin with the header of a binary glTF file.
bool isGlb(std::string_view bytes);

/// Returns false for a sound binary glTF file without our records, i.e. a mesh of another program;
/// true for damaged files; readGlb() reports their errors. \pre isGlb(bytes)
bool glbHasRecords(std::string_view bytes);

/// Reads the records of a compiled file, bit by bit as written, with their meshes loaded. Parses
/// the JSON only as far as needed and skips data that is only drawn. O(records + meshes).
/// \throws FormatError for truncated, foreign ("no ispace records") or damaged files
Document readGlb(std::string_view bytes, const std::string& name, const Schemas& schemas);

/// Reads the same from a file, but only its beginning and the views of the records and of the
/// meshes that they name. Returns std::nullopt if it is not a regular file, not a sound binary glTF
/// file, or has no records of one room; readGlb() reports the reason.
/// \throws FormatError as readGlb; std::system_error
std::optional<Document> readGlbFile(const std::string& file, const Schemas& schemas);

/// Returns true for a file that readGlbFile() reads. Reads no meshes. \throws std::system_error
bool isGlbRoom(const std::string& file);

/// Returns the text in a compiled file that is not in the language of records, such as that of
/// several scenes; std::nullopt for one of records, for other files and for damaged ones.
std::optional<std::string> glbOtherText(std::string_view bytes);

/// Sets the content of mesh records from the meshes stored in a compiled file.
/// \throws FormatError as readGlb
void attachGlbMeshes(std::string_view bytes, const std::string& name, std::vector<Record>& records);

}  // namespace ispace
