// SPDX-License-Identifier: GPL-3.0-or-later
// Files of `mesh` records: read once each, by the readers that extensions add, and compared with
// their digests. Readers may run parsers of foreign formats confined (base/confined.h): a crash or
// a loop in one is a FormatError of its file.
//
//     MeshFiles files;
//     const auto& chair = files.load("chair.obj", {.up = "z"});
//     use(*chair.mesh);  // shared by all records that name the file with these options
#pragma once

#include <cstddef>

#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/budget.h"
#include "base/file.h"
#include "io/importers.h"
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

/// A mesh file to be read.
struct MeshSource {
    const std::string& path;
    const RegularFile& main;
    const MeshOptions& options;
    Budget& work;
    /// Opens a file that it names, see openSideFile().
    std::function<std::optional<RegularFile>(const std::string& name)> open;
};

/// A reader of mesh files: one row.
struct MeshReader {
    /// Of files that only their names tell, in lower case: ".obj".
    std::span<const std::string_view> suffixes;
    /// Returns true for the first bytes of files that it reads, at most kMeshStart of them; null:
    /// it reads what no other row does.
    bool (*recognises)(std::string_view start) = nullptr;
    /// Reads the triangles, without the digest. \throws FormatError
    TriangleMesh (*read)(const MeshSource& source) = nullptr;
};
constexpr std::size_t kMeshStart = 1U << 16U;

/// Adds readers; a program does so before it reads a file.
void addMeshReaders(std::span<const MeshReader> readers);

/// Returns true for the name of a file with the suffix of a reader, in any case.
bool hasMeshSuffix(const std::string& file);

/// Returns the suffix of a file's name in lower case: ".obj".
std::string fileSuffix(const std::string& path);

/// Returns the name and the converter of a known mesh format that is not read, e.g. "a .3ds mesh:
/// …"; "" for other suffixes.
std::string foreignMesh(const std::string& path);

/// Reads the triangles of a file, by the first reader that recognises it. All parts are transformed
/// by their nodes, polygons triangulated, equal vertices merged; points, lines and triangles
/// without area are dropped. COLLADA and IFC come in metres, others in their own units. \param
/// side_files receives the paths that the file names: buffers of glTF; existing material files of
/// OBJ, though their content is not read \throws FormatError: another format, no triangles, NaN,
/// more than kMaxMesh…, a side file outside the permitted folders; std::system_error if the file
/// cannot be opened
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

}  // namespace ispace
