// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage_options.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "extensions.h"
#include "io/exporters.h"

namespace ispace {

namespace {

std::vector<std::string> formatNames() {
    std::vector<std::string> names;
    for (const CoverageFormat& format : coverageFormats()) names.emplace_back(format.name);
    return names;
}

/// Options that apply to the map alone.
constexpr const char* kMapOptions[] = {"--to",   "--width", "--color",
                                       "--fans", "--trace", "--speeds"};

/// Words of options that are converted once all are read.
struct Words {
    std::string to, cells_by, color, fans;
    CellWords cells;
    std::vector<std::string> requirements;
};

/// Parses `30` or `30,3`.
ParallaxChoice parseParallax(const std::string& text) {
    const auto comma = text.find(',');
    const auto degrees = parseDouble(text.substr(0, comma));
    const auto cameras =
        comma == std::string::npos ? std::optional(2.0) : parseDouble(text.substr(comma + 1));
    constexpr double kMaxCameras = 100;
    if (!degrees || *degrees < 0 || *degrees > 180 || !cameras || *cameras < 2 ||
        *cameras > kMaxCameras || *cameras != std::floor(*cameras))
        throw UsageError("`" + text +
                         "` is not DEG or DEG,K with degrees from 0 to 180 and 2 to 100 cameras");
    return {Angle::degrees(*degrees), static_cast<int>(*cameras)};
}

/// Parses `30%,60%,100%`. Nav2 reads a limit of 0 as unlimited, and masks hold whole per cents.
std::vector<double> parseSpeeds(const std::string& text) {
    constexpr double kHundred = 100;
    std::vector<double> speeds;
    std::istringstream list(text);
    for (std::string word; std::getline(list, word, ',');) {
        const auto share = parseShare(word);
        if (!share || std::lround(kHundred * *share) < 1)
            throw UsageError("`" + word +
                             "` is no share of full speed from 1% to 100%, as in 30%,60%,100%; to "
                             "keep robots out take --to nav2-keepout");
        speeds.push_back(*share);
    }
    if (speeds.empty()) throw UsageError("no speeds, wanted such as 30%,60%,100%");
    return speeds;
}

void addMeasureOptions(CommandLine& line, CoverageOptions& measure, Words& words) {
    addCellOptions(line, words.cells, "that metrics count");
    line.choice("--grid-of", words.cells_by, {"region", "beams"},
                "a laser sees the cells in its visible area, or in the polygon of its beam ends "
                "(default region)",
                Enters::History);
    line.meters("--height", measure.height, 0, 1000, "height of the free floor", Enters::History);
    line.meters("--plane", measure.plane, 0, 1000,
                "height of the plane that all sensors but level lasers cover, 0 is the floor",
                Enters::History);
    addDensityOption(line, measure.density);
    const auto parallax = [&measure](const std::string& text) {
        measure.parallax = parseParallax(text);
    };
    line.parsed("--parallax", "DEG[,K]", parallax,
                "report the floor that K cameras see (default 2) with axes pairwise at least this "
                "many degrees apart",
                Enters::History);
}

void checkProduct(const CommandLine& line, CoverageToolOptions& o, const std::string& to) {
    if (!line.given("--output")) {
        for (const char* option : kMapOptions)
            if (line.given(option))
                throw UsageError(std::string(option) + " is about the map: give -o FILE");
        return;
    }
    if (isStdout(o.common.output))
        throw UsageError("the report goes to stdout: give the map a file (-o map.png)");
    std::vector<SuffixOf> suffixes;
    for (const CoverageFormat& format : coverageFormats()) {
        const auto is_taken = [&format](const SuffixOf& of) { return of.suffix == format.suffix; };
        const bool is_first = std::none_of(suffixes.begin(), suffixes.end(), is_taken);
        suffixes.push_back({is_first ? std::string(format.suffix) : "", std::string(format.name)});
    }
    if (to.empty()) {
        referToReport(o.common.output);
        refuseMissing(o.common.output);
    }
    const std::string name = outputFormat(to, o.common.output, formatNames(), suffixes);
    const CoverageFormat& format = coverageFormat(name);
    o.format = &format;
    if (format.beside_suffix != nullptr && suffixOf(o.common.output) != format.suffix)
        throw UsageError(
            "a ROS map is two files, FILE.yaml and FILE.pgm: name it with -o FILE.yaml");
    if (format.square_cell > 0 && line.given("--grid"))
        throw UsageError("a ROS map has square cells: give --cell instead of --grid");
    if (format.square_cell > 0 && !line.given("--cell"))
        o.measure.cells = CellSize{format.square_cell};
    for (const char* option : {"--width", "--color", "--fans", "--trace"})
        if (line.given(option) && !format.picture)
            throw UsageError(std::string(option) + " is about pictures, not about " + name);
    if (line.given("--speeds") && !format.takes_speeds)
        throw UsageError("--speeds is for --to nav2-speed, not for " + name);
}

/// A list of scenes has only reports as product.
void checkBatch(const CommandLine& line, const CoverageToolOptions& o) {
    std::vector<const char*> single = {"--report", "--compare"};
    single.insert(single.end(), std::begin(kMapOptions), std::end(kMapOptions));
    for (const std::string& option : o.reports->options()) single.push_back(option.c_str());
    for (const std::string& option : o.groups->options()) single.push_back(option.c_str());
    checkBatchOptions(line, o.batch, o.common, o.operands, single);
    static_cast<void>(outputFormat({}, o.common.output, {"jsonl", "json"}));
}

void checkOne(const CommandLine& line, CoverageToolOptions& o, const std::string& to) {
    for (const char* option : {"--shard", "--resume", "--cache"})
        if (line.given(option))
            throw UsageError(std::string(option) + " is about many scenes: give --batch LIST");
    checkProduct(line, o, to);
}

}  // namespace

CoverageToolOptions parseCoverageOptions(int argc, const char* const* argv) {
    ToolExtensions tool_extensions(extensions().options(), "coverage");  // these add formats
    CoverageToolOptions o;
    o.groups = std::make_shared<CoverageExtensions>(extensions().coverage());
    Words words;
    CommandLine line("coverage", "[ENV] [LAYOUT]",
                     "Measure and draw the floor that sensors cover. Without LAYOUT read it from "
                     "stdin unless ENV holds sensors with a pose. The report goes to stdout.");
    line.example("coverage room.env layout.3dm -o map.png",
                 "print the covered floor by cells and exactly, and draw it");
    line.operands(o.operands, 2);
    line.flag("--json", o.json, "the report as JSON", Enters::Nothing);
    line.file("--report", "FILE", o.report,
              "also write the report there: as JSON (.json), or for people as a page with maps and "
              "the sheet of an installer (.html, .pdf)",
              Enters::Nothing);
    o.reports = std::make_shared<ReportExtensions>(extensions().reports());
    o.reports->declare(line);
    addListOption(line, o.batch, "the output is a report a line, as JSON, in its order");
    addBatchOptions(line, o.batch, "of the lines of LIST; cat joins their outputs", false);
    addCacheOption(line, o.batch);
    line.group("Metrics");
    addMeasureOptions(line, o.measure, words);
    line.texts("--zone", "ZONE", o.zones,
               "report this part of the floor, too, as a zone: rect:X,Y,X,Y, poly:X,Y;X,Y;..., or "
               "door:GLOB[,M] within M of doors (1.5m), named DOOR-zone",
               Enters::History);
    line.group("Requirements, comparison");
    line.texts("--require", "SHARE", words.requirements,
               "exit with 3 if less is covered, by exact metrics where they are known: 95% of the "
               "indoor floor, free:95%, zone:NAME=95%; by cameras of a density class or level "
               "identify:95%, discern:NAME=95%" +
                   o.groups->requirements(),
               Enters::History);
    line.file("--junit", "FILE", o.junit,
              "write the results of the requirements there, as XML that CI servers read",
              Enters::Nothing);
    line.file("--compare", "LAYOUT", o.other,
              "report gains and losses against this layout, in numbers and on the map",
              Enters::BaseName);
    o.groups->declare(line);
    line.group("The map");
    line.choice("--to", words.to, formatNames(), "format of FILE (default: its suffix, else png)",
                Enters::History, missingExporter);
    constexpr int kMinWidth = 200, kMaxWidth = 10000;
    line.count("--width", "PIXELS", o.map.width, kMinWidth, kMaxWidth, "width of a PNG or SVG",
               Enters::History);
    line.choice("--color", words.color, {"redundancy", "sensor", "density", "levels"},
                "colour the floor by how many sensors see it, by which, or by the pixels a metre "
                "that cameras have there, in the classes of EN 62676-4:2015 or the levels of IEC "
                "62676-4:2025 (default redundancy)",
                Enters::History);
    line.choice("--fans", words.fans, {"contours", "beams"},
                "how views are drawn (default contours)", Enters::History);
    line.parsed(
        "--speeds", "P0,P1,...", [&o](const std::string& text) { o.speeds = parseSpeeds(text); },
        "nav2-speed: shares of full speed on floor that 0, 1, ... sensors see, the last one for "
        "more (default 30%,60%,100%)",
        Enters::History);
    line.file("--trace", "FILE", o.trace,
              "draw the sites that arrange --trace wrote to this file on the map, coloured by "
              "their best value",
              Enters::Nothing);
    line.built(extensions().names());
    tool_extensions.declare(line);
    addSceneRules(line, o.rules);
    addStoreyOption(line, o.rules, "default: all storeys");
    addCommonOptions(line, o.common, "draw the map there (default: no map)");
    line.essential({"--version", "--json", "--report", "--cell", "--height", "--plane", "--density",
                    "--zone", "--require", "--compare", "--to", "--width", "--color", "--storey",
                    "--output", "--quiet", "--threads", "--seed"});
    line.parse(argc, argv);

    o.task = tool_extensions.task(line, {o.common, o.rules, o.operands});
    if (o.task) return o;
    o.history_line = line.historyLine(o.operands);
    if (const auto cells = words.cells.choice()) o.measure.cells = *cells;
    o.measure.max_work = o.rules.max_work;
    if (words.cells_by == "beams") o.measure.cells_by = CellRule::Beams;
    if (words.color == "sensor") o.map.color = MapColor::Sensor;
    if (words.color == "density") o.map.color = MapColor::Density;
    if (words.color == "levels") o.map.color = MapColor::Levels;
    if (words.fans == "beams") o.map.fans = FanStyle::Beams;
    o.requirements.reserve(words.requirements.size());
    for (const std::string& text : words.requirements)
        if (!o.groups->takesRequirement(text)) o.requirements.push_back(parseRequirement(text));
    o.measure.whole_densities =
        o.groups->wantsWholeDensities() ||
        std::any_of(o.requirements.begin(), o.requirements.end(),
                    [](const Requirement& requirement) { return requirement.density; });
    if (line.given("--junit") && words.requirements.empty() && !o.groups->judgesAlone())
        throw UsageError("--junit writes what became of requirements: give --require");
    // The reports of a list may go to a file.
    if (isStdout(o.junit) && (o.batch.list.empty() || isStdout(o.common.output)))
        throw UsageError("the report goes to stdout: give --junit a file");
    if (o.batch.list.empty())
        checkOne(line, o, words.to);
    else
        checkBatch(line, o);
    o.groups->take(line);
    o.command = line.historyLine({});
    if (line.given("--report") && isStdout(o.report))
        throw UsageError("the report goes to stdout anyway: give --report a file, or --json alone");
    o.reports->take(o.report);
    const bool draws = o.format != nullptr || o.reports->of(o.report) != nullptr;
    o.measure.keep_depths = draws;
    return o;
}

}  // namespace ispace
