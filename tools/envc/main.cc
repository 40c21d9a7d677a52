// SPDX-License-Identifier: GPL-3.0-or-later
// envc: compiles rooms and layouts into a model, checks, converts, edits and draws them.
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/run_files.h"
#include "cli/job_server.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "env/environment.h"
#include "env/zone.h"
#include "envc/envc_building.h"
#include "envc/envc_options.h"
#include "io/exporters.h"
#include "io/importers.h"
#include "report/page/room_page.h"
#include "scene/devices.h"
#include "scene/findings/findings.h"
#include "scene/findings/remedies.h"
#include "scene/placement_schemas.h"
#include "scene/sensor/sensor.h"
#include "sim/course_check.h"
#include "tools.h"

namespace {

using namespace ispace;
namespace fs = std::filesystem;

/// \param found receives the rooms of plans; null: not requested
/// \param report receives the other messages of the imports
InputRequest requestOf(const EnvcOptions& options, FoundRooms* found, ImportReport& report) {
    InputRequest request;
    request.inputs = options.inputs;
    request.import = options.import;
    addModelFolders(request.import);
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

Document readModel(const EnvcOptions& options, const std::vector<RawInput>& raw,
                   const InputRequest& request, ImportReport& report) {
    std::vector<Diagnostic> other_rooms;
    Document document = readInputs(raw, request, other_rooms);
    warnOfResolution(options, raw, document);
    if (!options.rules.storeys.isEmpty() && !report.has_storeys)
        throw UsageError("--storey is about buildings, and no input is one");
    warn(options.common, "envc", other_rooms);
    document.records = edited(std::move(document.records), options.edits, sceneSchemas());
    if (request.compiles) loadFiles(document, "", request.import);
    if (options.format == nullptr || !options.format->takes_zones)
        addZones(options.zones, document);
    document.history.push_back(options.history_line);
    warn(options.common, "envc", report.choices);
    if (!options.check) warn(options.common, "envc", document.warnings);
    for (const std::string& note : document.notes) logInfo(options.common, "envc", note);
    return document;
}

/// Makes names of files in a product relative to its folder.
void rebaseTo(const std::string& output, Document& document) {
    rebaseFiles(document.records, "",
                isStream(output) ? "" : fs::path(output).parent_path().string());
}

/// Reports the warnings of an import together with the findings of the scene; the former also if
/// the scene cannot be built. \throws FormatError with all findings
void check(const EnvcOptions& options, const Document& document, const ImportReport& report,
           const DeviceCatalogue& devices) {
    Diagnostics findings;
    for (const Diagnostic& warning : document.warnings) findings.add(warning);
    for (const Diagnostic& doubt : report.doubts) findings.add(doubt);
    try {
        const Scene scene = makeScene(document, nullptr, devices);
        // arrange accepts a sensor without a position: it is reported, but is no error.
        warn(options.common, "envc", sceneWarnings(scene, {.checks = {"unplaced"}}));
        FindingFilter mistakes;
        for (const SceneCheck& check : sceneChecks())
            if (check.name != "unplaced") mistakes.checks.push_back(check.name);
        const std::vector<Finding> found = checkScene(scene, mistakes);
        for (const Finding& finding : found) findings.add(finding.diagnostic());
        const std::vector<Finding> courses = checkCourses(scene);
        for (const Finding& finding : courses) findings.add(finding.diagnostic());
        if (options.suggestions) {
            const auto most = static_cast<std::size_t>(*options.suggestions);
            const std::vector<Remedy> remedies =
                remediesOf(scene, found, mistakes, most, devices,
                           [](const Scene& one) { return checkCourses(one).size(); });
            writeAll("-", remediesText(options, found.size() + courses.size(), remedies));
        }
    } catch (const FormatError& error) {
        findings.add(error);
    }
    findings.throwIfAny();
}

/// The room to be compiled.
struct Room {
    Document document;
    Scene scene;
};

Room makeRoom(Document document, const DeviceCatalogue& devices) {
    Scene scene = makeScene(document, nullptr, devices);
    return {std::move(document), std::move(scene)};
}

void writeReport(const EnvcOptions& options, const Scene& scene, const FoundRooms* found,
                 const std::vector<Diagnostic>& warnings) {
    const std::string kind = suffixOf(options.report);
    if (kind == "json")
        return writeAll(options.report,
                        infoJson(describe(scene.environment, scene.records, scene.digest())));
    RoomPageInput page{scene, "", options.history_line, found, warnings};
    if (options.inputs.front() != "-") page.name = baseName(options.inputs.front());
    const ReportPage pages = roomPage(page);
    writeAll(options.report, kind == "pdf" ? pdfOf(pages) : htmlOf(pages));
}

void compile(const EnvcOptions& options, Document document, const FoundRooms* found,
             const ImportReport& report) {
    // The model contains its environment: a path to another file would only go stale.
    std::erase_if(document.records,
                  [](const Record& record) { return record.keyword() == "environment"; });
    document.kind = DocumentKind::Environment;
    if (options.format != nullptr) rebaseTo(options.common.output, document);
    const DeviceCatalogue& devices = devicesFor({&document});
    if (options.check) {
        check(options, document, report, devices);
        logInfo(options.common, "envc", "nothing found");
        return;
    }
    const std::vector<Diagnostic> warnings = document.warnings;
    const auto& [compiled, scene] = leftToExit(makeRoom(std::move(document), devices));
    const std::string& output = options.common.output;
    if (!options.report.empty()) writeReport(options, scene, found, warnings);
    if (options.info) {
        const EnvironmentInfo info = describe(scene.environment, scene.records, scene.digest());
        writeAll(output, options.json ? infoJson(info) : infoText(info));
    } else if (options.format != nullptr) {
        writeProduct(options, scene, compiled, found);
        logInfo(options.common, "envc",
                std::to_string(scene.records.size()) + " records compiled, indoor area " +
                    formatFixed(scene.environment.indoor().area(), 2) + " m2");
    }
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

void convert(const EnvcOptions& options, Document document) {
    const std::string& output = options.common.output;
    if (!options.edits.empty()) checkModels(document);
    rebaseTo(output, document);
    writeAll(output, options.format->write_records(std::move(document)));
}

void envc(const EnvcOptions& options) {
    const ExportFormat* const format = options.format;
    if (format != nullptr && !format->binary.empty())
        refuseTerminal(options.common.output, std::string(format->binary));
    limitThreads(options.common.threads);
    if (options.task) return options.task();
    claimOutputs(options.common);
    if (format != nullptr) claimOutput(besideOf(options), std::string(format->beside_role));
    claimOutput(options.report, "--report");
    keepFreedMemory(options.inputs);
    FoundRooms found;
    found.all_storeys = options.list_rooms;
    const bool wants_rooms =
        options.list_rooms || !options.report.empty() || (format != nullptr && format->draws_rooms);
    ImportReport report;
    const InputRequest request = requestOf(options, wants_rooms ? &found : nullptr, report);
    const std::vector<RawInput> raw = readRawInputs(request);
    if (auto building = readWholeBuilding(options, raw, request))
        return writeBuilding(options, *std::move(building), report);
    Document document = readModel(options, raw, request, report);
    const EnvcOptions own = optionsOfRoom(options, raw.front().name);
    std::vector<std::string> files = options.inputs;
    files.insert(files.end(), document.sources.begin(), document.sources.end());
    if (options.list_rooms && !found.any_plan)
        throw UsageError(
            "--rooms list is about plans, maps and buildings, and no input is one; a mesh becomes "
            "a "
            "plan with --slice-walls");
    if (options.list_rooms)
        writeAll(options.common.output, options.json ? roomsJson(found) : roomsText(found));
    else if (format != nullptr && format->write_records != nullptr)
        convert(own, std::move(document));
    else
        compile(own, std::move(document), &found, report);
    writeDependencies(own.common, files);
}

}  // namespace

int ispace::runEnvc(int argc, char** argv) {
    return runTool("envc", argc, argv,
                   [](int count, char** words) { envc(ispace::parseEnvcOptions(count, words)); });
}
