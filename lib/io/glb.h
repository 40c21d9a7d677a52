// SPDX-License-Identifier: GPL-3.0-or-later
// lib/io: file formats of others, and the compiled form. Uses plan and what is below it.
#pragma once

#include <string>
#include <string_view>

#include "layout/scene.h"
#include "record/record.h"

namespace ispace {

/// True if the bytes begin as a binary glTF does.
bool isGlb(std::string_view bytes);

/// False for a sound binary glTF file without our records: a mesh of another program. True for
/// damaged files, which readGlb() explains. \pre isGlb(bytes)
bool glbHasRecords(std::string_view bytes);

/// The compiled form: binary glTF 2.0, one named node per element (and sensor body), shared
/// materials with colours, normals, metres, +Y up; the records of `document` as canonical text
/// with magic and history in a buffer view of their own whose index is `extras.ispace` of the
/// top level. Equal input gives equal bytes.
///
/// The contents of mesh files are stored once each, in the file's own numbers: nodes turn, scale
/// and move them. `extras.ispace_meshes` names digest, positions (3 floats a vertex) and indices
/// (3 uint32 a triangle) of each by their buffer views; records find theirs by `digest`.
/// \throws FormatError for a model of more than 2 GiB
std::string writeGlb(const Scene& scene, const Document& document);

/// The records of a compiled file, meshes loaded, bit by bit as they were. The JSON is streamed, no
/// further than needed; what is only drawn is not read. O(records + meshes). \throws FormatError
/// for truncated, foreign ("no ispace records") or damaged files
Document readGlb(std::string_view bytes, const std::string& name, const Schemas& schemas);

}  // namespace ispace
