// SPDX-License-Identifier: GPL-3.0-or-later
// Options that several tools share, declared once: -o and its kin, cells, zones, formats, limits.
//
//     CommonOptions common;
//     addCommonOptions(line, common, "file of the layout (default: stdout)");
//     line.parse(argc, argv);
//     limitThreads(common.threads);
//     warn(common, "arrange", input.warnings);
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/command_line.h"
#include "cli/operands.h"
#include "coverage/target.h"
#include "scene/devices.h"

namespace ispace {

/// Options that every tool has.
struct CommonOptions {
    std::string output = "-";
    bool quiet = false;
    int verbose = 0;
    int threads = 0;  ///< 0: all cores this process may use
    std::uint64_t seed = 0;
    std::string errors = "text";  ///< parse() has selected the form already
    std::optional<bool> progress;
    DependencyOptions dependencies;
    /// Receives warnings and notes; empty: they go to stderr.
    std::function<void(const Diagnostic&)> messages = {};
};
/// Declares -MD -MF -o -q -v -j --seed --errors --progress; `output_help` describes the product; if
/// empty there is no -o, -MD and -MF.
void addCommonOptions(CommandLine& line, CommonOptions& options, const std::string& output_help);

/// Prints `text` on stderr with -v and without -q.
void logInfo(const CommonOptions& options, const std::string& tool, const std::string& text);

/// Prints a sentence on stderr unless -q is given.
void report(const CommonOptions& options, const std::string& tool, const std::string& sentence);

/// Prints each warning on stderr unless -q is given.
void warn(const CommonOptions& options, const std::string& tool,
          std::span<const Diagnostic> warnings);

/// The same for a sentence.
void warn(const CommonOptions& options, const std::string& tool, const std::string& sentence);

/// The same for sentences: the first 20, and the number of further ones.
void warn(const CommonOptions& options, const std::string& tool,
          std::span<const std::string> sentences);

/// Returns the result of `read`; prefixes its UsageError with the option's name.
template <typename Read>
auto ofOption(const std::string& name, const Read& read) {
    try {
        return read();
    } catch (const UsageError& error) {
        throw UsageError(name + ": " + error.what());
    }
}

/// Limits the number of worker threads of the process to `threads` from now on (0: the least of the
/// cores of the affinity mask, cpuQuota() and SLURM_CPUS_PER_TASK), and to the number that the
/// system grants. 1 starts no thread. Without a limit of time results do not depend on it.
void limitThreads(int threads);

/// Returns the folder of devices and scenes: `../share/ispace` beside the folder of the running
/// program.
std::string shareFolder();

/// Returns the devices there, read on the first call, once for the process.
/// \throws as loadDevices
const DeviceCatalogue& shippedDevices();

/// Likewise, but empty if no record names a model: reading them takes longer than a small room.
const DeviceCatalogue& devicesFor(std::initializer_list<const Document*> documents);
const DeviceCatalogue& devicesFor(std::span<const Document* const> documents);
/// For values of --sensor: empty if all name bare kinds.
const DeviceCatalogue& devicesForSensors(std::span<const std::string> specs);

/// Returns the suffix of a file's name without its dot, in lower case, "yaml" for "yml"; "" for
/// streams, folders and names without one.
std::string suffixOf(const std::string& output);

/// Returns "a, b or c".
std::string listOf(const std::vector<std::string>& words);

/// Refers to --report for a product whose suffix is that of a page: `-o r.html`.
/// \throws UsageError for such a product
void referToReport(const std::string& output);

/// The usual suffix of a format if it differs from the name: {"log", "carmen"}; "": it has no
/// suffix.
struct SuffixOf {
    std::string suffix, format;
};

/// Returns the format of a product: `to` if given, else the one with a name or usual suffix equal
/// to the suffix of `output`, in any case; without a suffix the first of `known`. \param to empty
/// for a product without --to \throws UsageError for any other suffix
std::string outputFormat(const std::optional<std::string>& to, const std::string& output,
                         const std::vector<std::string>& known,
                         const std::vector<SuffixOf>& others = {});

/// Rejects binary data for a terminal. \throws UsageError
void refuseTerminal(const std::string& output, const std::string& what);

/// The values of --grid and --cell.
struct CellWords {
    std::optional<CellCount> grid;
    std::optional<double> cell;

    /// Returns nullopt if neither is given. \throws UsageError for both
    [[nodiscard]] std::optional<CellChoice> choice() const;
};
/// Declares `--grid P[,Q]`, at most 10 000 a side, and `--cell M`; `purpose` of the cells, for
/// help.
void addCellOptions(CommandLine& line, CellWords& words, const std::string& purpose);

/// `--density N
/// NAME`: pixels per metre that a camera must have; unchanged without it.
void addDensityOption(CommandLine& line, double& pixels_per_metre);

/// `--same-environment`, `--any-environment`, `--include-files` and `--max-work`.
void addSceneRules(CommandLine& line, SceneRules& rules);

/// Returns the rules that differ from their defaults and are in no history, as options.
std::string readingText(const SceneRules& rules);

/// Returns the beginning of an envc command that changes the scene of these operands: "envc
/// room.env layout.3dm --storey upper".
std::string editCommand(const std::vector<std::string>& operands, const SceneRules& rules);
/// Returns a command of envc with further edits, which writes the changed scene: "envc room.env
/// layout.3dm --rotate l1:35 -o changed.env".
std::string commandOf(std::string command, std::span<const Edit> edits);

/// `--storey`. \param without the effect of leaving it out, for help
void addStoreyOption(CommandLine& line, SceneRules& rules, const std::string& without);

/// Parses `500M`, `2G`, `1.5GB`: powers of 1024, any case. \throws UsageError
std::uint64_t byteCount(const std::string& text);

/// Returns `16G`, `512M`, or the number of bytes: the largest unit that leaves a whole number.
std::string byteCountText(std::uint64_t bytes);

}  // namespace ispace
