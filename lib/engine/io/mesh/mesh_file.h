// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/io/mesh: meshes and point clouds, read in a confined program and cut to plans.
#pragma once

#include <exception>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "base/budget.h"

#include "io/importers.h"
#include "io/mesh/mesh_parts.h"
#include "record/record.h"

namespace ispace {

/// Options for reading a mesh file.
struct MeshOptions {
    /// auto: rotated so that z points up, glTF from y, COLLADA and OBJ from the axis they name, OBJ
    /// in a comment; without one, and in other formats, z points up. x, y or z: the upward axis,
    /// whatever the file says.
    std::string up = "auto";
    /// Files that it names may lie anywhere, not only in its folder and below.
    bool side_files_anywhere = false;
    WorkLimit max_work = {};  ///< of the file, see Budget
};

/// Reads the triangles of a file: OBJ, STL, PLY, COLLADA, glTF, GLB and IFC, by content, else by
/// suffix. All parts are transformed by their nodes, polygons triangulated, equal vertices merged;
/// points, lines and triangles without area are dropped. COLLADA and IFC come in metres, others in
/// their own units.
///
/// A separate program, `lib/ispace/read-mesh`, parses the bytes with bounds on memory and time and
/// without rights; a file that makes it crash, grow or hang is an ordinary bad file.
/// \param side_files receives the paths that the file names: buffers of glTF; existing material
/// files of OBJ, though their content is not read
/// \throws FormatError: another format, no triangles, NaN, more than kMaxMesh…, a side file outside
/// the permitted folders; std::system_error if the file cannot be opened
std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const MeshOptions& options,
                                             std::vector<std::string>* side_files = nullptr);

/// Meshes of files, each read once.
class MeshFiles {
  public:
    struct Loaded {
        std::shared_ptr<const TriangleMesh> mesh;
        std::vector<std::string> side_files;  ///< as loadMesh() returns them
    };
    /// \throws as loadMesh(); for a file that failed before, the same error
    const Loaded& load(const std::string& path, const MeshOptions& options);

  private:
    struct File {
        Loaded loaded;
        std::exception_ptr failure;
    };
    /// By path without links, its folder as named, and what the options say about its content.
    std::map<std::tuple<std::string, std::string, std::string, bool>, File> files_;
};

/// Loads the file of each `mesh` record that has no content yet, each file once, and adds its path
/// and those of the files it names to Document::sources. Paths are relative to the operand's folder
/// (for "-" the current one). The files share a budget of work, see ImportOptions::max_work, and
/// those of ImportOptions::meshes are not read again.
/// \throws FormatError with findings at the records: no such file, bad files, a content that
/// differs from `digest`
void loadMeshes(Document& document, const std::string& operand, const ImportOptions& options);

/// Returns a document of one `mesh` record that names the operand, not loaded; its id comes from
/// the file's name. \throws FormatError for "-": records need a name, and other files may belong to
/// it
Document meshDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas);

}  // namespace ispace
