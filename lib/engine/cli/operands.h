// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the files that a command names: ENV and LAYOUT of a room, or any number of inputs as one.
//
// ENV and LAYOUT are told apart by content, so their order is free; "-" is stdin, which is read
// once. A layout knows the digest of its environment: another one is an error or a warning, as
// SceneRules says. Files that records name are read by the rules of `includes`, with bounded work
// (Budget), since inputs are untrusted. Errors are UsageError for the command, FormatError with
// file, line and column for data, std::system_error for the system.
//
//     const SceneInput input = readScene({.operands = {"room.env", "layout.3dm"}});
//     warnOfImport(common, "scan", input);
//     use(input.scene);
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "io/importers.h"
#include "io/storey_choice.h"
#include "record/record.h"
#include "record/yaml/yaml.h"
#include "scene/run/run_changes.h"
#include "scene/scene.h"

namespace ispace {

/// Rules for references from the files of a scene to other files.
struct SceneRules {
    /// If a layout records another digest than that of the environment: an error (true) or accepted
    /// (false). Unset: a warning if the environment is an operand, an error if the layout's record
    /// names it.
    std::optional<bool> same_environment = {};
    IncludeFiles includes = IncludeFiles::InFolder;
    std::optional<std::uint64_t> max_work = {};  ///< of each input, see Budget; unset: by its size
    StoreyChoice storeys = {};                   ///< of --storey
};

/// Returns the changes that clients made to the world of a recorded run, which began in a scene.
/// \throws FormatError if events.csv holds no events
RunChanges changesOfRun(const std::string& folder, const Scene& start,
                        std::optional<std::uint64_t> max_work);

struct CommonOptions;

/// Request of a tool that takes `ENV [LAYOUT]`.
struct SceneRequest {
    std::vector<std::string> operands;  ///< at most two, in any order; recognised by content
    /// Warnings of the digest go to environment.warnings.
    SceneRules rules = {};
    /// Read LAYOUT from stdin if ENV holds no placed sensor, or without operands (scan and
    /// coverage); otherwise a missing operand is a usage error (arrange).
    bool layout_from_stdin = true;
    /// An ENV with a placed sensor of such a kind needs no LAYOUT.
    bool (*is_meant)(const SensorKind&) = [](const SensorKind& kind) { return kind.perceives; };
    /// A room beside that of the operands, of which --storey says something only if it is a
    /// building.
    bool is_further = false;
};

/// Content of the operands.
struct SceneInput {
    Scene scene;
    Document environment;
    std::optional<Document> layout;
    std::string environment_operand;  ///< "-" for stdin; found through LAYOUT if left out
    std::string layout_operand;       ///< "" without LAYOUT
    /// For history lines: the operands given, and "-" if stdin was read without one.
    std::vector<std::string> named;
    std::vector<Diagnostic> choices;  ///< of importers, see ImportReport
    std::string storey = {};          ///< id of the storey that it is; "" for a room that is none
    std::string storey_name = {};     ///< its name; "" without one, or if it calls another
};

/// Prints the warnings and choices of importers on stderr unless -q is given.
void warnOfImport(const CommonOptions& options, const std::string& tool, const SceneInput& input);

/// Adds the zones of --zone to the scene, as records. \throws UsageError as readZones()
void addZones(std::span<const std::string> zones, SceneInput& input);

/// Parses the ZONE=W of --weight. \throws UsageError
std::pair<std::string, double> splitWeight(const std::string& text);

/// Returns the files that a scene was read from, the operands first; for -MD.
std::vector<std::string> filesOf(const SceneInput& input);

/// Reads and joins ENV and LAYOUT by the rules of operands.
/// \throws UsageError for missing or doubled operands, two uses of stdin and a terminal as stdin;
///         FormatError, std::system_error as the readers do, and for a digest that differs
SceneInput readScene(const SceneRequest& request);

/// A room with a layout that is compared with another one. Keeps references.
struct LaidRoom {
    const Document& environment;
    const Scene& scene;
    const std::vector<std::string>& named;  ///< as SceneInput::named
    const std::string& environment_operand;
};
/// The scene of another layout in the same environment.
struct OtherLayout {
    Scene scene;
    std::vector<std::string> files;  ///< that it was read from, for -MD
    std::vector<Diagnostic> warnings;
};
/// Reads it from `operand`, which may be - if stdin was not read yet. \throws as readScene, and
/// FormatError if it is no layout
OtherLayout readOtherLayout(const LaidRoom& room, const std::string& operand,
                            const SceneRules& rules);

/// \throws UsageError if two of these files are stdin
void mustReadStdinOnce(const std::vector<std::string>& files);

/// Reads all of stdin unless it is a terminal. \throws UsageError
std::string readStdin();
/// Reads a file, or stdin for "-". \throws as readStdin() and readAll()
std::string readOperand(const std::string& operand);
/// Reads a stream in the same way, and leaves it to the next readOperand() of the same name.
const std::string& peekStream(const std::string& operand);

/// Returns `file=` of an `environment` record in a layout written to `output`: the path of ENV
/// relative to its folder, never absolute; "" if ENV came from a stream.
std::string environmentFileFor(const std::string& output, const std::string& environment_operand);

/// Request of a tool that reads any number of environments and layouts as one.
struct InputRequest {
    std::vector<std::string> inputs;  ///< "-" for stdin
    ImportOptions import;
    std::vector<Record> added;  ///< by edits; importers of plans require them
    bool compiles = true;       ///< the environment of layouts is read, and digests are compared
    std::optional<bool> same_environment = {};  ///< as in SceneRules
    bool may_be_empty = false;  ///< an empty stdin is an environment without records
};

/// The bytes of an input.
struct RawInput {
    std::string name, bytes;
    bool is_plan = false;
};
std::vector<RawInput> readRawInputs(const InputRequest& request);

/// Joins all inputs: environments in their order, then layouts: their records replace those with
/// the same id. If only layouts are given and `compiles` is set, the environment that they name is
/// read, too. File names are relative to the current folder; history, notes, warnings and sources
/// are joined. \param other_rooms gets a warning for each layout with another digest and is no
/// error \throws as parseDocument; FormatError for doubled ids and for a digest that must not
/// differ
Document readInputs(const std::vector<RawInput>& raw, const InputRequest& request,
                    std::vector<Diagnostic>& other_rooms);

/// Rewrites file names in the records from relative to `from` to relative to `to`; "" is the
/// current folder. Absolute names stay.
void rebaseFiles(std::vector<Record>& records, const std::string& from, const std::string& to);

}  // namespace ispace
