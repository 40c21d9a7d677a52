// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "geom/triangle_mesh.h"

namespace ispace {

/// Triangles of larger files are refused.
constexpr std::size_t kMaxMeshTriangles = 50'000'000;

/// Reads the triangles of a file of meshes: OBJ, STL, PLY, COLLADA, glTF and what else assimp
/// knows. All parts are put where their nodes are, polygons cut into triangles, points and lines
/// left out, equal vertices joined, triangles without area dropped. \param up auto: turned so that
/// z points up: glTF and IFC from y, COLLADA from what it says; files of other
///        formats stay as they are. x, y or z: the file's own axes, whatever it says of them.
///        COLLADA and IFC come in metres, others in their own units.
/// \throws FormatError: nothing that assimp reads, no triangles, NaN; std::system_error if the file
///         cannot be opened
std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const std::string& up);

/// A node that a part hangs on.
struct MeshNode {
    std::string name;
    double height = 0;  ///< of its origin, as the vertices
};

/// What hangs on one node.
struct MeshPart {
    std::vector<MeshNode> nodes;  ///< the part's own first, the root last
    TriangleMesh mesh;            ///< in the world; without digest
};

/// The same node by node, for files whose nodes tell what they are. \throws as loadMesh
std::vector<MeshPart> loadMeshParts(const std::string& path, const std::string& up);

}  // namespace ispace
