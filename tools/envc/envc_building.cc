// SPDX-License-Identifier: GPL-3.0-or-later
#include "envc/envc_building.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "building/building_edit.h"
#include "building/building_scene.h"
#include "building/chosen_storeys.h"
#include "building/coupling.h"
#include "cli/building_operands.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "passage/building_run.h"
#include "passage/landing_check.h"
#include "record/text.h"
#include "report/page/page.h"
#include "report/page/room_page.h"
#include "scene/findings/findings.h"
#include "scene/findings/remedies.h"
#include "scene/placement_schemas.h"
#include "sim/course_check.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFormats[] = {"glb", "env", "yaml", "svg", "png", "pdf"};

/// Returns the option that needs one room; "" without one.
std::string optionOfOneRoom(const EnvcOptions& options) {
    if (options.list_rooms) return "--rooms list";
    const bool is_map = options.format != nullptr && options.format->takes_zones;
    return is_map ? "--to " + std::string(options.format->name) : "";
}

/// Returns true for a product of which a file holds one storey.
bool holdsOneStorey(const EnvcOptions& options) {
    return options.format != nullptr &&
           (options.slice || std::find(std::begin(kFormats), std::end(kFormats),
                                       options.format->name) == std::end(kFormats));
}

/// Adds the records of a layout to the rooms of their storeys.
void addLayout(const Document& layout, StoreyedDocument& building) {
    // That of an only storey is the layout of a room, whose ids are plain.
    std::vector<Document> layouts = building.storeys.size() == 1
                                        ? std::vector{layoutOfStorey(layout, building, "")}
                                        : layoutsOf(layout, building);
    for (Document& one : layouts)
        std::erase_if(one.records, [](const Record& record) {
            return record.schema().type == RecordType::Meta;
        });
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        if (layouts[i].records.empty()) continue;
        Storey& storey = building.storeys[i];
        Document room = *storey.room;
        room.records = joinRecords(room.records, layouts[i].records);
        storey.room = std::make_shared<const Document>(std::move(room));
    }
    building.history.insert(building.history.end(), layout.history.begin(), layout.history.end());
}

/// Applies the edits of the command. \param operand of the building, to whose folder names of files
/// are relative
void applyEdits(const EnvcOptions& options, const std::string& operand, const ImportOptions& import,
                StoreyedDocument& building) {
    std::vector<std::shared_ptr<const Document>> before;
    for (const Storey& storey : building.storeys) before.push_back(storey.room);
    editBuilding(building, options.edits);
    if (!import.load_files) return;
    for (Storey& storey : building.storeys) {
        if (std::find(before.begin(), before.end(), storey.room) != before.end()) continue;
        auto room = std::make_shared<Document>(*storey.room);
        loadFiles(*room, operand, import);
        storey.room = std::move(room);
    }
}

/// Adds zones to the rooms of their storeys: `ground/rect:1,1,2,2`, `*/door:*`. Storeys that share
/// a room keep sharing it if they get the same zones. \throws UsageError for a storey that does not
/// exist, a rectangle or polygon without one, and as zoneRecords() if no storey fits
void addZones(std::span<const std::string> zones, StoreyedDocument& building) {
    for (const std::string& text : zones) {
        if (text.starts_with("rect:") || text.starts_with("poly:"))
            throw UsageError("--zone: " + excerpt(text) + " names no storey, as in " +
                             building.storeys.front().id + '/' + text);
        const StoreyText named = splitStoreys(building, "--zone", text);
        // By the room that storeys share; null: it has no such door.
        std::map<const Document*, std::shared_ptr<const Document>> changed;
        std::string first;
        bool is_read = false;
        for (const std::size_t i : named.storeys) {
            Storey& storey = building.storeys[i];
            const auto [known, is_new] = changed.try_emplace(storey.room.get());
            if (is_new) {
                auto room = std::make_shared<Document>(*storey.room);
                try {
                    addZones(std::vector<std::string>{named.text}, *room);
                    known->second = std::move(room);
                } catch (const UsageError& error) {
                    if (first.empty()) first = storey.id + ": " + error.what();
                }
            }
            if (known->second == nullptr) continue;
            storey.room = known->second;
            is_read = true;
        }
        if (!is_read)
            throw UsageError(
                "--zone: " + first +
                (named.storeys.size() > 1 ? "; neither does it fit another storey" : ""));
    }
}

/// Makes names of files in the rooms relative to the folder of the output. Storeys keep sharing
/// rooms.
void rebaseRooms(const EnvcOptions& options, const std::string& from, StoreyedDocument& building) {
    const std::string& output = options.common.output;
    const std::string to = isStream(output) ? "" : fs::path(output).parent_path().string();
    std::vector<std::pair<std::shared_ptr<const Document>, std::shared_ptr<const Document>>> made;
    for (Storey& storey : building.storeys) {
        auto known = std::find_if(made.begin(), made.end(),
                                  [&](const auto& pair) { return pair.first == storey.room; });
        if (known == made.end()) {
            auto room = std::make_shared<Document>(*storey.room);
            rebaseFiles(room->records, isStream(from) ? "" : fs::path(from).parent_path().string(),
                        to);
            made.emplace_back(storey.room, std::move(room));
            known = std::prev(made.end());
        }
        storey.room = known->second;
    }
}

/// Writes moves that resolve findings of a storey, by the ids of the building.
void suggestMoves(const EnvcOptions& options, const BuildingScene& building, std::size_t storey,
                  const FindingFilter& filter, int& left, std::string& text) {
    if (left == 0) return;
    const auto scene = sceneOfBuilding(building, storey);
    const std::vector<Finding> found = checkScene(*scene, filter);
    const std::size_t count = found.size() + checkCourses(*scene).size();
    if (count == 0) return;
    const std::vector<Remedy> remedies =
        remediesOf(*scene, found, filter, static_cast<std::size_t>(left), building.devices,
                   [](const Scene& one) { return checkCourses(one).size(); });
    left -= static_cast<int>(remedies.size());
    text += building.document.storeys[storey].id + ": " + remediesText(options, count, remedies);
}

/// \throws FormatError with the findings of all storeys, each room once
void check(const EnvcOptions& options, const BuildingScene& building, const ImportReport& report) {
    Diagnostics findings;
    for (const Diagnostic& warning : building.document.warnings) findings.add(warning);
    for (const Diagnostic& doubt : report.doubts) findings.add(doubt);
    FindingFilter mistakes;
    for (const SceneCheck& check : sceneChecks())
        if (check.name != "unplaced") mistakes.checks.push_back(check.name);
    const Coupling coupling(building);
    // As of a room: arrange accepts a sensor without a position.
    warn(options.common, "envc", storeyWarnings(coupling, {.checks = {"unplaced"}}));
    std::vector<const Scene*> checked;
    std::string moves;
    int moves_left = options.suggestions.value_or(0);
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Scene* const scene = building.scenes[i].get();
        const bool is_new = std::find(checked.begin(), checked.end(), scene) == checked.end();
        checked.push_back(scene);
        for (Diagnostic& finding : storeyFindings(coupling, i, mistakes, is_new))
            findings.add(std::move(finding));
        if (!is_new) continue;
        if (options.suggestions) suggestMoves(options, building, i, mistakes, moves_left, moves);
        for (const Finding& finding : checkCourses(*scene)) {
            Diagnostic diagnostic = finding.diagnostic();
            diagnostic.message = building.document.storeys[i].id + ": " + diagnostic.message;
            findings.add(std::move(diagnostic));
        }
    }
    for (Diagnostic& finding : checkBuilding(building)) findings.add(std::move(finding));
    for (Diagnostic& finding : BuildingRun::tripFindings(building))
        findings.add(std::move(finding));
    for (Diagnostic& finding : landingFindings(building)) findings.add(std::move(finding));
    if (options.suggestions) writeAll("-", moves);
    findings.throwIfAny();
    logInfo(options.common, "envc", "nothing found");
}

/// Returns the page of a building: of each storey that of its room, on sheets of its own.
ReportPage buildingPage(const EnvcOptions& options, const BuildingScene& building,
                        const std::vector<Diagnostic>& warnings) {
    ReportPage page;
    const std::string& input = options.inputs.front();
    page.title = isStream(input) ? "Building" : baseName(input);
    double area = 0;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Scene& scene = *building.scenes[i];
        area += scene.environment.indoor().area();
        const Storey& storey = building.document.storeys[i];
        const std::string name = storey.record.has("name") ? storey.record.text("name") : storey.id;
        RoomPageInput room{scene, name, options.history_line};
        if (i == 0) room.warnings = warnings;
        ReportPage own = roomPage(room);
        for (std::size_t k = 0; k < own.sections.size(); ++k) {
            PageSection& section = own.sections[k];
            section.id = storey.id + '-' + section.id;
            section.title = name + ": " + section.title;
            section.begins_sheet |= k == 0 && i > 0;
            page.sections.push_back(std::move(section));
        }
    }
    page.subtitle = squareMetres(area) + " · " + building.document.digest();
    return typeset(std::move(page));
}

void writeReport(const EnvcOptions& options, const BuildingScene& building,
                 const std::vector<Diagnostic>& warnings) {
    const std::string kind = suffixOf(options.report);
    if (kind == "json") return writeAll(options.report, buildingInfoJson(building));
    const ReportPage page = buildingPage(options, building, warnings);
    writeAll(options.report, kind == "pdf" ? pdfOf(page) : htmlOf(page));
}

/// Writes the building and the files of its rooms.
void writeRecords(const std::string& output, const StoreyedDocument& building) {
    if (isStream(output))
        throw UsageError(
            "a building in records is several files: name it with -o FILE.env, or "
            "write it as YAML (--to yaml)");
    const fs::path folder = fs::path(output).parent_path();
    const std::vector<BuildingPart> parts =
        writeBuildingRecords(building, fs::path(output).stem().string());
    std::vector<NamedBytes> files;
    for (const BuildingPart& part : parts) {
        files.push_back({part.name.empty() ? output : (folder / part.name).string(), part.bytes});
        if (!part.name.empty()) claimOutput(files.back().name, "the room of a storey");
    }
    writeTogether(files);
}

/// Writes a file for each storey, as of its room alone.
void writeStoreys(const EnvcOptions& options, const BuildingScene& building) {
    for (std::size_t i = 0; i < building.document.storeys.size(); ++i) {
        const Storey& storey = building.document.storeys[i];
        EnvcOptions own = options;
        own.common.output = storeyFile(options.common.output, storey.id);
        claimOutput(own.common.output, "the storey " + storey.id);
        if (options.format->write_records == nullptr) {
            writeProduct(own, *building.scenes[i], *storey.room, nullptr);
            continue;
        }
        Document room = *storey.room;
        room.history.insert(room.history.end(), building.document.history.begin(),
                            building.document.history.end());
        writeAll(own.common.output, options.format->write_records(std::move(room)));
    }
}

void writeProduct(const EnvcOptions& options, const BuildingScene& building) {
    if (isStoreyPattern(options.common.output)) return writeStoreys(options, building);
    const std::string& output = options.common.output;
    const std::string_view format = options.format->name;
    if (format == "env") return writeRecords(output, building.document);
    if (format == "yaml") return writeAll(output, writeBuildingYaml(building.document));
    if (format == "glb") {
        OutputFile file(output);
        writeBuildingGlb(building, [&file](std::string_view bytes) { file.write(bytes); });
        return file.commit();
    }
    const std::string& input = options.inputs.front();
    const PictureFormat picture = format == "svg"   ? PictureFormat::Svg
                                  : format == "pdf" ? PictureFormat::Pdf
                                                    : PictureFormat::Png;
    writeAll(output, drawBuilding(building, picture, options.width,
                                  isStream(input) ? "" : baseName(input)));
}

}  // namespace

namespace {

/// Adds the building that layouts name if there is no other input.
std::vector<RawInput> withNamedBuilding(std::vector<RawInput> raw, const InputRequest& request,
                                        const StoreyChoice& choice) {
    if (!request.compiles || !std::all_of(raw.begin(), raw.end(), [](const RawInput& input) {
            return beginsLayout(input.bytes);
        }))
        return raw;
    for (const RawInput& input : raw) {
        const auto reference = environmentReference(
            parseDocument(input.bytes, input.name, request.import, sceneSchemas()));
        if (!reference || reference->file.empty() || reference->file == "-") continue;
        const std::string file = sideFilePath(input.name, reference->file);
        std::error_code missing;
        if (!fs::is_regular_file(file, missing)) break;  // readInputs() reports it
        std::string bytes = readAll(file);
        if (mayHoldStoreys(bytes, choice)) raw.push_back({file, std::move(bytes)});
        break;
    }
    return raw;
}

}  // namespace

std::optional<StoreyedDocument> readWholeBuilding(const EnvcOptions& options,
                                                  const std::vector<RawInput>& inputs,
                                                  const InputRequest& request) {
    const std::vector<RawInput> raw = withNamedBuilding(inputs, request, options.rules.storeys);
    const StoreyChoice& choice = options.rules.storeys;
    // A height of the building and a point in it are of one storey.
    const bool names_storey =
        choice.isEmpty() &&
        (request.import.slice_walls || !request.import.inside.empty() || options.list_rooms);
    const auto is_whole = [&](const RawInput& input) {
        return mayHoldStoreys(input.bytes, choice) && !(names_storey && isIfc(input.bytes));
    };
    const auto found = std::find_if(raw.begin(), raw.end(), is_whole);
    if (found == raw.end()) return std::nullopt;
    ImportOptions import = request.import;
    import.load_files = request.compiles;
    const auto whole = readStoreys(found->bytes, found->name, import, choice);
    if (!whole) return std::nullopt;
    StoreyedDocument building = chosenStoreys(*whole, choice, found->name);
    const std::string option = optionOfOneRoom(options);
    const bool is_named = isStoreyPattern(options.common.output);
    // What a room alone can be made into, the only storey can; the others keep what the building
    // says of it.
    if (choice.isEmpty() && building.storeys.size() == 1 &&
        (!option.empty() || (holdsOneStorey(options) && !is_named)))
        return std::nullopt;
    if (!option.empty()) refuseSeveralRooms(option, building);
    mustBeOneProduct(options.common);
    if (holdsOneStorey(options))
        mustNameStoreys(options.common.output, options.format->name, options.format->suffix);
    for (const RawInput& input : raw) {
        if (&input == &*found) continue;
        const Document layout = parseDocument(input.bytes, input.name, import, sceneSchemas());
        if (layout.kind != DocumentKind::Layout || is_whole(input))
            throw UsageError(displayName(input.name) + " beside the building " +
                             displayName(found->name) + ": a building goes with layouts alone");
        addLayout(layoutOfStoreys(layout, *whole, building, building.warnings), building);
        building.sources.push_back(input.name);
    }
    applyEdits(options, found->name, import, building);
    addZones(options.zones, building);
    building.sources.insert(building.sources.begin(), found->name);
    building.history.push_back(options.history_line);
    if (options.format != nullptr) rebaseRooms(options, found->name, building);
    return building;
}

EnvcOptions optionsOfRoom(EnvcOptions options, const std::string& operand) {
    if (options.format != nullptr)
        options.common.output =
            roomFile(options.common.output, options.rules.storeys.one(), operand);
    return options;
}

void writeBuilding(const EnvcOptions& options, StoreyedDocument document,
                   const ImportReport& report) {
    warn(options.common, "envc", report.choices);
    if (!options.check) warn(options.common, "envc", document.warnings);
    for (const std::string& note : document.notes) logInfo(options.common, "envc", note);
    const std::vector<std::string> files = document.sources;
    const std::vector<Diagnostic> warnings = document.warnings;
    if (options.format != nullptr && options.format->write_records != nullptr) {
        writeProduct(options, {std::move(document), {}, {}});
        return writeDependencies(options.common, files);
    }
    std::vector<const Document*> rooms;
    for (const Storey& storey : document.storeys) rooms.push_back(storey.room.get());
    const DeviceCatalogue& devices = devicesFor(std::span<const Document* const>(rooms));
    const BuildingScene building = makeBuildingScene(std::move(document), {}, devices);
    if (options.check) return check(options, building, report);
    if (!options.report.empty()) writeReport(options, building, warnings);
    if (options.info)
        writeAll(options.common.output,
                 options.json ? buildingInfoJson(building) : buildingInfoText(building));
    else if (options.format != nullptr)
        writeProduct(options, building);
    writeDependencies(options.common, files);
}

}  // namespace ispace
