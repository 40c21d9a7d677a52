// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// Reads the plan that a mesh of a room or a building is at ImportOptions::slice_walls, a height of
/// the mesh after `units` and `up`: what the cut meets becomes walls, solids that meet one, and
/// the room is chosen as readDxf does. Lines lose points that are within a millimetre of the
/// straight, unless ImportOptions::simplify says otherwise.
/// \throws FormatError: nothing stands at this height, and as meshDocument and loadMesh
Document readMeshWalls(const std::string& operand, const ImportOptions& options,
                       const Schemas& schemas);

/// True for the text of a STEP file with a schema of IFC.
bool isIfc(std::string_view bytes);

/// Reads a storey of an IFC building, through assimp: walls, columns and what else stands like them
/// are cut 1.2 m above the lowest storey that has walls, or at ImportOptions::slice_walls (the
/// building's own height); the classes of IFC are layers. By default IfcWall, IfcCurtainWall,
/// IfcColumn, IfcPlate, IfcMember, IfcBuildingElementProxy and their kinds are walls, IfcDoor and
/// IfcWindow doors and windows, across the width they have in the cut. Openings of walls are cut
/// out by assimp. \throws FormatError: cut off, nothing stands at this height, and as loadMesh
Document readIfc(std::string_view bytes, const std::string& operand, const ImportOptions& options,
                 const Schemas& schemas);

}  // namespace ispace
