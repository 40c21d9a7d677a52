// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/site: the rooms that every tool reads, one alone or several above each other, and what
// joins them. It owns the scenes, one for each storey; no code below it knows of storeys. Uses
// report and below.
//
// A building is a site of N rooms; a room alone is a site of one with an empty id, whose figures,
// reports and messages are those of the room. storeys.h reads and writes buildings,
// site_scene.h makes scenes of them, coupling.h says how they see each other, site_coverage.h and
// arranged_site.h measure and arrange them. An extension runs them (cli/building_runs.h).
//
// Lengths are metres, z is up. Storeys are sorted by the heights of their floors; equal rooms are
// read once and shared by pointer, which later saves scenes, views and figures.
//
//     const StoreyedDocument building = readBuilding(bytes, "house.yaml", options);
//     for (const Storey& storey : building.storeys) print(storey.id, storey.floor);
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/budget.h"
#include "geom/pose.h"
#include "io/importers.h"
#include "record/record.h"

namespace ispace {

/// A storey of a building. Its room has a frame of its own, in which its floor lies at z = 0.
struct Storey {
    Record record;  ///< of the keyword `storey`, without `file`
    std::string id;
    Pose2 building_from_storey;
    double floor = 0;              ///< height of its floor in the building, metres
    std::optional<double> height;  ///< up to the floor above, metres; empty: not given
    /// Names of files in its records are relative to the folder of the building. Storeys of equal
    /// files share it.
    std::shared_ptr<const Document> room;

    /// Returns "ID: ", the beginning of a message about it; "" for a room alone, which has no id.
    [[nodiscard]] std::string prefix() const { return id.empty() ? "" : id + ": "; }
};

/// Stairs, a lift or a shaft, in the coordinates of the building.
struct StoreyPassage {
    Record record;
    std::string id;
    std::vector<std::size_t> storeys;  ///< indices in StoreyedDocument::storeys, lowest first
    double capacity = kNoLimit;        ///< greatest load of a lift, in kilograms

    static constexpr double kNoLimit = std::numeric_limits<double>::infinity();
};

/// Most storeys of a building.
constexpr std::size_t kMaxStoreys = 200;

/// A building as files hold it.
struct StoreyedDocument {
    History history;
    std::vector<Storey> storeys;          ///< lowest first, in the order of the file where level
    std::vector<StoreyPassage> passages;  ///< in the order of the file
    std::vector<std::string> sources;     ///< files read besides the operand
    std::vector<std::string> notes;
    std::vector<Diagnostic> warnings;

    /// Returns the digest of the rooms' environments and of all that joins them, of a room alone
    /// that of its environment.
    [[nodiscard]] std::string digest() const;
    /// Returns true for a room alone: a site of one room with an empty id.
    [[nodiscard]] bool isRoomAlone() const {
        return storeys.size() == 1 && storeys.front().id.empty();
    }
    /// Returns the ids, lowest first, as "ground, upper".
    [[nodiscard]] std::string storeyList() const;
    /// Finds a storey by its id, else by its name, else by either in any case. \throws UsageError
    /// with the nearest id
    [[nodiscard]] const Storey& storey(const std::string& called) const;
};

/// Returns true if a word is the id of a storey or its name, in any case. \param name "": none
bool callsStorey(const std::string& word, const std::string& id, const std::string& name);

/// Returns the storeys with this id or name, or with ids of this glob, by index. \throws UsageError
/// if there is none
std::vector<std::size_t> storeysNamed(const StoreyedDocument& building, const std::string& name);

/// The storeys that a text is about, and the rest of it.
struct StoreyText {
    std::vector<std::size_t> storeys;
    std::string text;
};
/// Splits `STOREY/TEXT`, where STOREY is the id or name of a storey, or a glob of ids; a text
/// without a slash is about all storeys. \param option for messages \throws UsageError for a storey
/// that does not exist
StoreyText splitStoreys(const StoreyedDocument& building, std::string_view option,
                        const std::string& text);

/// Returns true for a building: records or YAML with a storey, a compiled building, or a site of
/// Open-RMF. O(bytes), without reading files
bool isBuilding(std::string_view bytes);

/// Reads a building and the rooms of its storeys.
///
/// In YAML, `records` of a storey holds its room inline, in the forms of readYaml(); an alias
/// stands for an equal room. Files of storeys must lie in the folder of the building or below
/// unless ImportOptions::includes allows others; equal files are read once. \throws FormatError
/// with all findings: storeys without a room or with two, unknown storeys, and
///         as the readers of the rooms
StoreyedDocument readBuilding(std::string_view bytes, const std::string& operand,
                              const ImportOptions& options);

/// A storey record and its room.
struct StoreyInput {
    Record record;
    std::shared_ptr<const Document> room;
};
/// Joins storeys and what connects them, with the notes and warnings of the rooms. \throws
/// FormatError with all findings, which name `file` as a whole where records have no location
StoreyedDocument makeBuilding(std::vector<StoreyInput> inputs, std::vector<Record> passages,
                              const std::string& file);

/// Reads the records of a building in YAML, and the rooms inline. \param work of the building
/// \param rooms has an entry for each record; null: not inline
std::vector<Record> readBuildingYaml(std::string_view bytes, const std::string& operand,
                                     const ImportOptions& options, Budget& work,
                                     std::vector<std::shared_ptr<const Document>>& rooms);

/// Writes a building as YAML with its rooms inline; equal rooms are aliases. \param compiled
/// records of meshes name their content by digest
std::string writeBuildingYaml(const StoreyedDocument& building, bool compiled = false);

/// A file of a building, by its name relative to that of the building.
struct BuildingPart {
    std::string name, bytes;
};
/// Writes a building as records: the files of its rooms, STEM-ID.env, then the building itself,
/// whose name is "". Equal rooms share a file. \param stem name of the building without suffix
std::vector<BuildingPart> writeBuildingRecords(const StoreyedDocument& building,
                                               const std::string& stem);

}  // namespace ispace
