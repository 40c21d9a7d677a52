// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "io/mesh_load.h"

namespace ispace {

/// Which parts read-mesh gives.
enum class MeshShape {
    Whole,  ///< one, all in it
    Parts,  ///< one for each node that has triangles
};

/// Runs read-mesh on a file: starts it, hands it the files that the mesh names as far as it may
/// have them, and takes its answer, which is trusted in nothing. Nothing is left running.
/// \throws as loadMesh
std::vector<MeshPart> readMeshInChild(const std::string& path, const MeshOptions& options,
                                      MeshShape shape, std::vector<std::string>* side_files);

}  // namespace ispace
