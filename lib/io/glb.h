// SPDX-License-Identifier: GPL-3.0-or-later
// lib/io: file formats of others, and the compiled form. Uses layout; tinygltf inside.
#pragma once

#include <string>
#include <string_view>

#include "layout/scene.h"
#include "record/record.h"

namespace ispace {

/// True if the bytes begin as a binary glTF does.
bool isGlb(std::string_view bytes);

/// The compiled form: binary glTF 2.0, one named node per element (and sensor body), shared
/// materials with colours, normals, metres, +Y up; the records of `document` as canonical text
/// with magic and history in a buffer view of their own whose index is `extras.ispace` of the
/// top level. Equal input gives equal bytes.
std::string writeGlb(const Scene& scene, const Document& document);

/// The records of a compiled file. Reads the JSON in one pass without a tree, the mesh not at all.
/// \throws FormatError for truncated, foreign ("no ispace records") or damaged files
Document readGlb(std::string_view bytes, const std::string& name, const Schemas& schemas);

}  // namespace ispace
