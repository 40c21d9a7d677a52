// SPDX-License-Identifier: GPL-3.0-or-later
// A layout of a building names sensors with their storey, STOREY/ID; one of a room does not. The
// functions here turn one into the other, by the digest of the room where no storey is named, and
// find the part of a building's record that belongs to a storey.
#include "cli/storey_operands.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "env/zone.h"
#include "io/exporters.h"
#include "io/glb/glb_read.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/run/run_reader.h"
#include "site/chosen_storeys.h"

namespace ispace {

namespace {

/// Returns the storey with this id or name; for "" the only one.
const Storey& storeyOrSole(const StoreyedDocument& building, const std::string& storey) {
    return storey.empty() && building.storeys.size() == 1 ? building.storeys.front()
                                                          : building.storey(storey);
}

}  // namespace

Document chosenStorey(const StoreyedDocument& building, const std::string& operand,
                      const std::string& storey) {
    if (storey.empty() && building.storeys.size() > 1)
        throw UsageError(displayName(operand) + " is a building of the storeys " +
                         building.storeyList() + ": choose one with --storey ID");
    Document room = *storeyOrSole(building, storey).room;
    room.sources = building.sources;
    return room;
}

bool beginsLayout(std::string_view bytes) {
    return withoutBom(bytes).starts_with("#3dm") || bytes.starts_with("# ispace yaml 1 layout");
}

bool namesStoreys(const Document& layout) {
    return std::any_of(layout.records.begin(), layout.records.end(), [](const Record& record) {
        return record.schema().type != RecordType::Meta &&
               record.writtenId().find('/') != std::string::npos;
    });
}

Document layoutOfRoom(const Document& layout, const StoreyedDocument& building,
                      std::span<const Record> room) {
    const std::string digest = environmentDigest(room);
    for (const Storey& storey : building.storeys)
        if (environmentDigest(storey.room->records) == digest)
            return layoutOfStorey(layout, building, storey.id);
    return layout;
}

Document layoutOfStorey(const Document& layout, const StoreyedDocument& building,
                        const std::string& storey) {
    const Storey& chosen = storeyOrSole(building, storey);
    Document own = layout;
    if (namesStoreys(layout)) {
        own.records =
            layoutsOf(layout, building)[static_cast<std::size_t>(&chosen - building.storeys.data())]
                .records;
        for (const Record& record : layout.records)
            if (record.keyword() == "environment") own.records.insert(own.records.begin(), record);
    }
    for (Record& record : own.records)
        if (record.keyword() == "environment" && record.has("digest") &&
            record.text("digest") == building.digest())
            record.set("digest", environmentDigest(chosen.room->records));
    return own;
}

bool holdsBuilding(const std::string& folder) {
    return !folder.empty() && std::filesystem::exists(folder + '/' + kRecordedBuilding) &&
           !std::filesystem::exists(RecordedFiles(folder).robots);
}

std::string recordedBuilding(const std::string& folder) {
    if (folder.empty()) return "";
    checkRecordFolder(folder);
    return holdsBuilding(folder) ? fileOfRecord(folder, kRecordedBuilding) : "";
}

void mustHoldRecord(const std::string& option, const std::string& folder) {
    checkRecordFolder(folder);
    if (!holdsBuilding(folder) && !std::filesystem::exists(RecordedFiles(folder).robots))
        throw UsageError(option + ": " + folder + " holds no record of a run");
}

bool recordNamesStorey(const std::string& folder, const std::string& storey) {
    RunReader run(folder);
    if (!run.next()) return false;
    return std::any_of(
        run.members().begin(), run.members().end(),
        [prefix = storey + '/'](const RunMember& one) { return one.id.starts_with(prefix); });
}

std::string recordOfStorey(const std::string& folder, const Storey& storey) {
    return storey.id.empty() ? folder : folder + '/' + storey.id;
}

namespace {

ImportOptions importOf(const SceneRules& rules, ImportReport* report = nullptr) {
    ImportOptions options;
    options.report = report;
    options.includes = rules.includes;
    options.max_work.max = rules.max_work;
    return options;
}

/// Reads a file that is seen before it is read as a room; empty for compiled rooms, which are read
/// in parts, and for streams with rooms, which are left to their readers.
std::optional<std::string> glance(const std::string& operand, const StoreyChoice& choice) {
    if (isStream(operand)) {
        const std::string& kept = peekStream(operand);
        const bool is_ours = mayHoldStoreys(kept, choice) || beginsLayout(kept);
        return is_ours ? std::optional(kept) : std::nullopt;
    }
    if (isGlbRoom(operand)) return std::nullopt;
    return readAll(operand);
}

bool hasPlaced(const StoreyedDocument& building, bool (*is_meant)(const SensorKind&)) {
    return std::any_of(building.storeys.begin(), building.storeys.end(), [&](const Storey& storey) {
        return std::any_of(
            storey.room->records.begin(), storey.room->records.end(), [&](const Record& record) {
                const SensorKind* const kind = sensorKind(record.keyword());
                return kind != nullptr && is_meant(*kind) &&
                       (record.has("at") || record.has("on") || kind->place != nullptr);
            });
    });
}

/// Compares the digest that the layout records with the building's, as for rooms. \throws
/// UsageError for a layout of one storey
void checkDigest(const Document& layout, const StoreyedDocument& building, bool is_operand,
                 std::optional<bool> same_environment, std::vector<Diagnostic>& warnings) {
    const auto recorded = environmentReference(layout);
    if (!same_environment.value_or(true) || !recorded || recorded->digest.empty() ||
        recorded->digest == building.digest())
        return;
    for (const Storey& storey : building.storeys)
        if (recorded->digest == environmentDigest(storey.room->records))
            throw UsageError("the layout was made for the storey " + storey.id +
                             ": choose it with --storey " + storey.id);
    Diagnostic finding = recorded->record.finding(
        "digest",
        "the layout was made for another building: arrange again, or accept it with "
        "--any-environment");
    if (same_environment || !is_operand) throw FormatError(std::move(finding));
    finding.severity = Severity::Warning;
    warnings.push_back(std::move(finding));
}

/// The operands, recognised by content.
struct Operands {
    std::string environment, layout;
    std::optional<std::string> building;  ///< bytes of the environment if it is one
    std::optional<Document> layout_document;
    bool is_named = true;  ///< the environment is an operand
};

Document readLayout(const std::string& bytes, const std::string& operand, const SceneRules& rules) {
    Document layout = parseDocument(bytes, operand, importOf(rules), sceneSchemas());
    if (layout.kind != DocumentKind::Layout)
        throw FormatError(
            {displayName(operand), 0, 0, "an environment, where a layout (`#3dm 1`) is wanted"});
    return layout;
}

std::optional<Operands> findBuilding(const SceneRequest& request) {
    Operands found;
    const StoreyChoice& choice = request.rules.storeys;
    std::vector<std::string> operands = request.operands;
    if (operands.empty() && request.layout_from_stdin) operands.emplace_back("-");
    std::string unknown;  // a stream that is neither, which is to be the layout
    for (const std::string& operand : operands) {
        const auto bytes = glance(operand, choice);
        if (bytes && mayHoldStoreys(*bytes, choice)) {
            if (found.building)
                throw UsageError("two environments given, one is wanted: " + operand);
            found.building = bytes;
            found.environment = operand;
        } else if (bytes && beginsLayout(*bytes)) {
            if (!found.layout.empty())
                throw UsageError("two layouts given, one is wanted: " + operand);
            found.layout = operand;
            found.layout_document = readLayout(*bytes, operand, request.rules);
        } else if (isStream(operand) && unknown.empty()) {
            unknown = operand;
        } else {
            return std::nullopt;
        }
    }
    if (!unknown.empty()) {
        if (!found.building || !found.layout.empty()) return std::nullopt;
        found.layout = unknown;
    }
    if (!found.building && found.layout_document) {
        const auto reference = environmentReference(*found.layout_document);
        if (!reference || reference->file.empty() || reference->file == "-") return std::nullopt;
        found.environment = sideFilePath(found.layout, reference->file);
        std::error_code missing;
        if (!std::filesystem::is_regular_file(found.environment, missing))
            return std::nullopt;  // readScene() reports it
        const auto bytes = glance(found.environment, choice);
        if (bytes && mayHoldStoreys(*bytes, choice)) found.building = bytes;
        found.is_named = false;
    }
    if (!found.building) return std::nullopt;
    return found;
}

/// Returns true for a building of one storey, which is a room. That of a record stays what it was
/// recorded as, with a folder for its storey.
bool isRoom(const StoreyedDocument& building, const std::string& operand) {
    if (building.storeys.size() != 1) return false;
    const std::filesystem::path file(operand);
    const std::string folder = (file.parent_path() / building.storeys.front().id).string();
    return file.filename() != kRecordedBuilding ||
           !std::filesystem::exists(RecordedFiles(folder).robots);
}

}  // namespace

std::optional<BuildingInput> readBuildingInput(const SceneRequest& request) {
    const StoreyChoice& choice = request.rules.storeys;
    if (choice.isOne()) return std::nullopt;
    mustReadStdinOnce(request.operands);
    auto found = findBuilding(request);
    if (!found) return std::nullopt;
    ImportReport report;
    const std::optional<StoreyedDocument> whole =
        readStoreys(*found->building, found->environment, importOf(request.rules, &report), choice);
    if (!whole || (choice.isEmpty() && isRoom(*whole, found->environment))) return std::nullopt;
    StoreyedDocument document = chosenStoreys(*whole, choice, found->environment);
    BuildingInput input;
    input.choices = std::move(report.choices);
    input.named = request.operands;
    if (input.named.empty()) input.named.emplace_back("-");
    if (found->layout.empty() && request.layout_from_stdin &&
        !hasPlaced(document, request.is_meant)) {
        if (found->environment == "-")
            throw UsageError("the building on stdin holds no placed sensor: give a LAYOUT");
        found->layout = "-";
        input.named.emplace_back("-");
    }
    if (!found->layout.empty() && !found->layout_document) {
        const std::string& layout = found->layout;
        const std::string bytes = readOperand(layout);
        if (bytes.empty())
            throw FormatError({displayName(layout), 0, 0,
                               "empty, where a layout (`#3dm 1`) is wanted: " +
                                   displayName(found->environment) + " holds no placed sensor"});
        found->layout_document = readLayout(bytes, layout, request.rules);
    }
    std::vector<Document> layouts;
    if (found->layout_document)
        found->layout_document =
            layoutOfStoreys(*std::move(found->layout_document), *whole, document, input.choices);
    input.files = {found->environment};
    input.warnings = document.warnings;
    if (found->layout_document) {
        checkDigest(*found->layout_document, document, found->is_named,
                    request.rules.same_environment, input.warnings);
        layouts = layoutsOf(*found->layout_document, document);
        input.files.push_back(found->layout);
    }
    input.files.insert(input.files.end(), document.sources.begin(), document.sources.end());
    std::vector<const Document*> all;
    for (const Storey& storey : document.storeys) all.push_back(storey.room.get());
    for (const Document& layout : layouts) all.push_back(&layout);
    const DeviceCatalogue& devices = devicesFor(std::span<const Document* const>(all));
    input.building = makeSiteScene(std::move(document), layouts, devices);
    input.layout = std::move(found->layout_document);
    input.environment_operand = std::move(found->environment);
    input.layout_operand = std::move(found->layout);
    return input;
}

namespace {

/// Returns those of these storeys which have the doors of a text. \throws UsageError with the doors
/// of all storeys if there are none
std::vector<std::size_t> storeysWithDoors(const std::string& text, const StoreyText& split,
                                          const SiteScene& building) {
    const std::string& doors = split.text;
    const std::size_t comma = doors.rfind(',');
    const Glob wanted(doors.substr(
        kDoorPrefix.size(), comma == std::string::npos ? comma : comma - kDoorPrefix.size()));
    std::vector<std::size_t> storeys;
    for (const std::size_t storey : split.storeys) {
        const std::vector<Doorway> all = doorwaysOf(building.scenes[storey]->environment);
        if (std::any_of(all.begin(), all.end(),
                        [&](const Doorway& door) { return wanted.matches(door.id); }))
            storeys.push_back(storey);
    }
    if (!storeys.empty()) return storeys;
    std::string list;
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        if (const std::string its =
                doorList(building.scenes[i]->environment, building.document.storeys[i].id + '/');
            !its.empty())
            list += (list.empty() ? "" : ", ") + its;
    throw UsageError(
        "--zone: " + excerpt(text) + " meets no door" +
        (list.empty() ? ": the building has none" : "; the doors of the building: " + list));
}

}  // namespace

void addZones(std::span<const std::string> zones, SiteScene& building) {
    const StoreyedDocument& document = building.document;
    std::map<std::size_t, std::vector<std::string>> by_storey;
    for (const std::string& text : zones) {
        if (building.isRoomAlone()) {
            by_storey[0].push_back(text);
            continue;
        }
        const std::size_t slash = text.find('/');
        if (slash == std::string::npos && !text.starts_with(kDoorPrefix))
            throw UsageError("--zone: " + excerpt(text) + " names no storey, as in " +
                             document.storeys.front().id + "/rect:0,0,1,1");
        const StoreyText split = splitStoreys(document, "--zone", text);
        for (const std::size_t storey : split.text.starts_with(kDoorPrefix)
                                            ? storeysWithDoors(text, split, building)
                                            : split.storeys)
            by_storey[storey].push_back(split.text);
    }
    for (const auto& [storey, texts] : by_storey) {
        const Scene& scene = *building.scenes[storey];
        std::vector<Record> records = scene.records;
        try {
            for (Record& zone : zoneRecords(texts, scene.environment, sceneSchemas()))
                records.push_back(std::move(zone));
        } catch (const UsageError& error) {
            if (building.isRoomAlone()) throw;
            throw UsageError("--zone: " + document.storeys[storey].id + ": " + error.what());
        }
        building.scenes[storey] =
            std::make_shared<const Scene>(makeScene(std::move(records), scene, building.devices));
    }
}

namespace {

constexpr std::string_view kMark = "%s";

}  // namespace

bool isStoreyPattern(std::string_view output) {
    return output.find(kMark) != std::string_view::npos;
}

std::string storeyFile(std::string pattern, const std::string& id) {
    for (std::size_t at = pattern.find(kMark); at != std::string::npos;
         at = pattern.find(kMark, at + id.size()))
        pattern.replace(at, kMark.size(), id);
    return pattern;
}

void mustBeOneFile(const std::string& option, std::string_view file) {
    if (isStoreyPattern(file))
        throw UsageError(option + ": it is one file, also of a building: leave out %s");
}

void mustBeOneProduct(const CommonOptions& options) {
    if (options.dependencies.wanted && isStoreyPattern(options.output))
        throw UsageError("-MD writes a rule for one product, and %s makes a file for each storey");
}

std::string roomFile(const std::string& output, const std::string& storey,
                     const std::string& operand) {
    if (!storey.empty()) return storeyFile(output, storey);
    return storeyFile(output,
                      isStream(operand) ? "room" : std::filesystem::path(operand).stem().string());
}

void mustNameStoreys(std::string_view output, std::string_view format, std::string_view suffix) {
    if (isStoreyPattern(output)) return;
    throw UsageError(std::string(format) +
                     " holds one storey: name the files with %s for its id (-o 'map-%s." +
                     std::string(suffix) + "'), or choose one with --storey");
}

}  // namespace ispace
