// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
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
    std::optional<bool> progress;
    DependencyOptions dependencies;
};
/// Declares -MD -MF -o -q -v -j --seed --progress; `output_help` describes the product; if empty
/// there is no -o, -MD and -MF.
void addCommonOptions(CommandLine& line, CommonOptions& options, const std::string& output_help);

/// Prints `text` on stderr with -v and without -q.
void talk(const CommonOptions& options, const std::string& tool, const std::string& text);

/// Prints each sentence on stderr unless -q is given.
void tell(const CommonOptions& options, const std::string& tool,
          std::span<const std::string> sentences);

/// Prints each warning on stderr unless -q is given.
void warn(const CommonOptions& options, const std::string& tool,
          std::span<const Diagnostic> warnings);

/// The same for a sentence.
void warn(const CommonOptions& options, const std::string& tool, const std::string& sentence);

/// The same for sentences: the first 20, and the number of further ones.
void warn(const CommonOptions& options, const std::string& tool,
          std::span<const std::string> sentences);

/// What `read` returns; the option's name is put before what it throws (UsageError).
template <typename Read>
auto ofOption(const std::string& name, const Read& read) {
    try {
        return read();
    } catch (const UsageError& error) {
        throw UsageError(name + ": " + error.what());
    }
}

/// Keeps the number of worker threads of the process down to `threads` from now on (0: the least of
/// the cores of the affinity mask, cpuQuota() and SLURM_CPUS_PER_TASK), and to what the system
/// grants. 1 starts no thread.
void limitThreads(int threads);

/// Folder of devices and scenes: `../share/ispace` beside the folder of the running program.
std::string shareFolder();

/// The devices there, read when first asked for, once for the process.
/// \throws as loadDevices
const DeviceCatalogue& shippedDevices();

/// The same, but none where no record names a model: to read them takes longer than a small room.
const DeviceCatalogue& devicesFor(std::initializer_list<const Document*> documents);
/// For values of --sensor: none where all name bare kinds.
const DeviceCatalogue& devicesForSensors(std::span<const std::string> specs);

/// The suffix of a file's name without its dot, in lower case, "yaml" for "yml"; "" for streams,
/// folders and names without one.
std::string suffixOf(const std::string& output);

/// "a, b or c"
std::string listOf(const std::vector<std::string>& words);

/// The usual suffix of a format whose name is another: {"log", "carmen"}; "": none.
struct SuffixOf {
    std::string suffix, format;
};

/// Format of a product: `to` if given, else the one whose name or usual suffix is the suffix of
/// `output`, in any case; without a suffix the first of `known`. \param to nothing for a product
/// without --to \throws UsageError for any other suffix
std::string outputFormat(const std::optional<std::string>& to, const std::string& output,
                         const std::vector<std::string>& known,
                         const std::vector<SuffixOf>& others = {});

/// Refuses binary data for a terminal. \throws UsageError
void refuseTerminal(const std::string& output, const std::string& what);

/// The values of --grid and --cell.
struct CellWords {
    std::optional<CellCount> grid;
    std::optional<double> cell;

    /// Nothing where neither is given. \throws UsageError for both
    [[nodiscard]] std::optional<CellChoice> choice() const;
};
/// Declares `--grid P[,Q]`, at most 10 000 a side, and `--cell M`; `purpose` of the cells, for
/// help.
void addCellOptions(CommandLine& line, CellWords& words, const std::string& purpose);

/// `--density N|NAME`: pixels a metre that a camera needs; left alone without it.
void addDensityOption(CommandLine& line, double& pixels_per_metre);

/// `--same-environment`, `--any-environment`, `--include-files` and `--max-work`.
void addSceneRules(CommandLine& line, SceneRules& rules);

/// `500M`, `2G`, `1.5GB`: powers of 1024, any case. \throws UsageError
std::uint64_t byteCount(const std::string& text);

/// `16G`, `512M`, or the number of bytes: the largest unit that leaves a whole number.
std::string byteCountText(std::uint64_t bytes);

}  // namespace ispace
