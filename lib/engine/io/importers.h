// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/io: rooms in and out. One importer per foreign format, a row: how it is recognised,
// and the records that it becomes. importers.cc holds the rows of the core, addImporters() adds
// those of extensions. The writers are in exporters.h.
//
// Inputs are untrusted. A reader bounds its work by a Budget in units that do not depend on the
// machine, and fails with FormatError that names file and line; it never guesses in silence:
// choices are notes, doubts warnings. The same files and options give the same records, with
// coordinates in whole micrometres for plans.
//
//     ImportOptions options;
//     options.units = "mm";
//     const Document room = readDocument("plan.dxf", options, sceneSchemas());
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/budget.h"
#include "drawing/plan/found_rooms.h"
#include "geom/polygon.h"
#include "geom/pose.h"
#include "io/own_options.h"
#include "record/record.h"
#include "record/yaml/yaml.h"

namespace ispace {

/// Plans may reach this far from the origin, in metres; records end at 1000 km.
constexpr double kMaxPlanCoordinate = 900'000;

/// Which of the closed regions of a plan or map are imported.
enum class RoomChoice {
    Largest,  ///< the largest that is neither the outside nor a hollow wall
    All,      ///< every closed room
};

/// Messages of an import besides its document.
struct ImportReport {
    std::vector<Diagnostic> choices;  ///< notes, always shown
    std::vector<Diagnostic> doubts;   ///< warnings that only a check reports
    bool has_storeys = false;         ///< an input is a building with storeys

    void addChoice(const std::string& operand, const std::string& sentence);
    /// Appends the messages of another report.
    void add(ImportReport other);
};

class MeshFiles;

/// Options for importing plans, maps and meshes of other programs.
struct ImportOptions {
    double wall_height = 2.5;   ///< metres, of walls in plans without heights
    double wall_thickness = 0;  ///< metres, of lines in plans; 0: the line is the face
    RoomChoice rooms = RoomChoice::Largest;
    std::vector<Point2> inside;         ///< points in the rooms to keep; override `rooms`
    std::vector<Point2> known_inside;   ///< the same, from `inside` records of other inputs
    std::vector<Segment2> known_walls;  ///< walls that edits or other inputs add
    std::optional<double> close_gaps;   ///< metres up to which gaps between walls are closed;
                                        ///< default: the least that encloses a room
    std::optional<double> reachable;    ///< radius of a disc that must be able to reach the floor
    std::optional<double> resolution;   ///< metres per pixel of a picture without map.yaml
    Pose2 origin;                       ///< of the lower left corner of such a picture
    std::optional<double> slice_walls;  ///< height at which a mesh of a building is cut into walls
    std::optional<double> slice_top;    ///< points from slice_walls up to this height are walls
    std::optional<double> snap;  ///< metres within which ends of lines are joined; default depends
                                 ///< on the importer
    std::optional<double> simplify;   ///< metres outlines may move; default depends on the importer
    std::optional<double> clean;      ///< metres: smaller features of a map are noise; 0 keeps all;
                                      ///< default: kNoiseWidth, or 0 if `simplify` is 0
    std::string unknown = "unknown";  ///< or "free": shade 205 of a map, see OccupancyRule
    std::string storey;               ///< of a building, by name or number; "": one is chosen
    std::string units;                ///< m, cm, mm, inch or foot; "": from the file
    std::optional<double> width_is;   ///< metres from a drawing's leftmost to its rightmost wall;
                                      ///< overrides the unit of the file
    std::vector<std::string> wall_layers;    ///< globs; empty: every layer not named otherwise
    std::vector<std::string> door_layers;    ///< globs; default: no layer
    std::vector<std::string> window_layers;  ///< globs; default: no layer
    OwnOptions own;                          ///< of importers of extensions
    WorkLimit max_work;                      ///< see Budget
    IncludeFiles includes = IncludeFiles::InFolder;  ///< of YAML
    FoundRooms* found = nullptr;     ///< receives the rooms of plans, kept or not; may be null
    ImportReport* report = nullptr;  ///< null: choices are notes, doubts are dropped
    bool load_files = true;          ///< false: the files that records name are not read
    MeshFiles* meshes = nullptr;     ///< those that other rooms have read; may be null
};

/// Reads any environment or layout, recognised by content, in the format of the first row that
/// recognises it; meshes without our records become a `mesh` record. Content that fits no format is
/// a mesh if its suffix says so. `operand` is a file name or "-". Loads the files that records name
/// unless ImportOptions::load_files is false. \throws FormatError (also: empty input, or an unknown
/// format, with a hint), std::system_error
Document readDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas);

/// An input, and the options for reading it.
struct ImportSource {
    std::string_view bytes;  ///< without a byte order mark
    const std::string& operand;
    const ImportOptions& options;
    const Schemas& schemas;
};

/// A format that is read: one row, the only mention of it in messages and in the choice of a
/// reader.
struct Importer {
    /// As messages list the formats: "DXF", "a mesh"; "": not listed.
    std::string_view name;
    bool is_plan = true;  ///< rooms are chosen from it, see isPlan()
    bool (*recognises)(const ImportSource& source) = nullptr;
    Document (*read)(const ImportSource& source) = nullptr;
    bool is_confined = false;  ///< read by a program that bounds its own work
    /// Its file's name alone tells it, as .gltf does: tried after all rows that know the content.
    bool by_name = false;
};

/// Returns the row of a format that its bytes alone tell:
/// `importer<isRosMap, readRosMap>("a ROS map")`.
template <bool (*kRecognises)(std::string_view),
          Document (*kRead)(std::string_view, const std::string&, const ImportOptions&,
                            const Schemas&)>
constexpr Importer importer(std::string_view name, bool is_plan = true) {
    return {name, is_plan, [](const ImportSource& source) { return kRecognises(source.bytes); },
            [](const ImportSource& source) {
                return kRead(source.bytes, source.operand, source.options, source.schemas);
            }};
}

/// Adds formats, which are tried after records and before all other formats of the core; a program
/// does so before it reads a file.
void addImporters(std::span<const Importer> importers);

/// Adds a function that returns what the environment of a process adds to the files of an input,
/// such as folders that an importer searches: results that are kept for the same files are for the
/// same texts, too.
void addImportSurroundings(std::vector<std::string> (*surroundings)());
/// Returns the texts of all these.
std::vector<std::string> importSurroundings();

/// States a format that an extension would read, which this program was built without: the error
/// about such a file names the extension. \param sign a suffix (".dxf"), the root of XML ("<sdf"),
/// a key of JSON ("{verts"), or the first bytes; a literal, as the extension's name
void addMissingFormat(std::string_view sign, std::string_view extension);

/// Returns the sentence about a file that a missing extension would read, see addMissingFormat();
/// "" for others.
std::string missingReader(std::string_view bytes, const std::string& operand);

/// Returns true if the bytes are a plan, map or drawing. Its importer chooses rooms, so it requires
/// the walls and inside points of other inputs and edits beforehand (ImportOptions).
bool isPlan(std::string_view bytes, const std::string& operand, const ImportOptions& options,
            const Schemas& schemas);

/// Reads a document like readDocument(), from bytes already read.
Document parseDocument(std::string_view bytes, const std::string& operand,
                       const ImportOptions& options, const Schemas& schemas);

/// Reads the files that records name and have not loaded yet: loadMeshes() and loadCalibrations().
void loadFiles(Document& document, const std::string& operand, const ImportOptions& options);

/// Rejects a file as a whole, or because of one line of it. \throws FormatError
[[noreturn]] void failFile(const std::string& name, const std::string& message, int line = 0);

/// Reads the plan in a picture without map.yaml: pixels are ImportOptions::resolution wide, the
/// lower left corner lies at ImportOptions::origin. Pixels lighter than 80.4 % are free, the
/// default of map_server; mostly transparent ones are unknown. See readRosMap() for the rest.
/// \throws FormatError: no resolution is given, no free pixel, a bad picture
Document readBarePicture(std::string_view bytes, const std::string& name,
                         const ImportOptions& options, const Schemas& schemas);

/// Returns true if the bytes begin like a JSON object or list.
bool isJson(std::string_view bytes);

/// Returns true if the bytes are YAML with the top-level keys `image` and `resolution`.
bool isRosMap(std::string_view bytes);

/// Reads a ROS map (map_server's map.yaml and its picture, see parsePicture); see writeCellMap()
/// for the result. Shade 205 is unknown regardless of `free_thresh`, with a note if the two
/// disagree, or free if ImportOptions::unknown says so. \param name the map.yaml; `image` is
/// relative to its folder (for "-" to the current one) \throws FormatError with the position in
/// YAML or image, std::system_error for a missing image
Document readRosMap(std::string_view yaml, const std::string& name, const ImportOptions& options,
                    const Schemas& schemas);

}  // namespace ispace
