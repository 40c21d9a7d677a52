// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/polygon.h"
#include "geom/pose.h"
#include "plan/found_rooms.h"
#include "record/record.h"
#include "record/yaml.h"

namespace ispace {

/// Plans may reach this far from the origin, in metres; records end at 1000 km.
constexpr double kFarthestPlan = 900'000;

/// Which of the closed regions of a plan or map are imported.
enum class RoomChoice {
    Largest,  ///< the largest that is no outside and no hollow of a wall
    All,      ///< every room that is closed in itself
};

/// What an import has to say besides its document.
struct ImportReport {
    std::vector<std::string> choices;  ///< "FILE: note: …", that people have to know of
    std::vector<Diagnostic> doubts;    ///< warnings that only a check reports
    bool has_storeys = false;          ///< an input is a building with storeys

    void addChoice(const std::string& operand, const std::string& sentence);
};

/// How plans, maps and meshes that somebody else made become records.
struct ImportOptions {
    double wall_height = 2.5;   ///< metres, of walls in plans without heights
    double wall_thickness = 0;  ///< metres, of lines in plans; 0: the line is the face
    RoomChoice rooms = RoomChoice::Largest;
    std::vector<Point2> inside;         ///< points in the rooms to keep; they win over `rooms`
    std::vector<Point2> known_inside;   ///< the same, from `inside` records of other inputs
    std::vector<Segment2> known_walls;  ///< walls that edits or other inputs add
    std::optional<double> close_gaps;   ///< metres up to which gaps between walls are closed;
                                        ///< default: the least that encloses a room
    std::optional<double> reachable;    ///< radius of a disc that has to reach the floor
    std::optional<double> resolution;   ///< metres per pixel of a picture without map.yaml
    Pose2 origin;                       ///< of the lower left corner of such a picture
    std::optional<double> slice_walls;  ///< height at which a mesh of a building is cut into walls
    std::optional<double> slice_top;    ///< of points: those from slice_walls up to here are walls
    std::optional<double> snap;      ///< metres within which ends of lines are joined; default: the
                                     ///< importer's own
    std::optional<double> simplify;  ///< metres outlines may move; default: the importer's own
    std::optional<double> clean;     ///< metres: what is smaller on a map is noise; 0: nothing;
                                     ///< default: kNoiseWidth, or 0 where `simplify` is 0
    std::string unknown = "unknown";  ///< or "free": shade 205 of a map, see OccupancyRule
    std::string storey;               ///< of a building, by name or number; "": see readIfc
    std::string units;                ///< m, cm, mm, inch or foot; "": as the file says
    std::optional<double> width_is;   ///< metres from a drawing's leftmost to its rightmost wall;
                                      ///< wins over what the file says
    std::string up = "auto";          ///< a mesh's upward axis: auto, x, y or z
    std::vector<std::string> wall_layers;    ///< globs; empty: every layer not named otherwise
    std::vector<std::string> door_layers;    ///< globs; default none
    std::vector<std::string> window_layers;  ///< globs; default none
    std::vector<std::string> model_folders;  ///< of SDF, see SdfFiles; relative to the current one
    bool points = false;                     ///< points of an ARIA map become obstacles
    std::optional<std::uint64_t> max_work;   ///< of --max-work, see Budget; default: by the size
    IncludeFiles includes = IncludeFiles::InFolder;  ///< of YAML
    FoundRooms* found = nullptr;     ///< takes the rooms of plans, kept or not; null: not asked for
    ImportReport* report = nullptr;  ///< null: choices are notes, doubts are dropped
    bool load_files = true;          ///< false: records keep the files they name unread
};

/// Reads any environment or layout, recognised by content: GLB, `#env`, `#3dm`,
/// YAML, ROS map YAML, pictures, HouseExpo JSON, ARIA and MovingAI maps, ASCII DXF, SVG, IFC, and
/// meshes, also GLB without our records, which become a `mesh` record. What content does not tell
/// is a mesh if its suffix says so. `operand` is a file name or "-". Loads the files that records
/// name unless ImportOptions::load_files is false. \throws FormatError (also: empty input, or no
/// format we know, with a hint), std::system_error
Document readDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas);

/// True if the bytes are a plan, map or drawing. Its importer chooses rooms, so it must know the
/// walls and inside points of other inputs and edits beforehand (ImportOptions).
bool isPlan(std::string_view bytes, const std::string& operand, const ImportOptions& options,
            const Schemas& schemas);

/// The same as readDocument() for bytes already read.
Document parseDocument(std::string_view bytes, const std::string& operand,
                       const ImportOptions& options, const Schemas& schemas);

/// Reads what records name and do not hold yet: loadMeshes() and loadCalibrations().
void loadFiles(Document& document, const std::string& operand);

/// Refuses a file as a whole, or because of one line of it. \throws FormatError
[[noreturn]] void failFile(const std::string& name, const std::string& message, int line = 0);

}  // namespace ispace
