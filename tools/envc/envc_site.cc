// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the inputs of envc.
#include "envc/envc_site.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/run_files.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/site_operands.h"
#include "cli/storey_operands.h"
#include "env/environment.h"
#include "env/zone.h"
#include "io/exporters.h"
#include "scene/placement_schemas.h"
#include "site/building_imports.h"
#include "site/chosen_storeys.h"
#include "site/site_edit.h"
#include "site/site_scene.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFormatsOfBuildings[] = {"glb", "env", "yaml", "svg", "png", "pdf"};

/// Returns true for a product of which a file holds one storey.
bool holdsOneStorey(const EnvcOptions& options) {
    return options.format != nullptr &&
           (options.slice ||
            std::find(std::begin(kFormatsOfBuildings), std::end(kFormatsOfBuildings),
                      options.format->name) == std::end(kFormatsOfBuildings));
}

/// \param found receives the rooms of plans; null: not requested
/// \param report receives the other messages of the imports
InputRequest requestOf(const EnvcOptions& options, FoundRooms* found, ImportReport& report) {
    InputRequest request;
    request.inputs = options.inputs;
    request.import = options.import;
    request.import.found = found;
    request.import.report = &report;
    request.import.storey = options.rules.storeys.one();
    request.compiles = options.format == nullptr || options.format->write != nullptr;
    request.import.load_files = request.compiles;
    request.added = addedRecords(options.edits, sceneSchemas());
    request.import.includes = options.rules.includes;
    request.import.max_work.max = options.rules.max_work;
    request.same_environment = options.rules.same_environment;
    request.may_be_empty = !options.edits.empty();
    return request;
}

/// Warns if --resolution is meant for a map that states its own.
void warnOfResolution(const EnvcOptions& options, const std::vector<RawInput>& raw,
                      Document& document) {
    const bool is_of_product = options.format != nullptr && options.format->needs_beside;
    if (!options.import.resolution || is_of_product) return;
    for (const RawInput& input : raw)
        if (isRosMap(input.bytes))
            document.warnings.push_back(
                {displayName(input.name), 0, 0,
                 "--resolution is ignored: the map states the resolution of its picture",
                 Severity::Warning});
}

/// Returns the folder to which names of files in a product are relative.
std::string folderOf(const std::string& output) {
    return isStream(output) ? "" : fs::path(output).parent_path().string();
}

/// Rejects models of robots and sensors that the catalogue lacks, which all other tools would do.
void checkModels(const Document& document) {
    Diagnostics findings;
    const DeviceCatalogue& devices = devicesFor({&document});
    for (const Record& record : document.records) {
        if (record.keyword() != "robot" && sensorKind(record.keyword()) == nullptr) continue;
        try {
            static_cast<void>(deviceOf(record, devices));
        } catch (const FormatError& error) {
            findings.add(error);
        }
    }
    findings.throwIfAny();
}

/// Adds the zones to a room, as records. \throws UsageError as zoneRecords()
void addZones(std::span<const std::string> zones, Document& document) {
    if (zones.empty()) return;
    // Meshes that are not loaded bound no room.
    std::vector<Record> records = document.records;
    std::vector<std::string> ids = assignIds(records);
    for (std::size_t i = records.size(); i-- > 0;)
        if (records[i].keyword() == "mesh") {
            records.erase(records.begin() + static_cast<std::ptrdiff_t>(i));
            ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(i));
        }
    for (Record& zone : zoneRecords(zones, Environment(records, ids), sceneSchemas()))
        document.records.push_back(std::move(zone));
}

/// Reads all inputs as one room.
void readRoom(const EnvcOptions& options, const std::vector<RawInput>& raw,
              const InputRequest& request, EnvcSite& site) {
    Document document = readInputs(raw, request, site.other_rooms);
    warnOfResolution(options, raw, document);
    if (!options.rules.storeys.isEmpty() && !site.report.has_storeys)
        throw UsageError("--storey is about buildings, and no input is one");
    document.records = edited(std::move(document.records), options.edits, sceneSchemas());
    if (request.compiles) loadFiles(document, "", request.import);
    if (options.format == nullptr || !options.format->takes_zones)
        addZones(options.zones, document);
    document.history.push_back(options.history_line);
    if (!request.compiles) {
        if (!options.edits.empty()) checkModels(document);
    } else {
        // The model contains its environment: a path to another file would only go stale.
        std::erase_if(document.records,
                      [](const Record& record) { return record.keyword() == "environment"; });
        document.kind = DocumentKind::Environment;
    }
    if (options.format != nullptr)
        rebaseFiles(document.records, "", folderOf(options.common.output));
    site.files = options.inputs;
    site.files.insert(site.files.end(), document.sources.begin(), document.sources.end());
    const std::vector<std::string> notes = document.notes;
    const std::vector<Diagnostic> warnings = document.warnings;
    site.document = roomAlone(std::move(document), nullptr, {}).document;
    site.document.notes = notes;
    site.document.warnings = warnings;
}

/// Adds the records of a layout to the rooms of their storeys.
void addLayout(const Document& layout, StoreyedDocument& building) {
    // That of an only storey is the layout of a room, with plain ids.
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

/// Applies the edits of the command. \param operand of the building; names of files are relative to
/// its folder
void applyEdits(const EnvcOptions& options, const std::string& operand, const ImportOptions& import,
                StoreyedDocument& building) {
    std::vector<std::shared_ptr<const Document>> before;
    for (const Storey& storey : building.storeys) before.push_back(storey.room);
    editSite(building, options.edits);
    if (!import.load_files) return;
    for (Storey& storey : building.storeys) {
        if (std::find(before.begin(), before.end(), storey.room) != before.end()) continue;
        auto room = std::make_shared<Document>(*storey.room);
        loadFiles(*room, operand, import);
        storey.room = std::move(room);
    }
}

/// Adds zones to the rooms of their storeys: `ground/rect:1,1,2,2`, `*/door:*`. Storeys that share
/// a room keep sharing it if they get the same zones. \throws as forEachRoomOf() and zoneRecords()
void addZones(std::span<const std::string> zones, StoreyedDocument& building) {
    for (const std::string& text : zones) {
        std::map<const Document*, std::shared_ptr<const Document>> changed;
        forEachRoomOf(building, "--zone", text, [&](std::size_t i, const std::string& own) {
            std::shared_ptr<const Document>& shared = building.storeys[i].room;
            std::shared_ptr<const Document>& known = changed[shared.get()];
            if (known == nullptr) {
                auto room = std::make_shared<Document>(*shared);
                addZones(std::vector<std::string>{own}, *room);
                known = std::move(room);
            }
            shared = known;
        });
    }
}

/// Makes names of files in the rooms relative to the folder of the output. Storeys keep sharing
/// rooms.
void rebaseRooms(const EnvcOptions& options, const std::string& from, StoreyedDocument& building) {
    std::map<const Document*, std::shared_ptr<const Document>> made;
    for (Storey& storey : building.storeys) {
        std::shared_ptr<const Document>& known = made[storey.room.get()];
        if (known == nullptr) {
            auto room = std::make_shared<Document>(*storey.room);
            rebaseFiles(room->records, folderOf(from), folderOf(options.common.output));
            known = std::move(room);
        }
        storey.room = known;
    }
}

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

/// Reads the building if one input is a building of which no single storey is chosen, with the
/// layouts beside it. \returns false for rooms
bool readBuilding(const EnvcOptions& options, const std::vector<RawInput>& inputs,
                  const InputRequest& request, EnvcSite& site) {
    const std::vector<RawInput> raw = withNamedBuilding(inputs, request, options.rules.storeys);
    const StoreyChoice& choice = options.rules.storeys;
    // A height of the building and a point in it are of one storey.
    const bool names_storey =
        choice.isEmpty() &&
        (request.import.slice_walls || !request.import.inside.empty() || options.list_rooms);
    const auto is_whole = [&](const RawInput& input) {
        return mayHoldStoreys(input.bytes, choice) &&
               !(names_storey && buildingImporter(input.bytes) != nullptr);
    };
    const auto found = std::find_if(raw.begin(), raw.end(), is_whole);
    if (found == raw.end()) return false;
    ImportOptions import = request.import;
    import.load_files = request.compiles;
    const auto whole = readStoreys(found->bytes, found->name, import, choice);
    if (!whole) return false;
    StoreyedDocument building = chosenStoreys(*whole, choice, found->name);
    const bool is_named = isStoreyPattern(options.common.output);
    // What a room alone can be made into, the only storey can; the others keep what the building
    // says of it.
    if (choice.isEmpty() && building.storeys.size() == 1 &&
        (options.list_rooms || (holdsOneStorey(options) && !is_named)))
        return false;
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
    if (options.format == nullptr || !options.format->takes_zones)
        addZones(options.zones, building);
    building.sources.insert(building.sources.begin(), found->name);
    building.history.push_back(options.history_line);
    if (options.format != nullptr) rebaseRooms(options, found->name, building);
    site.files = building.sources;
    site.document = std::move(building);
    return true;
}

}  // namespace

EnvcSite readEnvcSite(const EnvcOptions& options) {
    EnvcSite site;
    site.found.all_storeys = options.list_rooms;
    const bool wants_rooms = options.list_rooms || !options.report.empty() ||
                             (options.format != nullptr && options.format->draws_rooms);
    const InputRequest request =
        requestOf(options, wants_rooms ? &site.found : nullptr, site.report);
    const std::vector<RawInput> raw = readRawInputs(request);
    if (!readBuilding(options, raw, request, site)) {
        // What was read of an only storey is read again as a room.
        site.found = FoundRooms();
        site.found.all_storeys = options.list_rooms;
        site.report = {};
        readRoom(options, raw, request, site);
    }
    if (options.list_rooms && !site.found.any_plan)
        throw UsageError(
            site.document.isRoomAlone()
                ? "--rooms list is about plans, maps and buildings, and no input is one; a mesh "
                  "becomes a plan with --slice-walls"
                : "--rooms list: no storey of the building is a plan or map");
    return site;
}

}  // namespace ispace
