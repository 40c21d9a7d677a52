// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage_building.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/run_files.h"
#include "building/building_coverage.h"
#include "cli/building_operands.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "coverage/coverage_run.h"
#include "report/coverage_formats.h"
#include "report/map/map.h"

namespace ispace {

namespace {

/// The mark for the storey's id in the name of a file.
constexpr std::string_view kMark = "%s";

bool isPattern(const std::string& output) { return output.find(kMark) != std::string::npos; }

std::string fileOf(std::string pattern, const std::string& id) {
    for (std::size_t at = pattern.find(kMark); at != std::string::npos;
         at = pattern.find(kMark, at + id.size()))
        pattern.replace(at, kMark.size(), id);
    return pattern;
}

/// \throws UsageError for an option that is about one room
void mustBeAboutBuildings(const CoverageToolOptions& options, const StoreyedDocument& building) {
    std::string option;
    if (!options.other.empty()) option = "--compare";
    if (!options.run.empty()) option = "--run";
    if (options.presence) option = "--presence";
    if (options.suggestions) option = "--suggest";
    if (!options.trace.empty()) option = "--trace";
    if (!options.zones.empty()) option = "--zone";
    if (!options.report.empty() && suffixOf(options.report) != "json")
        option = "a page of --report";
    for (const Requirement& requirement : options.requirements)
        if (requirement.density) option = "--require of a density class";
    if (!option.empty())
        throw UsageError(option +
                         " is about one storey of the building: choose it with --storey (" +
                         building.storeyList() + ')');
    if (options.format != nullptr && !options.format->picture && !isPattern(options.common.output))
        throw UsageError(std::string(options.format->name) +
                         " holds one storey: name the files with %s for its id (-o 'map-%s." +
                         std::string(options.format->suffix) + "'), or choose one with --storey");
}

/// Returns the coverage that a requirement is about: of a zone `ID/NAME` that of its storey, else
/// the sums of the building.
Coverage subjectOf(const Requirement& requirement, const BuildingScene& building,
                   const BuildingCoverage& coverage) {
    if (requirement.of != Requirement::Of::Zone) {
        Coverage sum;
        sum.report.indoor_area = coverage.indoor_area;
        sum.report.free_area = coverage.free_area;
        sum.report.coverage = coverage.coverage;
        sum.report.free_coverage = coverage.free_coverage;
        return sum;
    }
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i)
        for (const ZoneMetrics& zone : coverage.storeys[i].report.zones)
            if (zone.id == requirement.zone) return coverage.storeys[i];
    std::vector<std::string> known;
    for (const Coverage& storey : coverage.storeys)
        for (const ZoneMetrics& zone : storey.report.zones) known.push_back(zone.id);
    throw UsageError("the building has no zone `" + printable(requirement.zone) + '`' +
                     didYouMean(requirement.zone, known) + "; the storey comes first, as in " +
                     building.document.storeys.front().id + "/NAME");
}

std::vector<JunitCase> judgeBuilding(const CoverageToolOptions& options,
                                     const BuildingScene& building,
                                     const BuildingCoverage& coverage) {
    std::vector<JunitCase> verdicts;
    for (const Requirement& requirement : options.requirements) {
        std::vector<JunitCase> one =
            judge({&requirement, 1}, subjectOf(requirement, building, coverage));
        verdicts.push_back(std::move(one.front()));
    }
    return verdicts;
}

/// Returns the scale of redundancy that the maps of all storeys share.
std::uint32_t scaleOf(const BuildingCoverage& coverage) {
    std::uint32_t scale = 0;
    for (const Coverage& storey : coverage.storeys)
        scale = std::max(scale, redundancyScale(storey.report));
    return scale;
}

/// Draws all storeys on one page.
void writePanels(const CoverageToolOptions& options, const BuildingInput& input,
                 const BuildingCoverage& coverage) {
    std::vector<Picture> panels;
    const std::uint32_t scale = scaleOf(coverage);
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        MapOptions map = options.map;
        map.format = *options.format->picture;
        map.title = input.building.document.storeys[i].id;
        map.redundancy_scale = scale;
        panels.push_back(coverageMap(*input.building.scenes[i], coverage.storeys[i], map));
    }
    Picture page = panelsOf(panels);
    page.describe(baseName(input.environment_operand),
                  "Coverage of its storeys, the lowest at the "
                  "bottom");
    writeAll(options.common.output, page.write(*options.format->picture));
}

/// Writes a file for each storey.
void writeFiles(const CoverageToolOptions& options, const BuildingInput& input,
                const BuildingCoverage& coverage) {
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        const Storey& storey = input.building.document.storeys[i];
        CoverageToolOptions own = options;
        own.common.output = fileOf(options.common.output, storey.id);
        own.map.title = storey.id;
        own.map.redundancy_scale = scaleOf(coverage);
        claimOutput(own.common.output, "the map of a storey");
        SceneInput room{*input.building.scenes[i], *storey.room, input.layout, {}, {}, {}, {}};
        writeProduct(own, room, {coverage.storeys[i], {}});
    }
}

}  // namespace

bool coverBuilding(const CoverageToolOptions& options, JunitFile& junit) {
    const auto read = readBuildingInput({options.operands, options.rules, true});
    if (!read) return false;
    const BuildingInput& input = *read;
    mustBeAboutBuildings(options, input.building.document);
    warn(options.common, "coverage", input.warnings);
    if (!options.report.empty()) mustBeWritable(options.report);
    for (std::size_t i = 0; i < input.building.scenes.size(); ++i)
        for (Diagnostic finding : sensorFindings(*input.building.scenes[i])) {
            finding.message = input.building.document.storeys[i].id + ": " + finding.message;
            warn(options.common, "coverage", std::span<const Diagnostic>(&finding, 1));
        }
    const BuildingCoverage coverage = measureBuilding(input.building, options.measure);
    if (options.format != nullptr) {
        if (isPattern(options.common.output))
            writeFiles(options, input, coverage);
        else
            writePanels(options, input, coverage);
        writeDependencies(options.common, input.files);
    }
    if (!options.report.empty())
        writeAll(options.report, buildingCoverageJson(input.building, coverage));
    writeAll("-", options.json ? buildingCoverageJson(input.building, coverage)
                               : buildingCoverageText(input.building, coverage));
    const std::vector<JunitCase> verdicts = judgeBuilding(options, input.building, coverage);
    for (const JunitCase& verdict : verdicts)
        if (verdict.outcome == JunitCase::Outcome::Met)
            talk(options.common, "coverage", verdict.message);
    junit.write(baseName(input.environment_operand), verdicts);
    if (const std::string unmet = unmetText(verdicts); !unmet.empty()) throw UnmetError(unmet);
    return true;
}

}  // namespace ispace
