// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/ifc: buildings in IFC become rooms, buildings and meshes, and scenes become IFC. A
// confined program, lib/ispace/read-building, parses the files.
#pragma once

#include <string>
#include <string_view>

#include "io/exporters.h"
#include "io/importers.h"
#include "io/mesh_files.h"
#include "site/building_imports.h"

namespace ispace::ifc {

/// Returns true for the text of a STEP file with a schema of IFC.
bool isIfc(std::string_view bytes);

/// Reads a storey of an IFC building (2x3, 4 or 4.3), see chosenStorey(), in a separate process.
///
/// - Walls, curtain walls, plates and members are cut 1 m above the floor, or at
/// ImportOptions::slice_walls (the building's own height). Their faces become closed fences, so
/// that rooms keep their width; holes in walls with their doors and windows become doors and
/// windows through both faces.
/// - Spaces become zones, and the rooms that hold them are kept; without spaces the room is chosen
/// by chooseRooms().
/// - Columns become pillars, furniture, fixtures and stairs boxes and cylinders.
///
/// Warnings count the geometry that is not read. \throws FormatError: cut off, no such storey, and
/// as readBuilding()
Document readIfc(std::string_view bytes, const std::string& operand, const ImportOptions& options,
                 const Schemas& schemas);

/// Reads all storeys of an IFC building that have walls or spaces, see readIfcStoreys().
///
/// A flight of stairs from one of them to the next becomes `stairs`: the file gives the box around
/// it, and the end with free floor before it is the foot. A transport element becomes a `lift` of
/// the storeys with a door before one side of its box; one with a single door is left out.
/// \throws FormatError as readIfc(), if no storey has walls, and if lifts and doors take more than
///         a budget
StoreyedDocument readIfcBuilding(std::string_view bytes, const std::string& operand,
                                 const ImportOptions& options);

/// Writes the room as an IFC4 building of one storey: lines of walls as IfcWall with
/// IfcOpeningElement and the IfcDoor or IfcWindow in it, a slab below each floor, rooms and zones
/// as IfcSpace, furniture, pillars and other things, sensors as IfcSensor and
/// IfcAudioVisualAppliance with the property set `ispace_Sensor`.
///
/// A room is the indoor region without the walls that have a thickness; walls without one become 5
/// mm thick. GUIDs are hashes of the scene's digest, the class and the id. Movers are left out:
/// ExportedFiles::left_out counts them. Equal scenes and titles give equal bytes. O(n log n) for n
/// walls and openings. \param title names the project
ExportedFiles writeIfc(const Scene& scene, const std::string& title);

/// Adds the rows of IFC: an importer, one of buildings, a reader of `mesh` files, an exporter.
void addIfc();

}  // namespace ispace::ifc
