// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_load.h"

#include <utility>

#include "io/mesh_reader.h"
#include "record/digest.h"

namespace ispace {

std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const MeshOptions& options,
                                             std::vector<std::string>* side_files) {
    std::vector<MeshPart> parts = readMeshInChild(path, options, MeshShape::Whole, side_files);
    auto mesh = std::make_shared<TriangleMesh>(std::move(parts.front().mesh));
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

std::vector<MeshPart> loadMeshParts(const std::string& path, const MeshOptions& options) {
    return readMeshInChild(path, options, MeshShape::Parts, nullptr);
}

}  // namespace ispace
