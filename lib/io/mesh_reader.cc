// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/confined.h"
#include "base/number.h"
#include "io/ifc/building_process.h"
#include "io/mesh_file.h"
#include "io/mesh_parts.h"
#include "io/side_files.h"
#include "record/text.h"

namespace ispace {

std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const MeshOptions& options,
                                             std::vector<std::string>* side_files) {
    if (const std::string what = foreignMesh(path); !what.empty()) failFile(path, "it is " + what);
    const RegularFile main = openRegular(path);
    std::set<std::string> opened;
    const auto open = [&](const std::string& name) {
        auto file = openSideFile(path, name, options.side_files_anywhere);
        const std::string side = sideFilePath(path, name);
        if (file && side_files != nullptr && opened.insert(side).second)
            side_files->push_back(side);
        return file;
    };
    const auto limits = [](std::size_t bytes) { return meshLimits(bytes, false); };
    auto mesh = std::make_shared<TriangleMesh>(
        unpackedMesh(readConfined({.name = path,
                                   .program = "read-mesh",
                                   .arguments = {meshSuffix(path), options.up, "mesh"},
                                   .file = main.file.fd(),
                                   .bytes = main.size,
                                   .limits = limits,
                                   .open = open,
                                   .kind = "mesh file",
                                   .reader = "assimp",
                                   .subject = "meshes are",
                                   .hint = "; is it installed, with assimp?"}),
                     path));
    if (mesh->triangles.empty()) failFile(path, "a mesh file without triangles");
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

Building readBuildingInChild(std::string_view bytes, const std::string& name,
                             std::optional<double> slice) {
    const OpenFile copy = fileInMemory(bytes);
    const std::string answer = readConfined(
        {.name = name,
         .program = "read-mesh",
         .arguments = {meshSuffix(name), slice ? formatDouble(*slice) : "", "building"},
         .file = copy.fd(),
         .bytes = bytes.size(),
         .limits = [](std::size_t size) { return meshLimits(size, true); },
         .kind = "IFC file",
         .reader = "its reader",
         .subject = "buildings are",
         .hint = "; is it installed, with assimp?"});
    try {
        return unpackedBuilding(answer);
    } catch (const std::runtime_error& error) {
        failFile(name, std::string("bad IFC file: ") + error.what());
    }
}

}  // namespace ispace
