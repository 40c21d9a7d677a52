// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/meshes: meshes (OBJ, STL, PLY, COLLADA, glTF) and point clouds (PCD, LAS, PLY)
// become records and rooms. A confined program, lib/ispace/read-mesh, parses the meshes.
#pragma once

#include <string>
#include <string_view>

#include "io/importers.h"

namespace ispace::meshes {

/// The option --up; importers find it in ImportOptions::own.
struct UpAxis {
    std::string name = "auto";  ///< or x, y, z: the axis that points upwards
};

/// Returns a document of one `mesh` record that names the operand, not loaded; its id comes from
/// the file's name. \throws FormatError for "-": records need a name, and other files may belong to
/// it
Document meshDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas);

/// Reads the plan in the cut through a mesh of a room or building at ImportOptions::slice_walls, a
/// height after the unit and UpAxis: cuts become walls, solids that meet become one, and the room
/// is chosen by chooseRooms(). Lines are simplified by at most a millimetre unless
/// ImportOptions::simplify says otherwise. \throws FormatError if the mesh does not reach this
/// height, and as meshDocument and loadMesh
Document readMeshWalls(const std::string& operand, const ImportOptions& options,
                       const Schemas& schemas);

/// Reads the plan in a point cloud (see CloudFile): cells of ImportOptions::resolution (default 5
/// cm) with points between slice_walls and slice_top are walls, and the room is chosen among the
/// others as in writeCellMap(). Gaps between points are closed as little as it takes to enclose a
/// room, at most 1.2 m, unless `close_gaps` says otherwise. Islands that end below slice_top become
/// cubes and cylinders, or noise. \throws FormatError: no heights, no points between them, no room
Document readPointCloud(std::string_view bytes, const std::string& name,
                        const ImportOptions& options, const Schemas& schemas);

/// Adds the rows of meshes and point clouds, and the reader of mesh files: OBJ, STL, PLY, COLLADA,
/// glTF and GLB, by content, else by suffix. The separate program has bounds on memory and time and
/// no rights; a file that makes it crash, grow or hang is an ordinary bad file.
void addMeshes();

}  // namespace ispace::meshes
