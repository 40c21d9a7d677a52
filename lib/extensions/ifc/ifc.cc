// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of IFC, and the program that reads its files.
#include "extensions/ifc/ifc.h"

#include <stdexcept>

#include "base/confined.h"
#include "base/error.h"
#include "base/number.h"
#include "extensions/ifc/ifc_zip.h"
#include "extensions/ifc/reader/building.h"
#include "extensions/ifc/reader/building_limits.h"
#include "extensions/ifc/reader/step_file.h"
#include "io/packed_mesh.h"

namespace ispace::ifc {

namespace {

/// Returns true if a file has two or more instances of a type. \param type in capitals
bool hasSeveral(std::string_view bytes, std::string_view type) {
    int count = 0;
    for (std::size_t at = bytes.find(type); at != std::string_view::npos && count < 2;
         at = bytes.find(type, at + type.size())) {
        const std::size_t next = bytes.find_first_not_of(" \t\r\n", at + type.size());
        if (next != std::string_view::npos && bytes[next] == '(') ++count;
    }
    return count == 2;
}

/// Returns true for one building of which more than one storey may have rooms. Buildings side by
/// side are no site: their storeys lie beside each other.
bool mayHaveStoreys(std::string_view bytes) {
    if (bytes.starts_with("PK")) return true;  // known once unpacked
    return hasSeveral(bytes, "IFCBUILDINGSTOREY") && !hasSeveral(bytes, "IFCBUILDING");
}

/// Reads the surfaces of all products, for `mesh` records.
TriangleMesh readSurfaces(const MeshSource& source) {
    return unpackedMesh(readConfined({.name = source.path,
                                      .program = "read-building",
                                      .arguments = {"mesh", ""},
                                      .file = source.main.file.fd(),
                                      .bytes = source.main.size,
                                      .limits = meshLimits,
                                      .work = &source.work,
                                      .kind = "mesh file",
                                      .reader = "its reader",
                                      .subject = "buildings are",
                                      .hint = "; is it installed?"}),
                        source.path);
}

}  // namespace

Building readBuildingInChild(std::string_view bytes, const std::string& name,
                             std::optional<double> slice, Budget& work) {
    const OpenFile copy = fileInMemory(bytes);
    const std::string answer =
        readConfined({.name = name,
                      .program = "read-building",
                      .arguments = {"building", slice ? formatDouble(*slice) : ""},
                      .file = copy.fd(),
                      .bytes = bytes.size(),
                      .limits = buildingLimits,
                      .work = &work,
                      .kind = "IFC file",
                      .reader = "its reader",
                      .subject = "buildings are",
                      .hint = "; is it installed?"});
    try {
        return unpackedBuilding(answer);
    } catch (const std::runtime_error& error) {
        failFile(name, std::string("bad IFC file: ") + error.what());
    }
}

void addIfc() {
    static constexpr Importer kImporters[] = {
        {"IFC", true, [](const ImportSource& source) { return isIfc(source.bytes); },
         [](const ImportSource& source) {
             return readIfc(source.bytes, source.operand, source.options, source.schemas);
         },
         true},
    };
    static constexpr BuildingImporter kBuildings[] = {{isIfc, mayHaveStoreys, readIfcBuilding}};
    static constexpr MeshReader kMeshReaders[] = {{{}, beginsAsStep, readSurfaces}};
    static constexpr ExportFormat kExporters[] = {
        {.name = "ifc",
         .suffix = "ifc",
         .help = "A building of one storey in IFC4, in metres and degrees: walls with their "
                 "openings, doors and windows, rooms and zones as spaces with areas, furniture, "
                 "pillars and other objects, and the sensors (IfcSensor; cameras as "
                 "IfcAudioVisualAppliance) with a property set ispace_Sensor of Model, Height, "
                 "Heading, Tilt, Roll, FieldOfView, FieldOfViewVertical and Range. Rooms end at "
                 "the faces of walls; walls without thickness become 5 mm thick. envc skips "
                 "robots, people and their sensors, and a warning reports their number. GUIDs "
                 "depend on the records alone, and the file has no date.",
         .write = [](const Scene& scene, const Document& /*document*/,
                     const ExportOptions& options) { return writeIfc(scene, options.title); }},
    };
    addImporters(kImporters);
    addBuildingImporters(kBuildings);
    addMeshReaders(kMeshReaders);
    addExporters(kExporters);
}

}  // namespace ispace::ifc
