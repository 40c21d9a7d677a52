// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings and notes go through report() and warn(), which a batch catches; worker threads beyond
// the first one are those that grantedThreads() grants.
#include "cli/common_options.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <limits>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/unconfined.h"
#include "cli/run_tool.h"
#include "scene/sensor/camera.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

constexpr int kMaxThreads = 4096;

/// Returns the cores this process may use: the affinity mask, or less if the control group or a
/// batch system limits it.
int availableThreads() {
    int threads = tbb::info::default_concurrency();
    if (const auto quota = cpuQuota()) threads = std::min(threads, *quota);
    const char* const granted = std::getenv("SLURM_CPUS_PER_TASK");
    const auto limit = granted != nullptr ? parseInteger(granted) : std::nullopt;
    if (limit && *limit >= 1 && *limit < threads) threads = static_cast<int>(*limit);
    return threads;
}

/// Finds how many of `wanted` more threads the system grants at once: TBB cannot handle a refused
/// one. They end at once.
std::size_t grantedThreads(std::size_t wanted) {
    std::vector<std::thread> threads;
    threads.reserve(wanted);
    std::atomic<bool> is_over = false;
    try {
        while (threads.size() < wanted) threads.emplace_back([&is_over] { is_over.wait(false); });
    } catch (const std::exception&) {  // then these must do
    }
    is_over = true;
    is_over.notify_all();
    for (std::thread& thread : threads) thread.join();
    return threads.size();
}

}  // namespace

void addCommonOptions(CommandLine& line, CommonOptions& options, const std::string& output_help) {
    line.group("Options of all tools");
    if (!output_help.empty()) {
        line.dependencies(options.dependencies, options.output);
        const auto take_output = [&options](const std::string& text) {
            if (text.empty()) throw UsageError("an empty name is given, - is stdout");
            options.output = text;
        };
        line.parsed("-o,--output", "FILE", take_output, output_help, Enters::Nothing);
    }
    line.flag("-q,--quiet", options.quiet, "report only errors", Enters::Nothing);
    line.flag("-v,--verbose", options.verbose, "print more about the work", Enters::Nothing);
    line.count("-j,--threads", "N", options.threads, 0, kMaxThreads,
               "worker threads, 0 for all cores; the result does not depend on it",
               Enters::Nothing);
    const auto take_seed = [&options](const std::string& text) {
        const auto seed = parseInteger(text);
        if (!seed || *seed < 0)
            throw UsageError('`' + text + "` is not a whole number from 0 to 2^63 - 1");
        options.seed = static_cast<std::uint64_t>(*seed);
    };
    line.parsed("--seed", "N", take_seed, "seed of all random numbers (default 0)",
                Enters::History);
    line.choice("--errors", options.errors, {"text", "json"},
                "messages on stderr as lines for people, or as a JSON object each (default text)",
                Enters::Nothing);
    line.switchFlag("--progress", "--no-progress", options.progress,
                    "show progress of long work on stderr (default: if that is a terminal)",
                    "do not report it", Enters::Nothing);
    line.flag("--unconfined", mayReadUnconfined(),
              "read meshes, buildings and pictures also where the system cannot confine what reads "
              "them: for trusted files",
              Enters::Nothing);
}

void report(const CommonOptions& options, const std::string& tool, const std::string& sentence) {
    if (options.quiet) return;
    const Diagnostic note{.message = sentence, .severity = Severity::Note};
    if (options.messages) return options.messages(note);
    writeSentence(tool, note);
}

void logInfo(const CommonOptions& options, const std::string& tool, const std::string& text) {
    if (options.verbose > 0) report(options, tool, text);
}

void warn(const CommonOptions& options, const std::string& tool,
          std::span<const Diagnostic> warnings) {
    for (const Diagnostic& warning : warnings) {
        if (options.quiet) return;
        if (options.messages)
            options.messages(warning);
        else
            writeMessage(tool, warning);
    }
}

void warn(const CommonOptions& options, const std::string& tool, const std::string& sentence) {
    const Diagnostic warning{.message = sentence, .severity = Severity::Warning};
    warn(options, tool, {&warning, 1});
}

void warn(const CommonOptions& options, const std::string& tool,
          std::span<const std::string> sentences) {
    constexpr std::size_t kMaxSentences = 20;
    for (const std::string& sentence : sentences.first(std::min(kMaxSentences, sentences.size())))
        warn(options, tool, sentence);
    if (sentences.size() > kMaxSentences)
        warn(options, tool, "and " + std::to_string(sentences.size() - kMaxSentences) + " more");
}

void limitThreads(int threads) {
    // TBB starts no more than there are cores.
    const int wanted =
        threads > 0 ? std::min(threads, tbb::info::default_concurrency()) : availableThreads();
    // Never destroyed: TBB would start threads for work that is over.
    static const tbb::global_control* control = nullptr;
    delete std::exchange(control, nullptr);
    control = new tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                      1 + grantedThreads(static_cast<std::size_t>(wanted) - 1));
}

std::string shareFolder() {
    return (std::filesystem::path(programPrefix()) / "share" / "ispace").string();
}

const DeviceCatalogue& shippedDevices() {
    static const DeviceCatalogue devices = loadDevices(shareFolder() + "/devices");
    return devices;
}

namespace {

const DeviceCatalogue& noDevices() {
    static const DeviceCatalogue none;
    return none;
}

}  // namespace

const DeviceCatalogue& devicesFor(std::initializer_list<const Document*> documents) {
    return devicesFor(std::span(documents.begin(), documents.size()));
}

const DeviceCatalogue& devicesFor(std::span<const Document* const> documents) {
    for (const Document* const document : documents)
        if (document != nullptr &&
            std::any_of(document->records.begin(), document->records.end(), [](const Record& r) {
                return r.schema().find("model") != nullptr && r.has("model");
            }))
            return shippedDevices();
    return noDevices();
}

const DeviceCatalogue& devicesForSensors(std::span<const std::string> specs) {
    const bool all_bare = std::all_of(specs.begin(), specs.end(), [](const std::string& spec) {
        return sensorKind(spec.substr(0, spec.find_first_of(",:"))) != nullptr &&
               spec.find("model=") == std::string::npos;
    });
    return all_bare ? noDevices() : shippedDevices();
}

std::string suffixOf(const std::string& output) {
    std::error_code ignored;
    if (output == "-" || std::filesystem::is_directory(output, ignored)) return "";
    std::string suffix = std::filesystem::path(output).extension().string();
    if (suffix.starts_with('.')) suffix.erase(0, 1);
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return suffix == "yml" ? "yaml" : suffix;
}

std::string listOf(const std::vector<std::string>& words) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) list += i + 1 == words.size() ? " or " : ", ";
        list += words[i];
    }
    return list;
}

void referToReport(const std::string& output) {
    if (suffixOf(output) == "html" || suffixOf(output) == "htm")
        throw UsageError(output + " is a page: --report " + output + " writes it");
}

std::string outputFormat(const std::optional<std::string>& to, const std::string& output,
                         const std::vector<std::string>& known,
                         const std::vector<SuffixOf>& others) {
    if (to && !to->empty()) return *to;
    const std::string suffix = suffixOf(output);
    if (suffix.empty()) return known.front();
    std::vector<std::string> wanted;
    for (const std::string& format : known) {
        const auto other = std::find_if(others.begin(), others.end(),
                                        [&](const SuffixOf& o) { return o.format == format; });
        const std::string& usual = other == others.end() ? format : other->suffix;
        if (suffix == format || suffix == usual) return format;
        if (!usual.empty()) wanted.push_back('.' + usual);
    }
    throw UsageError(output + ": no format has the suffix " + excerpt('.' + suffix) + ", wanted " +
                     listOf(wanted) + (to ? ", or --to FORMAT" : "") +
                     didYouMean('.' + suffix, wanted));
}

void refuseTerminal(const std::string& output, const std::string& what) {
    if (isTerminalOutput(output))
        throw UsageError(what + " is binary and stdout a terminal: use -o FILE or a pipe");
}

namespace {

CellCount readCount(const std::string& text) {
    constexpr std::int64_t kMaxASide = 10000;
    const auto comma = text.find(',');
    const auto p = parseInteger(text.substr(0, comma));
    const auto q = comma == std::string::npos ? p : parseInteger(text.substr(comma + 1));
    if (!p || !q || *p < 1 || *q < 1 || *p > kMaxASide || *q > kMaxASide)
        throw UsageError('`' + text + "` is not P or P,Q with whole numbers from 1 to " +
                         std::to_string(kMaxASide));
    return {static_cast<int>(*p), static_cast<int>(*q)};
}

}  // namespace

std::optional<CellChoice> CellWords::choice() const {
    if (grid && cell)
        throw UsageError("--grid and --cell both say how large cells are: give one of them");
    if (grid) return *grid;
    if (cell) return CellSize{*cell};
    return std::nullopt;
}

void addCellOptions(CommandLine& line, CellWords& words, const std::string& purpose) {
    line.parsed(
        "--grid", "P[,Q]", [&words](const std::string& text) { words.grid = readCount(text); },
        "P x Q cells over the limits " + purpose, Enters::History);
    line.meters("--cell", words.cell, 0.0001, 1000,
                "square cells of this size instead, e.g. 2cm (default: at most 0.1 m, larger in "
                "huge buildings)",
                Enters::History);
    line.renamed("--reso", "give cells as --grid P,Q or --cell M");
}

void addDensityOption(CommandLine& line, double& pixels_per_metre) {
    const auto read = [&pixels_per_metre](const std::string& text) {
        const auto density = pixelDensityOf(text);
        if (density) {
            pixels_per_metre = *density;
            return;
        }
        std::vector<std::string> names;
        for (const auto& known : {pixelDensities(), pixelLevels()})
            for (const PixelDensity& one : known) names.emplace_back(one.name);
        throw UsageError(excerpt(text) + " is not a number of pixels a metre above 0, nor " +
                         listOf(names) + didYouMean(text, names));
    };
    line.parsed(
        "--density", "N|NAME", read,
        "pixels a metre that cameras require to cover floor: a number, or monitor (12.5), detect "
        "(25), observe (62.5), recognise (125), identify (250) or inspect (1000) of EN "
        "62676-4:2015, "
        "or overview (20), outline (40), discern (80), perceive (125), characterise (250), "
        "validate (500) or scrutinise (1500) of IEC 62676-4:2025",
        Enters::History);
}

void addSceneRules(CommandLine& line, SceneRules& rules) {
    line.group("Reading");
    line.switchFlag("--same-environment", "--any-environment", rules.same_environment,
                    "an error if LAYOUT was made for another ENV (default: a warning if ENV is an "
                    "operand, an error if LAYOUT names it)",
                    "neither warning nor error if LAYOUT was made for another ENV",
                    Enters::History);
    const auto read = [&rules](const std::string& word) {
        if (word != "folder" && word != "anywhere")
            throw UsageError(excerpt(word) + " is neither folder nor anywhere");
        rules.includes = word == "folder" ? IncludeFiles::InFolder : IncludeFiles::Anywhere;
    };
    line.parsed("--include-files", "folder|anywhere", read,
                "where files that YAML includes may lie: in the folder of the file that is read or "
                "below (default), or anywhere",
                Enters::Nothing);
    const auto read_work = [&rules](const std::string& text) {
        const auto units = parseInteger(text);
        if (text != "none" && (!units || *units < 1))
            throw UsageError(excerpt(text) + " is neither a whole number from 1 on nor none");
        rules.max_work = text == "none" ? std::numeric_limits<std::int64_t>::max() : *units;
    };
    line.parsed("--max-work", "N|none", read_work,
                "units of work that reading an input may take (default by its size, 1 to 20 "
                "million; see envc(1), Work)",
                Enters::Nothing);
}

std::string readingText(const SceneRules& rules) {
    std::string text;
    if (rules.includes == IncludeFiles::Anywhere) text += " --include-files anywhere";
    if (rules.max_work) text += " --max-work " + std::to_string(*rules.max_work);
    return text;
}

std::string editCommand(const std::vector<std::string>& operands, const SceneRules& rules) {
    std::string command = "envc";
    for (const std::string& operand : operands) {
        const bool is_like_option = operand.size() > 1 && operand.front() == '-';
        command += ' ' + shellQuote((is_like_option ? "./" : "") + operand);
    }
    for (const std::string& word : rules.storeys.words) command += " --storey " + shellQuote(word);
    return command + readingText(rules);
}

std::string commandOf(std::string command, std::span<const Edit> edits) {
    for (const Edit& edit : edits)
        command += ' ' + optionOf(edit.kind) + ' ' + shellQuote(edit.text);
    return command + " -o changed.env";
}

void addStoreyOption(CommandLine& line, SceneRules& rules, const std::string& without) {
    line.texts(
        "--storey", "ID|GLOB", rules.storeys.words,
        "the storeys of a building to take, by ids or names: one is a room, whose ids have no "
        "prefix; several, or a pattern, a building of them (" +
            without + ")",
        Enters::History);
}

std::uint64_t byteCount(const std::string& text) {
    const auto end = text.find_first_not_of("0123456789.");
    const auto number = parseDouble(text.substr(0, end));
    std::string unit = end == std::string::npos ? "" : text.substr(end);
    for (char& c : unit)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (unit.ends_with('B')) unit.pop_back();
    const std::string known = "KMGT";
    const auto power = unit.empty() ? std::string::npos : known.find(unit);
    if (!number || *number <= 0 || (!unit.empty() && (unit.size() > 1 || power > known.size())))
        throw UsageError('`' + text + "` is not a size like 500M or 2G");
    double bytes = *number;
    for (std::size_t i = 0; !unit.empty() && i <= power; ++i) bytes *= 1024;
    constexpr double kMax = 1e15;
    if (bytes > kMax) throw UsageError('`' + text + "` is more than any machine has");
    return static_cast<std::uint64_t>(bytes);
}

std::string byteCountText(std::uint64_t bytes) {
    std::string_view units = "KMGT";
    char unit = 0;
    while (!units.empty() && bytes != 0 && bytes % 1024 == 0) {
        bytes /= 1024;
        unit = units.front();
        units.remove_prefix(1);
    }
    std::string text = std::to_string(bytes);
    if (unit != 0) text += unit;
    return text;
}

}  // namespace ispace
