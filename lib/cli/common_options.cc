// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <iterator>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "base/utf8.h"
#include "cli/command_line.h"

namespace ispace {

namespace {

constexpr int kMostThreads = 4096;

/// Cores this process may use: the affinity mask, or less if a batch system says so.
int availableThreads() {
    int threads = tbb::info::default_concurrency();
    const char* const granted = std::getenv("SLURM_CPUS_PER_TASK");
    const auto limit = granted != nullptr ? parseInteger(granted) : std::nullopt;
    if (limit && *limit >= 1 && *limit < threads) threads = static_cast<int>(*limit);
    return threads;
}

}  // namespace

void addCommonOptions(CommandLine& line, CommonOptions& options, const std::string& output_help) {
    if (!output_help.empty()) {
        line.dependencies(options.dependencies, options.output);
        const auto take_output = [&options](const std::string& text) {
            if (text.empty()) throw UsageError("an empty name is given, - is stdout");
            options.output = text;
        };
        line.parsed("-o,--output", "FILE", take_output, output_help, Enters::Nothing);
    }
    line.flag("-q,--quiet", options.quiet, "say nothing but errors", Enters::Nothing);
    line.flag("-v,--verbose", options.verbose, "say more about the work", Enters::Nothing);
    line.count("-j,--threads", "N", options.threads, 0, kMostThreads,
               "worker threads, 0 for all cores; the result does not depend on it",
               Enters::Nothing);
    const auto take_seed = [&options](const std::string& text) {
        const auto seed = parseInteger(text);
        if (!seed || *seed < 0) throw UsageError('`' + text + "` is not a whole number from 0 on");
        options.seed = static_cast<std::uint64_t>(*seed);
    };
    line.parsed("--seed", "N", take_seed, "seed of all random numbers (default 0)",
                Enters::History);
    line.switchFlag("--progress", "--no-progress", options.progress,
                    "show progress of long work on stderr (default: if that is a terminal)",
                    Enters::Nothing);
}

void talk(const CommonOptions& options, const std::string& tool, const std::string& text) {
    if (options.verbose > 0 && !options.quiet) std::cerr << tool << ": " << text << '\n';
}

void warn(const CommonOptions& options, const std::string& tool,
          std::span<const Diagnostic> warnings) {
    if (options.quiet) return;
    for (const Diagnostic& warning : warnings)
        std::cerr << tool << ": " << printable(warning.text()) << '\n';
}

struct ThreadLimit::Data {
    tbb::global_control control;
    explicit Data(std::size_t threads)
        : control(tbb::global_control::max_allowed_parallelism, threads) {}
};

ThreadLimit::ThreadLimit(int threads)
    : data_(std::make_unique<Data>(
          static_cast<std::size_t>(threads > 0 ? threads : availableThreads()))) {}

ThreadLimit::~ThreadLimit() = default;

std::string shareFolder() {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    return (program.parent_path().parent_path() / "share" / "ispace").string();
}

std::string outputFormat(const std::string& to, const std::string& output,
                         const std::vector<std::string>& known) {
    if (!to.empty()) return to;
    std::string suffix = std::filesystem::path(output).extension().string();
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (suffix == ".yml") suffix = ".yaml";
    for (const std::string& format : known)
        if (suffix == '.' + format) return format;
    // A suffix that names another format is a mistake, not a wish for the default.
    constexpr const char* kOthers[] = {
        ".glb",  ".env",  ".3dm", ".yaml", ".yml",  ".json", ".jsonl", ".csv",     ".png", ".svg",
        ".pdf",  ".html", ".obj", ".stl",  ".ply",  ".pcd",  ".pgm",   ".geojson", ".dxf", ".jpg",
        ".jpeg", ".bmp",  ".gif", ".tif",  ".tiff", ".ps",   ".eps",   ".map",     ".3ds", ".dae",
        ".fbx",  ".gltf", ".zip", ".dwg",  ".step", ".ifc",  ".blend"};
    if (std::find(std::begin(kOthers), std::end(kOthers), suffix) != std::end(kOthers)) {
        std::string list;
        for (const std::string& format : known) list += (list.empty() ? "" : ", ") + format;
        throw UsageError(output + ": " + suffix.substr(1) + " is not written here; known: " + list);
    }
    return known.front();
}

void refuseTerminal(const std::string& output, const std::string& what) {
    if (isTerminalOutput(output))
        throw UsageError(what + " is binary and stdout a terminal: use -o FILE or a pipe");
}

}  // namespace ispace
