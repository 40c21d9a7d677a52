// SPDX-License-Identifier: GPL-3.0-or-later
// Checks, describes, draws and writes what envc has read.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "cli/site_operands.h"
#include "cli/storey_operands.h"
#include "env/zone.h"
#include "envc/envc_site.h"
#include "extensions.h"
#include "scene/findings/findings.h"
#include "scene/findings/remedies.h"
#include "sim/course_check.h"
#include "site/coupling.h"
#include "site/site_edit.h"
#include "site/site_scene.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

/// Returns the scenes of the rooms. \throws FormatError as makeScene()
SiteScene sceneOf(const StoreyedDocument& document) {
    std::vector<const Document*> rooms;
    for (const Storey& storey : document.storeys) rooms.push_back(storey.room.get());
    return makeSiteScene(document, {}, devicesFor(std::span<const Document* const>(rooms)));
}

/// Returns moves that resolve findings of a storey, by the ids of the building.
std::string movesIn(const EnvcOptions& options, const SiteScene& building, std::size_t storey,
                    const FindingFilter& filter, int& left) {
    if (left == 0) return "";
    const auto scene = sceneOfSite(building, storey);
    const std::vector<Finding> found = checkScene(*scene, filter);
    const std::size_t count = found.size() + checkCourses(*scene).size();
    if (count == 0) return "";
    const std::vector<Remedy> remedies =
        remediesOf(*scene, found, filter, static_cast<std::size_t>(left), building.devices,
                   [](const Scene& one) { return checkCourses(one).size(); });
    left -= static_cast<int>(remedies.size());
    return building.document.storeys[storey].prefix() + remediesText(options, count, remedies);
}

/// Adds the findings of all rooms, each once, and of what joins them.
/// \returns moves that resolve some of them
std::string addFindings(const EnvcOptions& options, const SiteScene& building,
                        Diagnostics& findings) {
    FindingFilter mistakes;
    for (const SceneCheck& check : sceneChecks())
        if (check.name != "unplaced") mistakes.checks.push_back(check.name);
    const Coupling coupling(building);
    // arrange accepts a sensor without a position: it is reported, but is no error.
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
        if (options.suggestions) moves += movesIn(options, building, i, mistakes, moves_left);
        for (const Finding& finding : checkCourses(*scene)) {
            Diagnostic diagnostic = finding.diagnostic();
            diagnostic.message.insert(0, building.document.storeys[i].prefix());
            findings.add(std::move(diagnostic));
        }
    }
    if (building.isRoomAlone()) return moves;
    for (Diagnostic& finding : checkBuilding(building)) findings.add(std::move(finding));
    if (const auto of_runs = extensions().buildings().findings; of_runs != nullptr)
        for (Diagnostic& finding : of_runs(building)) findings.add(std::move(finding));
    return moves;
}

}  // namespace

void checkSite(const EnvcOptions& options, const EnvcSite& site) {
    Diagnostics findings;
    for (const Diagnostic& warning : site.document.warnings) findings.add(warning);
    for (const Diagnostic& doubt : site.report.doubts) findings.add(doubt);
    try {
        const std::string moves = addFindings(options, sceneOf(site.document), findings);
        if (options.suggestions) writeAll("-", moves);
    } catch (const FormatError& error) {
        findings.add(error);
    }
    findings.throwIfAny();
    logInfo(options.common, "envc", "nothing found");
}

namespace {

void writeReport(const EnvcOptions& options, const EnvcSite& site, const SiteScene& building) {
    const ReportGroup* const form = options.reports->of(options.report);
    if (form == nullptr) return writeAll(options.report, siteInfoJson(building));
    const std::string& input = options.inputs.front();
    const RoomReport report{building, isStream(input) ? "" : baseName(input), options.history_line,
                            &site.found, site.document.warnings};
    writeAll(options.report, form->bytesOf(form->page(report), options.report));
}

/// Writes a building as records: its file, and those of its rooms.
void writeRecordFiles(const std::string& output, const StoreyedDocument& building) {
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

/// Returns the name of the product of a storey.
std::string productOf(const EnvcOptions& options, const Storey& storey) {
    if (storey.id.empty()) return options.common.output;
    std::string name = storeyFile(options.common.output, storey.id);
    claimOutput(name, "the storey " + storey.id);
    return name;
}

/// Writes records without making scenes of them: those of a room, of each storey by its name, or of
/// the building.
void convert(const EnvcOptions& options, const StoreyedDocument& document) {
    const std::string& output = options.common.output;
    if (!document.isRoomAlone() && !isStoreyPattern(output)) {
        if (options.format->name == "env") return writeRecordFiles(output, document);
        return writeAll(output, writeBuildingYaml(document));
    }
    for (const Storey& storey : document.storeys) {
        Document room = *storey.room;
        room.history.insert(room.history.end(), document.history.begin(), document.history.end());
        writeAll(productOf(options, storey), options.format->write_records(std::move(room)));
    }
}

/// Returns for each storey those of the zones that it has. \throws as forEachRoomOf()
std::vector<std::vector<std::string>> zonesByStorey(const EnvcOptions& options,
                                                    const SiteScene& building) {
    std::vector<std::vector<std::string>> zones(building.scenes.size());
    for (const std::string& text : options.zones)
        forEachRoomOf(building.document, "--zone", text,
                      [&](std::size_t i, const std::string& own) {
                          static_cast<void>(readZones(own, building.scenes[i]->environment));
                          zones[i].push_back(own);
                      });
    return zones;
}

void writeProducts(const EnvcOptions& options, const EnvcSite& site, const SiteScene& building) {
    const StoreyedDocument& document = building.document;
    if (document.isRoomAlone())
        return writeProduct(options, *building.scenes.front(), *document.storeys.front().room,
                            &site.found);
    const std::string& output = options.common.output;
    if (isStoreyPattern(output)) {
        std::vector<std::vector<std::string>> zones(building.scenes.size());
        if (options.format->takes_zones) zones = zonesByStorey(options, building);
        for (std::size_t i = 0; i < building.scenes.size(); ++i) {
            EnvcOptions own = options;
            own.common.output = productOf(options, document.storeys[i]);
            own.zones = std::move(zones[i]);
            writeProduct(own, *building.scenes[i], *document.storeys[i].room, nullptr);
        }
        return;
    }
    if (options.format->name == "glb") {
        OutputFile file(output);
        writeSiteGlb(building, [&file](std::string_view bytes) { file.write(bytes); });
        return file.commit();
    }
    const std::string& input = options.inputs.front();
    const std::string_view format = options.format->name;
    const PictureFormat picture = format == "svg"   ? PictureFormat::Svg
                                  : format == "pdf" ? PictureFormat::Pdf
                                                    : PictureFormat::Png;
    writeAll(output,
             drawSite(building, picture, options.width, isStream(input) ? "" : baseName(input)));
}

}  // namespace

void writeSite(const EnvcOptions& options, const EnvcSite& site) {
    const std::string& output = options.common.output;
    if (options.list_rooms)
        return writeAll(output, options.json ? roomsJson(site.found) : roomsText(site.found));
    if (options.format != nullptr && options.format->write_records != nullptr)
        return convert(options, site.document);
    const SiteScene& building =
        *leftToExit(std::make_unique<const SiteScene>(sceneOf(site.document)));
    if (!options.report.empty()) writeReport(options, site, building);
    if (options.info)
        return writeAll(output, options.json ? siteInfoJson(building) : siteInfoText(building));
    if (options.format == nullptr) return;
    writeProducts(options, site, building);
    std::size_t records = 0;
    double area = 0;
    for (const auto& scene : building.scenes) {
        records += scene->records.size();
        area += scene->environment.indoor().area();
    }
    logInfo(
        options.common, "envc",
        std::to_string(records) + " records compiled, indoor area " + formatFixed(area, 2) + " m2");
}

}  // namespace ispace
