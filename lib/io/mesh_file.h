// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "geom/triangle_mesh.h"
#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// Triangles of larger files are refused.
constexpr std::size_t kMaxMeshTriangles = 50'000'000;

/// Reads the triangles of a file of meshes: OBJ, STL, PLY, COLLADA, glTF and what else assimp
/// knows. All parts are put where their nodes are, polygons cut into triangles, points and lines
/// left out, equal vertices joined, triangles without area dropped. \param up auto: turned so that
/// z points up: glTF from y, COLLADA from what it says; files of other
///        formats stay as they are. x, y or z: the file's own axes, whatever it says of them.
///        COLLADA comes in metres, others in their own units.
/// \throws FormatError: nothing that assimp reads, no triangles, NaN; std::system_error if the file
///         cannot be opened
std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const std::string& up);

/// Loads the file of each `mesh` record that has no content yet, each file once, and adds its path
/// to Document::sources. Paths are relative to the operand's folder (for "-" the current one).
/// \throws FormatError with findings at the records: no such file, bad files, a content other than
///         `digest` says
void loadMeshes(Document& document, const std::string& operand);

/// True if the bytes are OBJ, STL, PLY or COLLADA.
bool isMeshFile(std::string_view bytes);

/// True for `chair.obj` and the like, in any case.
bool hasMeshSuffix(const std::string& operand);

/// A document of one `mesh` record that names the operand, not loaded; its id is the file's name if
/// that can be one.
/// \throws FormatError for "-": other files may belong to it, and records name it
Document meshDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas);

}  // namespace ispace
