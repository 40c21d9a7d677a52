// SPDX-License-Identifier: GPL-3.0-or-later
#include "envc/envc_options.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "extensions.h"
#include "io/exporters.h"

namespace ispace {

namespace fs = std::filesystem;

std::string besideOf(const EnvcOptions& options) {
    const ExportFormat& format = *options.format;
    const bool is_none =
        format.beside_suffix.empty() || (isStream(options.common.output) && !format.needs_beside);
    return is_none ? "" : withSuffix(options.common.output, format.beside_suffix.data());
}

void writeProduct(const EnvcOptions& options, const Scene& scene, const Document& document,
                  const FoundRooms* found) {
    if (options.format->write_to != nullptr) {
        OutputFile file(options.common.output);
        options.format->write_to(scene, document,
                                 [&file](std::string_view bytes) { file.write(bytes); });
        file.commit();
        return;
    }
    const std::string beside = besideOf(options);
    ExportOptions how{options.slice,
                      options.import.resolution,
                      options.width,
                      "",
                      fs::path(beside).filename().string(),
                      options.zones,
                      found};
    if (!isStream(options.inputs.front())) how.title = baseName(options.inputs.front());
    const ExportedFiles files = options.format->write(scene, document, how);
    if (!files.left_out.empty()) warn(options.common, "envc", files.left_out);
    if (beside.empty() || files.beside.empty())
        writeAll(options.common.output, files.product);
    else
        writeTogether(std::vector<NamedBytes>{{beside, files.beside},
                                              {options.common.output, files.product}});
}

namespace {

const std::vector<std::string> kUnits{"m", "cm", "mm", "inch", "in", "foot", "ft"};

std::vector<std::string> formatNames(bool of_slices) {
    std::vector<std::string> names;
    for (const ExportFormat& format : exportFormats())
        if (!of_slices || format.takes_slice) names.emplace_back(format.name);
    return names;
}

double heightFrom(const std::string& text) {
    constexpr double kMax = 1000;
    return std::get<double>(parseValue(
        {.name = "height", .unit = Unit::Length, .help = "", .lower = -kMax, .upper = kMax}, text));
}

void addProductOptions(CommandLine& line, EnvcOptions& options, std::string& to) {
    line.choice("--to", to, formatNames(false),
                "format of the product (default: suffix of FILE, else glb, or svg with --slice)",
                Enters::History, missingExporter);
    const auto take_slice = [&options](const std::string& text) {
        options.slice = heightFrom(text);
    };
    line.parsed("--slice", "M", take_slice, "write the cut through the room at this height instead",
                Enters::History);
    line.meters(
        "--resolution", options.import.resolution, 0.001, 100,
        "metres per pixel of a picture, per cell in which the points of a cloud are counted, "
        "or per cell of a ROS map that is written (there 0.05 m by default)",
        Enters::History);
    line.count("--width", "PIXELS", options.width, 200, 12000, "width of a PNG", Enters::History);
    line.texts(
        "--zone", "ZONE", options.zones,
        "add a zone: rect:X,Y,X,Y, poly:X,Y;X,Y;..., or door:GLOB[,M] within M of doors (1.5m); of "
        "nav2-keepout floor to keep out of, also a zone's id",
        Enters::History);
    line.flag("--info", options.info, "report on the environment instead of writing it",
              Enters::Nothing);
    line.flag("--json", options.json, "the report of --info, or --rooms list, as JSON",
              Enters::Nothing);
    options.reports = std::make_shared<const ReportExtensions>(extensions().reports());
    line.file(
        "--report", "FILE", options.report,
        "write a report of the room: a page with its plan (.html, .pdf), or the JSON of --info "
        "(.json); without -o and --to this alone",
        Enters::Nothing);
    line.flag("--check", options.check,
              "report errors and warnings about the environment and its objects", Enters::Nothing);
    constexpr int kSuggestions = 5, kMaxSuggestions = 100;
    line.countOr("--suggest", options.suggestions, kSuggestions, 1, kMaxSuggestions,
                 "with --check: report up to N moves that resolve findings, each with its gain and "
                 "its command",
                 Enters::Nothing);
}

void addEditOptions(CommandLine& line, std::vector<Edit>& edits) {
    const auto edit = [&](Edit::Kind kind, const char* value, const char* help) {
        const auto take = [&edits, kind](const std::string& text) {
            edits.push_back(parseEdit(kind, text));
        };
        line.ordered(optionOf(kind), value, take, help);
    };
    edit(Edit::Kind::Add, "RECORD", "add a record");
    edit(Edit::Kind::Fence, "PATH", "add a fence along x,y;x,y;...");
    edit(Edit::Kind::Set, "ID.KEY=VALUE", "set a key; without VALUE, remove it");
    edit(Edit::Kind::Move, "ID:DX,DY[,DZ]", "move along the axes");
    edit(Edit::Kind::Forward, "ID:M", "move along its heading");
    edit(Edit::Kind::Rotate, "ID:DEG", "rotate counter-clockwise about its position");
    edit(Edit::Kind::Tilt, "ID:DEG", "tilt a sensor up");
    edit(Edit::Kind::Delete, "ID", "remove");
}

/// Parses two or `most` numbers, the first two of them a point.
Tuple placeFrom(const char* name, Unit unit, std::size_t most, const std::string& text) {
    return std::get<Tuple>(parseValue({.name = name,
                                       .type = KeyType::Tuple,
                                       .unit = unit,
                                       .help = "",
                                       .min_count = 2,
                                       .max_count = most,
                                       .lower = -kMaxPlanCoordinate,
                                       .upper = kMaxPlanCoordinate},
                                      text));
}

Point2 pointFrom(const std::string& text) {
    const Tuple at = placeFrom("point", Unit::Length, 2, text);
    return {at[0], at[1]};
}

Pose2 poseFrom(const std::string& text) {
    const Tuple at = placeFrom("origin", Unit::None, 3, text);
    return {{at[0], at[1]}, Angle::degrees(at.size() > 2 ? at[2] : 0)};
}

/// Options that select the room of a plan.
void addRoomOptions(CommandLine& line, EnvcOptions& options) {
    ImportOptions& import = options.import;
    const auto take_inside = [&import](const std::string& text) {
        import.inside.push_back(pointFrom(text));
    };
    line.ordered("--inside", "X,Y", take_inside, "a point in a room to keep");
    line.choice(
        "--rooms", options.rooms, {"largest", "all", "list"},
        "which closed rooms of a plan are kept (default largest); or list all of them, with "
        "areas and points for --inside",
        Enters::History);
    line.meters("--close-gaps", import.close_gaps, 0, 100,
                "close gaps between a plan's walls up to this wide "
                "(default: as little as the plan needs, at most 0.2 m)",
                Enters::History);
    line.meters("--reachable", import.reachable, 0.001, 100,
                "keep only floor that a disc of this radius reaches", Enters::History);
}

void addImportOptions(CommandLine& line, ImportOptions& import) {
    const auto take_origin = [&import](const std::string& text) { import.origin = poseFrom(text); };
    line.parsed("--origin", "X,Y[,DEG]", take_origin,
                "position of a picture's lower left corner, and rotation about it (default 0,0)",
                Enters::History);
    line.meters("--wall-height", import.wall_height, 0.001, 1000, "height of walls of plans",
                Enters::History);
    line.meters("--wall-thickness", import.wall_thickness, 0, 100,
                "thickness of walls of plans that are drawn as lines", Enters::History);
    line.meters(
        "--snap", import.snap, 0, 100,
        "join ends of a plan's lines that are this close (default: 5 mm in DXF and ARIA maps)",
        Enters::History);
    line.meters("--simplify", import.simplify, 0, 1000,
                "simplify outlines of plans by at most this (default: one cell of a map, "
                "two where it is noisy, else 0)",
                Enters::History);
    line.meters(
        "--clean", import.clean, 0, 100,
        "remove noise below this size from maps made by robots (default 0.5 m; 0: keep all)",
        Enters::History);
    line.choice("--unknown", import.unknown, {"unknown", "free"},
                "meaning of shade 205 of a map, which robots write for unknown (default unknown)",
                Enters::History);
    line.choice("--units", import.units, kUnits, "unit of a drawing, a mesh or a cloud",
                Enters::History);
    line.meters("--width-is", import.width_is, 0.01, 100'000,
                "width of a drawing, from its leftmost to its rightmost wall, instead of its unit",
                Enters::History);
    const auto take_cut = [&import](const std::string& text) {
        const std::size_t dots = text.find("..");
        import.slice_walls = heightFrom(text.substr(0, dots));
        if (dots == std::string::npos) return;
        import.slice_top = heightFrom(text.substr(dots + 2));
        if (!(*import.slice_walls < *import.slice_top))
            throw UsageError("the lower height comes first, as in 0.5..1.8");
    };
    line.parsed("--slice-walls", "M[..M]", take_cut,
                "cut a mesh of a room, or the meshes of an SDF world, at this height into walls; "
                "take the points of a cloud between two heights as walls (default: IFC is cut 1 m "
                "above the floor, SDF at 0.3 m where its boxes enclose no room)",
                Enters::History);
    line.texts("--wall-layer", "GLOB", import.wall_layers,
               "layers of a drawing that hold walls (default: all others)", Enters::History);
    line.texts("--door-layer", "GLOB", import.door_layers,
               "layers that hold doors (default: those named so)", Enters::History);
    line.texts("--window-layer", "GLOB", import.window_layers, "layers that hold windows",
               Enters::History);
}

void checkCombination(const CommandLine& line, const EnvcOptions& options) {
    mustReadStdinOnce(options.inputs);
    if (options.json && !options.info && !options.list_rooms)
        throw UsageError("--json is the form of --info and of --rooms list: give one of them");
    if (options.list_rooms &&
        (options.info || options.check || options.slice || line.given("--to")))
        throw UsageError(
            "--rooms list is the product then: leave --info, --check, --slice and --to out");
    if (options.import.width_is && line.given("--units"))
        throw UsageError("--width-is and --units both set the scale: give one of them");
    if (options.check && (options.info || options.slice || line.given("--to") ||
                          line.given("--output") || options.common.dependencies.wanted))
        throw UsageError("--check writes nothing: leave --info, --slice, --to, -o and -MD out");
    if (options.suggestions && !options.check)
        throw UsageError("--suggest is about the findings of --check: give both");
    if (line.given("--report")) {
        if (isStdout(options.report)) throw UsageError("give --report a file, such as room.html");
        options.reports->take(options.report);
        if (options.info || options.check || options.list_rooms ||
            (options.format != nullptr && options.format->write == nullptr))
            throw UsageError(
                "--report is about a room that is compiled: leave --info, --check, "
                "--rooms list and records (--to env) out");
    }
    if (options.info && (options.slice || line.given("--to")))
        throw UsageError("--info is the product then: leave --slice and --to out");
    if (line.given("--closed") && !line.given("--fence"))
        throw UsageError("--closed is about --fence: give both");
    const bool takes_zones = options.format != nullptr && options.format->takes_zones;
    if (!takes_zones &&
        std::any_of(options.zones.begin(), options.zones.end(),
                    [](const std::string& zone) { return zone.find(':') == std::string::npos; }))
        throw UsageError(
            "--zone is for --to nav2-keepout, or adds rect:X,Y,X,Y, poly:X,Y;X,Y;... or "
            "door:GLOB[,M]: the room has the zones that are called by their ids");
    if (options.format == nullptr) return;
    if (takes_zones && options.zones.empty())
        throw UsageError(
            std::string(options.format->name) +
            ": say which floor to keep out of: --zone NAME, rect:X,Y,X,Y, poly:… or door:GLOB[,M]");
    const std::string suffix = suffixOf(options.common.output);
    const ExportFormat& format = *options.format;
    if ((format.needs_beside && suffix != format.suffix) ||
        (!format.beside_suffix.empty() && '.' + suffix == format.beside_suffix))
        throw UsageError(std::string(format.naming_hint));
}

/// Returns the first format with the suffix: .yaml is a map of a slice, and records of a room.
const ExportFormat* productFormat(const std::string& to, const EnvcOptions& options) {
    if (to.empty()) refuseMissing(options.common.output);
    const std::vector<std::string> names = formatNames(options.slice.has_value());
    std::vector<SuffixOf> suffixes;
    for (const std::string& name : names) {
        const std::string suffix(exportFormat(name).suffix);
        const bool is_taken =
            suffix != name && std::find(names.begin(), names.end(), suffix) != names.end();
        suffixes.push_back({is_taken ? "" : suffix, name});
    }
    const ExportFormat& format =
        exportFormat(outputFormat(to, options.common.output, names, suffixes));
    if (options.slice && !format.takes_slice)
        throw UsageError("--slice is written as " + listOf(names) + ", not " +
                         std::string(format.name));
    return &format;
}

}  // namespace

EnvcOptions parseEnvcOptions(int argc, const char* const* argv) {
    ToolExtensions tool_extensions(extensions().options(), "envc");  // these add formats
    EnvcOptions options;
    std::string to;
    bool closed = false;
    CommandLine line("envc", "[INPUT]...",
                     "Compile, check, convert, edit and draw rooms (.env, YAML, .glb, floor plans, "
                     "meshes) and layouts (.3dm); without INPUT, or for -, read stdin.");
    line.example("envc room.env -o room.glb", "compile a room; errors name line and column");
    line.example("envc flat.dxf -o flat.png",
                 "read a drawing, and draw the room that was chosen beside the others");
    line.operands(options.inputs, 1000);
    addProductOptions(line, options, to);
    line.group("Edits, in the order given");
    addEditOptions(line, options.edits);
    line.flag("--closed", closed, "close the fences of --fence", Enters::History);
    line.group("Rooms of plans, maps and buildings");
    addRoomOptions(line, options);
    line.group("Imports");
    addImportOptions(line, options.import);
    addStoreyOption(line, options.rules,
                    "of IFC also by number, from 1 for the lowest; default: all storeys");
    const ImportExtensions importers(extensions().imports());
    importers.declare(line, options.import);
    line.built(extensions().names());
    tool_extensions.declare(line);
    addSceneRules(line, options.rules);
    addCommonOptions(line, options.common, "write the product there (default: stdout)");
    line.essential({"--version", "--to",         "--slice",       "--resolution", "--width",
                    "--zone",    "--info",       "--json",        "--report",     "--check",
                    "--add",     "--fence",      "--set",         "--delete",     "--inside",
                    "--rooms",   "--close-gaps", "--wall-height", "--units",      "--storey",
                    "--output",  "--quiet",      "--threads"});
    line.parse(argc, argv);

    options.task = tool_extensions.task(line, {options.common, options.rules, options.inputs});
    if (options.task) return options;
    if (options.inputs.empty()) options.inputs.emplace_back("-");
    if (options.import.units == "in") options.import.units = "inch";
    if (options.import.units == "ft") options.import.units = "foot";
    if (options.rooms == "all") options.import.rooms = RoomChoice::All;
    for (Edit& edit : options.edits) edit.closed = closed && edit.kind == Edit::Kind::Fence;
    options.list_rooms = options.rooms == "list";
    const bool is_report_alone =
        line.given("--report") && !line.given("--output") && !line.given("--to") && !options.slice;
    if (!options.info && !options.check && !options.list_rooms && !is_report_alone)
        options.format = productFormat(to, options);
    checkCombination(line, options);
    if ((options.info || options.list_rooms) && !options.json)
        options.json = outputFormat({}, options.common.output, {"txt", "json"}) == "json";
    options.history_line = line.historyLine(options.inputs);
    SceneRules rules = options.rules;
    rules.storeys = {};  // which the history has
    options.changing = editCommand(options.inputs, rules);
    options.changing += importers.repeated(options.import);
    options.changing += line.historyLine({}).substr(std::string_view("envc").size());
    return options;
}

}  // namespace ispace
