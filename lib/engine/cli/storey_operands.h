// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings among the operands of a tool: one storey as a room, or all of them. Also records of
// their runs, and products of which each storey has a file (%s in the name is its id).
//
//     if (const auto input = readBuildingInput({operands, options.rules}))
//         for (const Storey& storey : input->building.document.storeys)
//             draw(storey, storeyFile("plan-%s.svg", storey.id));  // plan-ground.svg
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/operands.h"
#include "record/record.h"
#include "site/site_scene.h"
#include "site/storeys.h"

namespace ispace {

/// Returns the room of a storey, for "" that of the only one. \throws UsageError for a missing
/// storey; for "" among several one that names them
Document chosenStorey(const StoreyedDocument& building, const std::string& operand,
                      const std::string& storey);

/// Returns the part of a layout that is about a storey, with plain ids; a layout without ids of
/// storeys is about the storey as a whole. The digest of the building in its `environment` record
/// becomes that of the storey. \throws FormatError as layoutsOf()
Document layoutOfStorey(const Document& layout, const StoreyedDocument& building,
                        const std::string& storey);

/// Returns true for the bytes of a layout, as our tools write it.
bool beginsLayout(std::string_view bytes);
/// Returns true if ids of a layout have storeys before them.
bool namesStoreys(const Document& layout);
/// Returns layoutOfStorey() for the storey whose room has these records; the layout itself if there
/// is none.
Document layoutOfRoom(const Document& layout, const StoreyedDocument& building,
                      std::span<const Record> room);

/// A building and a layout, as operands.
struct BuildingInput {
    SiteScene building;
    std::optional<Document> layout;  ///< as read
    std::string environment_operand, layout_operand;
    std::vector<std::string> named;             ///< as SceneInput::named
    std::vector<std::string> files;             ///< all that were read, for -MD
    std::vector<Diagnostic> warnings, choices;  ///< of importers
};

/// Name of the building in the folder of its run's record, with the scenes of the start.
constexpr const char* kRecordedBuilding = "building.yaml";
/// Returns true for a folder of such a record; false for that of one room, and for none.
bool holdsBuilding(const std::string& folder);
/// Returns the building in a folder of its record; "" for a folder without one, as of one room.
/// \throws as checkRecordFolder() and fileOfRecord()
std::string recordedBuilding(const std::string& folder);

/// \throws UsageError unless the folder holds the record of a run; as checkRecordFolder() \param
/// option for messages
void mustHoldRecord(const std::string& option, const std::string& folder);
/// Returns true for the record of a storey as part of that of a building: its first moment has
/// movers with the storey before their ids. \throws as RunReader
bool recordNamesStorey(const std::string& folder, const std::string& storey);

/// Returns the folder of a storey's record; of a room alone that of the record.
std::string recordOfStorey(const std::string& folder, const Storey& storey);

/// Adds the zones of --zone to the scenes of their storeys, as records: `ground/rect:1,1,2,2`; to
/// a room alone those without a storey.
/// \throws UsageError without a storey, for an unknown one, and as readZones()
void addZones(std::span<const std::string> zones, SiteScene& building);

/// Reads ENV and LAYOUT if ENV is a building, or the storeys of it that are chosen. std::nullopt
/// for others, for one storey that is chosen and for a building of one: they are rooms, which
/// readScene() reads. \throws as readScene() and readBuilding()
std::optional<BuildingInput> readBuildingInput(const SceneRequest& request);

/// Returns true if the name has a mark for the storey's id, %s.
bool isStoreyPattern(std::string_view output);

/// \throws UsageError for -MD, whose rule is for one product, and a pattern
void mustBeOneProduct(const CommonOptions& options);

/// \throws UsageError for a file of all storeys with a mark in its name \param option that names it
void mustBeOneFile(const std::string& option, std::string_view file);

/// Returns the name with the id for each mark.
std::string storeyFile(std::string pattern, const std::string& id);

/// Returns the name of a room's file: for each mark the id of its storey, of a room that is none
/// the name of its file without the suffix ("room" of a stream).
std::string roomFile(const std::string& output, const std::string& storey,
                     const std::string& operand);

/// \throws UsageError unless the output is a pattern, for a format of which a file holds one storey
/// \param suffix of the format's files
void mustNameStoreys(std::string_view output, std::string_view format, std::string_view suffix);

}  // namespace ispace
