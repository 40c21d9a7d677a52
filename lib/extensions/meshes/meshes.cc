// SPDX-License-Identifier: GPL-3.0-or-later
// The rows stand in the order in which they are tried: cuts into walls before meshes, contents
// before suffixes. A file is handed to read-mesh as an open descriptor, so that the program needs
// no right to open files; side files of a mesh are opened here, on its demand.
#include "extensions/meshes/meshes.h"

#include <algorithm>

#include "base/confined.h"
#include "extensions/meshes/cloud_file.h"
#include "extensions/meshes/mesh_parts.h"
#include "io/glb/glb_read.h"
#include "io/import_records.h"
#include "io/mesh_files.h"
#include "io/packed_mesh.h"
#include "record/text.h"

namespace ispace::meshes {

namespace {

/// Reads a mesh, with the upward axis that OBJ leaves open.
template <Document (*kReader)(const std::string&, const ImportOptions&, const Schemas&)>
Document readUpright(const ImportSource& source) {
    ImportOptions options = source.options;
    std::string& up = options.own.edit<UpAxis>().name;
    if (up != "auto" || meshFormatOf(source.bytes) != MeshFormat::Obj)
        return kReader(source.operand, options, source.schemas);
    const auto* const unit =
        std::find_if(kLengthUnits.begin(), kLengthUnits.end(),
                     [&](const LengthUnit& known) { return known.name == options.units; });
    up = objUpAxis(source.bytes, unit == kLengthUnits.end() ? 1 : unit->metres);
    Document document = kReader(source.operand, options, source.schemas);
    const std::string choice = "OBJ taken with " + up + " upwards";
    if (!objUpComment(source.bytes) && options.report != nullptr)
        options.report->addChoice(source.operand, choice + ", by its extent; --up says otherwise");
    else
        document.notes.insert(document.notes.begin(), choice);
    return document;
}
constexpr auto* kReadMesh = readUpright<meshDocument>;
constexpr auto* kReadWalls = readUpright<readMeshWalls>;

bool isGlbMesh(const ImportSource& source) {
    return isGlb(source.bytes) && !glbHasRecords(source.bytes);
}

/// Returns true for a mesh that is cut into walls, which is a plan; a model of ours never is.
bool isCutMesh(const ImportSource& source) {
    return source.options.slice_walls && !isPointCloud(source.bytes) &&
           (isGlbMesh(source) || isMeshFile(source.bytes));
}

bool hasSuffix(const ImportSource& source) { return hasMeshSuffix(source.operand); }

/// Of files that only their names tell.
constexpr std::string_view kSuffixes[] = {".obj", ".stl", ".ply", ".dae", ".gltf"};

TriangleMesh readWithAssimp(const MeshSource& source) {
    return unpackedMesh(readConfined({.name = source.path,
                                      .program = "read-mesh",
                                      .arguments = {fileSuffix(source.path), source.options.up},
                                      .file = source.main.file.fd(),
                                      .bytes = source.main.size,
                                      .limits = meshLimits,
                                      .open = source.open,
                                      .work = &source.work,
                                      .kind = "mesh file",
                                      .reader = "assimp",
                                      .subject = "meshes are",
                                      .hint = "; is it installed, with assimp?"}),
                        source.path);
}

}  // namespace

void addMeshes() {
    static constexpr Importer kImporters[] = {
        {"", true, isCutMesh, kReadWalls, true},
        {"", false, isGlbMesh, kReadMesh, true},
        importer<isPointCloud, readPointCloud>("a point cloud"),
        {"a mesh", false, [](const ImportSource& source) { return isMeshFile(source.bytes); },
         kReadMesh, true},
        {"", true,
         [](const ImportSource& source) { return source.options.slice_walls && hasSuffix(source); },
         kReadWalls, true, true},
        {"", false, hasSuffix, kReadMesh, true, true},
    };
    static constexpr MeshReader kReaders[] = {{kSuffixes, nullptr, readWithAssimp}};
    addImporters(kImporters);
    addMeshReaders(kReaders);
}

}  // namespace ispace::meshes
