// SPDX-License-Identifier: GPL-3.0-or-later
// The table of options; arrange_settled.cc converts and checks them.
#include "arrange/arrange_options.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <type_traits>
#include <utility>
#include <variant>

#include "arrange/search/search_share.h"
#include "base/error.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "extensions.h"
#include "record/schema.h"

namespace ispace {

namespace {

/// Enough for any room; rejects a mistyped digit.
constexpr int kMaxHeadings = 3600;

/// Parses numbers of a unit, separated by commas.
Tuple numbers(const std::string& text, Unit unit, std::size_t least, std::size_t most, double lower,
              double upper) {
    const KeySpec key{.name = "",  // the option's name is added anyway
                      .type = KeyType::Tuple,
                      .unit = unit,
                      .help = "",
                      .min_count = least,
                      .max_count = most,
                      .lower = lower,
                      .upper = upper};
    return std::get<Tuple>(parseValue(key, text));
}

CandidateDensity readDensity(const std::string& text, double lowest, double highest) {
    const std::string wanted =
        '`' + text + "` is not GRID,WALL,HEADINGS: two steps in metres and a whole number";
    const auto last = text.rfind(',');
    if (std::count(text.begin(), text.end(), ',') != 2) throw UsageError(wanted);
    const auto headings = parseInteger(text.substr(last + 1));
    if (!headings || *headings < 1 || *headings > kMaxHeadings) throw UsageError(wanted);
    const Tuple steps = numbers(text.substr(0, last), Unit::Length, 2, 2, lowest, highest);
    return {steps[0], steps[1], static_cast<int>(*headings)};
}

double readNumber(const std::string& text, double lowest, double highest, const char* what) {
    const auto number = parseDouble(text);
    if (!number || !(*number >= lowest && *number <= highest))
        throw UsageError('`' + text + "` is not " + what);
    return *number;
}

double readShare(const std::string& text) {
    const auto share = parseShare(text);
    if (!share) throw UsageError('`' + text + "` is not a share like 95% or 0.95");
    return *share;
}

Angle readResolution(const std::string& text) {
    constexpr double kFinest = 0.01, kCoarsest = 90;
    if (text == "sensor") return Angle();
    return Angle::degrees(readNumber(
        text, kFinest, kCoarsest,
        "an angle from 0.01 to 90 degrees, nor `sensor` (cells are --grid P,Q or --cell M)"));
}

/// Rejects a bare 1, which is ambiguous: the whole as a fraction, a hundredth in per cent.
double readGap(const std::string& text) {
    const double gap = readShare(text);
    if (gap == 1 && !text.ends_with('%'))
        throw UsageError('`' + text + "` could be 1% or all of it: write 1% or 0.01");
    return gap;
}

template <typename Value, std::size_t kCount>
std::vector<std::string> wordsOf(const Value (&values)[kCount]) {
    std::vector<std::string> words;
    words.reserve(kCount);
    for (const Value value : values) words.emplace_back(nameOf(value));
    return words;
}

}  // namespace

ArrangeCommand::ArrangeCommand(int argc, const char* const* argv)
    : ToolCommand("arrange", "[ENV] [LAYOUT]",
                  "Compute poses for sensors in a room: those of LAYOUT without one, and those of "
                  "--sensor. Writes a layout (.3dm) and reports an upper bound on coverage."),
      objectives_("--objective", extensions().objectives()),
      proofs_("--proof", extensions().proofs()) {
    line_.example("arrange room.env --sensor urg-04lx:3 -o layout.3dm",
                  "poses of three laser scanners that cover most of the room");
    line_.example("arrange room.env --sensor urg-04lx:9 --target 95% -o few.3dm",
                  "the fewest that cover 95 % of it, at most nine, and how few they could be");
    line_.operands(options_.operands, 2);
    line_.texts(
        "--sensor", "MODEL[,KEY=VALUE...][:COUNT]", options_.sensors,
        "add COUNT sensors of a device or a bare kind (" +
            listOf(manualKeywords([](const SensorKind& kind) { return kind.is_arranged; })) +
            "), e.g. urg-04lx:3 or laser,range=4,fov=180:3",
        Enters::History);
    addListOption(line_, options_.batch,
                  "-o names the folder or pattern of the layouts, and stdout receives a line of "
                  "JSON for each");
    line_.texts("--fixed", "ID", options_.fixed,
                "keep the poses of these sensors of LAYOUT only (globs allowed) and compute new "
                "ones for the others; by default all sensors with a pose keep it",
                Enters::History);
    line_.group("Candidate sites and headings");
    addPlaceOptions();
    line_.group("Mounting");
    addMountOptions();
    line_.group("Goals");
    addGoalOptions();
    objectives_.declare(line_);
    options_.groups->declare(line_, ArrangeGroup::Place::Cases);
    line_.group("Search");
    addSearchOptions();
    line_.group("Further files");
    addFileOptions();
    proofs_.declare(line_);
    line_.group("Jobs");
    addShareOptions();
    line_.built(extensions().names());
    ToolExtensions tool_extensions(extensions().options(), "arrange");
    tool_extensions.declare(line_);
    addSceneRules(line_, options_.rules);
    addStoreyOption(line_, options_.rules, "default: all storeys");
    addCommonOptions(line_, options_.common, "write the layout there (default: stdout)");
    line_.essential({"--version", "--sensor",     "--fixed",   "--strategy",  "--mount",
                     "--z",       "--keep-out",   "--keep-in", "--objective", "--zone",
                     "--weight",  "--redundancy", "--target",  "--budget",    "--time-limit",
                     "--refine",  "--report",     "--storey",  "--output",    "--quiet",
                     "--threads", "--seed"});
    line_.parse(argc, argv);
    options_.task =
        tool_extensions.task(line_, {options_.common, options_.rules, options_.operands});
    if (!options_.task) settle();
}

void ArrangeCommand::addPlaceOptions() {
    ArrangeOptions& how = options_.how;
    line_.choice("--effort", words_.effort, {"low", "medium", "high"},
                 "the thesis' time levels: random sites; a grid with 8 headings; one with 16",
                 Enters::History);
    std::vector<std::string> names;
    std::string help = "strategy that proposes sites: ";
    for (const StrategyRow& row : strategies()) {
        help.append(names.empty() ? "" : ", ").append(row.name).append(" (").append(row.help) +=
            ')';
        names.emplace_back(row.name);
    }
    line_.choice("--strategy", words_.strategy, names, help, Enters::History);
    std::set<std::string_view> added;
    for (const StrategyRow& row : strategies())
        for (const StrategyOption& option : row.options)
            if (added.insert(option.name).second) addStrategyOption(row, option);
    line_.count("--deg", "N", how.headings, 1, kMaxHeadings,
                "headings per site, 360/N degrees apart from 0, or from the inner normal of a wall "
                "(default: 8 for grid and random, the normal for wall, else as in --candidates)",
                Enters::History);
}

void ArrangeCommand::addStrategyOption(const StrategyRow& row, const StrategyOption& option) {
    const std::string help = "of " + std::string(row.name) + ": " + option.help;
    const auto add = [&](auto field) {
        auto& value = options_.how.*field;
        using Value = std::remove_reference_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, CandidateDensity>)
            line_.parsed(
                option.name, "GRID,WALL,HEADINGS",
                [&value, &option](const std::string& text) {
                    value = readDensity(text, option.lowest, option.highest);
                },
                help, Enters::History);
        else if constexpr (std::is_same_v<Value, std::vector<Site>>)
            line_.file(option.name, "FILE", options_.places_file, help, Enters::BaseName);
        else if constexpr (std::is_same_v<Value, int> || std::is_same_v<Value, std::optional<int>>)
            line_.count(option.name, "N", value, static_cast<int>(option.lowest),
                        static_cast<int>(option.highest), help, Enters::History);
        else
            line_.meters(option.name, value, option.lowest, option.highest, help, Enters::History);
    };
    std::visit(add, option.field);
}

void ArrangeCommand::addMountOptions() {
    MountRules& mount = options_.how.mount;
    line_.choice(
        "--mount", words_.mount, wordsOf(kMounts),
        "support of the sensors: floor (default; cameras: ceiling), wall (only sites along walls), "
        "frame (bars of infra), ceiling; on the last two rangers and ultrasound look down",
        Enters::History);
    line_.parsed(
        "--z", "H[,H...]",
        [&mount](const std::string& text) {
            mount.heights = numbers(text, Unit::Length, 1, 100, 0, 1000);
        },
        "heights to choose from (default 0.15, or that of the mount; of cameras on walls 2.4)",
        Enters::History);
    line_.parsed(
        "--tilt", "DEG[,DEG...]",
        [&mount](const std::string& text) {
            mount.tilts.clear();
            for (const double tilt : numbers(text, Unit::Angle, 1, 100, -90, 90))
                mount.tilts.push_back(Angle::degrees(tilt));
        },
        "tilts to choose from, for sensors without tilt= (default 0; of cameras -30,-15,-45 on "
        "walls and -90,-60,-30 above)",
        Enters::History);
    line_.meters("--clearance", mount.clearance, 0, 1000,
                 "minimum distance from walls and objects at that height", Enters::History);
    line_.texts("--keep-out", "ZONE", options_.zones.keep_out, "no sensor stands there",
                Enters::History);
    line_.texts("--keep-in", "ZONE", options_.zones.keep_in, "sensors stand only there",
                Enters::History);
}

void ArrangeCommand::addGoalOptions() {
    ArrangeOptions& how = options_.how;
    line_.parsed(
        "--objective", "WHAT",
        [this](const std::string& text) {
            options_.objective = objectives_.find(text);
            if (!options_.objective && text != "coverage")
                throw UsageError('`' + text + "` is not coverage" + objectives_.words());
        },
        "quantity to maximise: coverage (default)" + objectives_.help(), Enters::History);
    line_.texts("--zone", "ZONE", options_.zones.targets,
                "cover only this part of the floor: the id of a zone, rect:X,Y,X,Y, "
                "poly:X,Y;X,Y;..., or door:GLOB[,M] within M of doors (1.5m)",
                Enters::History);
    line_.texts("--weight", "ZONE=W", options_.zones.weights,
                "floor there counts W times (elsewhere once)", Enters::History);
    constexpr int kMaxTimes = 100;
    line_.count("--redundancy", "K", how.redundancy, 1, kMaxTimes,
                "floor counts if K sensors see it", Enters::History);
    line_.flag("--connected", how.is_connected,
               "views must form one connected whole by sharing cells", Enters::History);
    line_.parsed(
        "--target", "SHARE", [&how](const std::string& text) { how.target = readShare(text); },
        "find the fewest sensors (or the cheapest, cost=) that cover this share, e.g. 95%; COUNT "
        "is then a maximum; exit with 3 if it cannot be reached",
        Enters::History);
    std::vector<std::string> proofs = proofs_.all();
    proofs.insert(proofs.begin(), "candidates");
    line_.choice("--proof", words_.proof, proofs,
                 "over which poses results are proven: the candidates (default)" + proofs_.help(),
                 Enters::History);
    line_.parsed(
        "--budget", "COST",
        [&how](const std::string& text) {
            how.budget = readNumber(text, 0, 1e9, "a cost from 0 on");
        },
        "spend at most this, at cost= per sensor (default 1); COUNT is then a maximum",
        Enters::History);
    // Their words come here in the history of a layout.
    options_.groups = std::make_shared<ArrangeExtensions>(extensions().arrange());
    options_.groups->declare(line_, ArrangeGroup::Place::Goals);
    line_.group("Plane and cells");
    line_.meters("--plane", how.plane, 0, 1000,
                 "height of the plane that all sensors but level lasers cover, 0 is the floor",
                 Enters::History);
    addDensityOption(line_, how.pixel_density);
    addCellOptions(line_, words_.cells, "while searching");
    line_.parsed(
        "--reso", "DEG", [&how](const std::string& text) { how.beam_step = readResolution(text); },
        "while searching, lasers cover the contour of beams this far apart, as in the thesis; "
        "sensor: their step (default: the whole visible area)",
        Enters::History);
    line_.choice(
        "--judge", words_.judge, {"yes", "no"},
        "no: without the thesis' Insider Judge sensors may stand outside the room, and all "
        "of the rectangle about it counts (fig. 4.8; default yes)",
        Enters::History);
}

void ArrangeCommand::addSearchOptions() {
    ArrangeOptions& how = options_.how;
    line_.choice("--optimize", words_.optimize, wordsOf(kOptimizers),
                 "one after another (greedy), with moves from many starts (swap), or to the proven "
                 "best (exact); default swap, greedy with grid, random and wall",
                 Enters::History);
    constexpr int kMaxStarts = 100000;
    line_.count("--starts", "N", how.search.swap.starts, 0, kMaxStarts, "random starts of swap",
                Enters::History);
    line_.parsed(
        "--gap", "SHARE", [&how](const std::string& text) { how.search.gap = readGap(text); },
        "end once value and bound are this close, e.g. 1%", Enters::History);
    constexpr double kMaxWait = 1e9;
    line_.duration("--time-limit", options_.time_limit, 0, kMaxWait,
                   "end with the best so far after this time (500ms, 2s, 1min), marked complete=no",
                   Enters::History);
    line_.flag("--refine", how.refine,
               "improve the best layout in continuous positions and headings, by exact area",
               Enters::History);
    line_.parsed(
        "--max-memory", "SIZE",
        [&how](const std::string& text) { how.max_bytes = byteCount(text); },
        "limit for candidates and the tree of exact, e.g. 2G (default 8G)", Enters::Nothing);
}

void ArrangeCommand::addFileOptions() {
    line_.file("--curve", "FILE", options_.curve_file,
               "also report the coverage of 1, 2, ... sensors, and write it to FILE (.csv, .png, "
               ".svg or .pdf)",
               Enters::Nothing);
    constexpr int kMaxAlternatives = 20;
    line_.count("--alternatives", "N", options_.how.alternatives, 1, kMaxAlternatives,
                "also find N good layouts that differ by a metre or 30 degrees in some sensor, and "
                "write them beside -o FILE.3dm as FILE-2.3dm, FILE-3.3dm, ...",
                Enters::Nothing);
    line_.file("--heat", "FILE", options_.heat_file,
               "draw the floor that a sensor adds at each candidate site (.png, .svg, .pdf): for "
               "the first sensor of the layout, in FILE-2, ... for the next ones",
               Enters::Nothing);
    line_.file("--trace", "FILE", options_.trace_file,
               "write every candidate with its value as JSONL, for coverage --trace",
               Enters::Nothing);
    line_.file(
        "--report", "FILE", options_.report_file,
        "write a report of the layout for people (.html, .pdf), or that of coverage --json (.json)",
        Enters::Nothing);
    options_.reports = std::make_shared<ReportExtensions>(extensions().reports());
    options_.reports->declare(line_);
    line_.file("--export-mps", "FILE", options_.mps_file,
               "write the model for solvers of mixed-integer programs (glpsol, cbc)",
               Enters::Nothing);
}

void ArrangeCommand::addShareOptions() {
    addBatchOptions(line_, options_.batch, "the slowest part of its optimizer");
    addCacheOption(line_, options_.batch);
    std::vector<std::string> words;
    for (const Shared what : kShared) words.emplace_back(nameOf(what));
    line_.choice("--share", words_.share, words,
                 "work that shards divide: views of the candidates (default of greedy and with "
                 "--target), random starts (of swap), or subtrees of the proof (of exact; poses)",
                 Enters::Nothing);
    constexpr double kMaxInterval = 86400;
    line_.duration("--checkpoint-interval", options_.checkpoint_interval, 0, kMaxInterval,
                   "with --resume: time between two states of a proof that are kept",
                   Enters::Nothing);
}

}  // namespace ispace
