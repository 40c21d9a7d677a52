// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions contributes, in one value of functions. The classes they make are
// only declared here: an extension includes the headers of its own groups and no others.
//
// Each folder defines one function in its extension.cc, in the namespace `extension`:
//
//     namespace ispace::extension {
//     Extension doorcounters() { return {.name = "doorcounters", .add = addDoorCounters}; }
//     }
//
// tools/extensions.cc lists these functions. No other file of the core or of the tools names an
// extension. A build without an extension still knows the names that it would offer
// (offers.txt in each folder): a user that asks for one is told which extension has it.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "server/role_maker.h"

namespace ispace {

class ArrangeGroup;
class BridgeGroup;
class BuildingWorlds;
class CoverageGroup;
class DrawingGroup;
class ImportGroup;
class JudgeGroup;
class ObjectiveGroup;
class OptionGroup;
class ProofGroup;
class RecordGroup;
class ReportGroup;
struct BuildingRunOptions;
struct Diagnostic;
struct SiteScene;

/// The options of an extension in one tool.
struct ToolOptions {
    std::string_view tool;  ///< "scan"
    std::unique_ptr<OptionGroup> (*make)() = nullptr;
};

/// The runs of buildings that an extension brings, as functions.
struct BuildingRuns {
    /// \throws FormatError for scenes, records and trips that keep a run from beginning
    std::unique_ptr<BuildingWorlds> (*open)(const SiteScene& building,
                                            const BuildingRunOptions& options) = nullptr;
    /// Returns findings about what joins the storeys that concern runs alone.
    std::vector<Diagnostic> (*findings)(const SiteScene& building) = nullptr;
    /// The extension, filled in by Extensions; it names one that the build lacks if `open` is null.
    std::string_view extension = {};
};

/// A contribution. All but the name may be left out.
struct Extension {
    std::string_view name;  ///< of its folder
    /// Adds its rows to the tables of the library: importers, records, kinds of sensors, lines
    /// of scripts. It is called once, before the first input is read, by one thread: later the
    /// tables are read without locks.
    void (*add)() = nullptr;
    std::vector<ToolOptions> options = {};  ///< at most one for each tool
    std::vector<std::unique_ptr<ObjectiveGroup> (*)()> objectives = {};  ///< of `arrange`
    std::unique_ptr<ArrangeGroup> (*arrange)() = nullptr;    ///< rules of layouts of `arrange`
    std::unique_ptr<CoverageGroup> (*coverage)() = nullptr;  ///< of reports of `coverage`
    std::unique_ptr<ImportGroup> (*import)() = nullptr;      ///< of importers, of `envc`
    std::unique_ptr<RecordGroup> (*record)() = nullptr;      ///< of records of `simrun`
    std::unique_ptr<ReportGroup> (*report)() = nullptr;      ///< files of `--report`
    std::unique_ptr<DrawingGroup> (*drawing)() = nullptr;    ///< of a record, `simrun -o`
    std::unique_ptr<ProofGroup> (*proof)() = nullptr;        ///< of `arrange --proof`
    std::unique_ptr<JudgeGroup> (*judge)() = nullptr;        ///< of runs of `simrun`
    std::unique_ptr<BridgeGroup> (*bridge)() = nullptr;      ///< another protocol of a run
    MakeRoleService role = nullptr;                          ///< requests of the protocol
    BuildingRuns buildings = {};                             ///< of one extension at most
};

}  // namespace ispace
