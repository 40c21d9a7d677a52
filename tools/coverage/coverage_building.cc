// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage_building.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/run_files.h"
#include "building/building_coverage.h"
#include "building/building_page.h"
#include "building/building_suggestions.h"
#include "building/coupling.h"
#include "cli/building_operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "coverage/coverage_run.h"
#include "report/coverage_formats.h"
#include "report/map/map.h"
#include "scene/run/run_reader.h"

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
    if (!options.run.empty() && recordedBuilding(options.run).empty()) option = "--run of one room";
    if (options.presence) option = "--presence";
    if (!options.privacy.empty()) option = "--privacy";
    if (options.perturb) option = "--perturb";
    if (options.failures > 0) option = "--failures";
    if (options.crowd) option = "--crowd";
    if (!options.paths.empty()) option = "--path";
    if (options.localise_to) option = "--localise";
    if (!options.trace.empty()) option = "--trace";
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

/// Reads the record of each storey; nullopt without --run.
std::optional<BuildingRunCoverage> measureStoreyRuns(const CoverageToolOptions& options,
                                                     BuildingInput& input) {
    if (options.run.empty()) return std::nullopt;
    for (const Storey& storey : input.building.document.storeys)
        input.files.push_back(RecordedFiles(options.run + '/' + storey.id).robots);
    std::vector<std::string> warnings;
    BuildingRunCoverage run =
        measureBuildingRun(input.building, options.run,
                           {.plane = options.measure.plane, .density = options.measure.density},
                           options.rules.max_work, warnings);
    for (const std::string& warning : warnings) warn(options.common, "coverage", warning);
    return run;
}

const RunCoverage* runOf(const std::optional<BuildingRunCoverage>& run, std::size_t storey) {
    return run && !run->storeys[storey].members.empty() ? &run->storeys[storey] : nullptr;
}

/// Draws all storeys on one page.
void writePanels(const CoverageToolOptions& options, const BuildingInput& input,
                 const BuildingCoverage& coverage, const std::optional<BuildingRunCoverage>& run) {
    std::vector<Picture> panels;
    const std::uint32_t scale = redundancyScale(coverage);
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        MapOptions map = options.map;
        map.format = *options.format->picture;
        map.title = input.building.document.storeys[i].id;
        map.redundancy_scale = scale;
        map.run = runOf(run, i);
        panels.push_back(coverageMap(*coverage.floors[i], coverage.storeys[i], map));
    }
    Picture page = panelsOf(panels);
    page.describe(baseName(input.environment_operand),
                  "Coverage of its storeys, the lowest at the "
                  "bottom");
    writeAll(options.common.output, page.write(*options.format->picture));
}

/// Writes a file for each storey.
void writeFiles(const CoverageToolOptions& options, const BuildingInput& input,
                const BuildingCoverage& coverage, const std::optional<BuildingRunCoverage>& run) {
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        const Storey& storey = input.building.document.storeys[i];
        CoverageToolOptions own = options;
        own.common.output = fileOf(options.common.output, storey.id);
        own.map.title = storey.id;
        own.map.redundancy_scale = redundancyScale(coverage);
        own.map.run = runOf(run, i);
        claimOutput(own.common.output, "the map of a storey");
        SceneInput room{*coverage.floors[i], *storey.room, input.layout, {}, {}, {}, {}};
        writeProduct(own, room, {coverage.storeys[i], {}});
    }
}

std::optional<Advice> adviceFor(const CoverageToolOptions& options, const BuildingInput& input,
                                const BuildingCoverage& coverage, int& signal) {
    if (!options.suggestions) return std::nullopt;
    const SuggestOptions wanted{.most = static_cast<std::size_t>(*options.suggestions),
                                .measure = options.measure};
    SearchWatch watch(makeProgress("coverage", options.common.progress, options.common.quiet),
                      options.time_limit);
    Advice advice{suggestForBuilding(input.building, coverage, wanted, watch),
                  editCommand(input.named, options.rules)};
    advice.is_cut = watch.stopped();
    signal = watch.signal();
    return advice;
}

/// Returns the findings about sensors of all storeys.
std::vector<Diagnostic> findingsOf(const BuildingScene& building) {
    std::vector<Diagnostic> findings = storeyWarnings(Coupling(building), sensorChecks());
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        if (const auto deaf = receiverFinding(*building.scenes[i]))
            findings.push_back({.message = building.document.storeys[i].id + ": " + deaf->message,
                                .severity = Severity::Warning});
    return findings;
}

/// Returns the bytes of --report.
std::string buildingReport(const CoverageToolOptions& options, const BuildingInput& input,
                           const BuildingCoverage& coverage, const BuildingRunCoverage* run,
                           const Advice* advice, const std::vector<Diagnostic>& findings) {
    const std::string suffix = suffixOf(options.report);
    if (suffix == "json") return buildingCoverageJson(input.building, coverage, run, advice);
    BuildingPageInput page{input.building, coverage, "", options.history_line, {}, run, advice};
    if (input.environment_operand != "-") page.name = baseName(input.environment_operand);
    for (const Requirement& requirement : options.requirements) {
        const Verdict verdict =
            checkRequirement(requirement, subjectOf(requirement, input.building, coverage));
        page.requirements.push_back(
            {requirementPhrase(requirement), verdict.is_met, verdict.text, verdict.margin});
    }
    page.findings = findings;
    page.cover = coverOf(options.page);
    page.paper = paperOf(options.page);
    page.prices = pricesOf(options.page);
    const ReportPage pages = buildingPage(page);
    return suffix == "pdf" ? pdfOf(pages) : htmlOf(pages);
}

/// Writes --material, and warns of prices that no item has.
void writeBuildingMaterial(const CoverageToolOptions& options, const BuildingScene& building) {
    std::vector<CabledRoom> rooms;
    for (const auto& scene : building.scenes) rooms.push_back({*scene, cablesOf(*scene)});
    writeMaterial(options.page, rooms);
    if (const std::string text = priceWarning(options.page, rooms); !text.empty())
        warn(options.common, "coverage", text);
}

}  // namespace

bool coverBuilding(const CoverageToolOptions& options, JunitFile& junit) {
    std::vector<std::string> operands = options.operands;
    if (operands.empty())
        if (const std::string recorded = recordedBuilding(options.run); !recorded.empty())
            operands.push_back(recorded);
    auto read = readBuildingInput({operands, options.rules, true});
    if (!read) return false;
    BuildingInput& input = *read;
    mustBeAboutBuildings(options, input.building.document);
    addZones(options.zones, input.building);
    warn(options.common, "coverage", input.warnings);
    if (!options.report.empty()) mustBeWritable(options.report);
    const std::vector<Diagnostic> findings = findingsOf(input.building);
    warn(options.common, "coverage", findings);
    BuildingCoverage coverage = measureBuilding(input.building, options.measure);
    if (!options.facing.empty())
        coverage.rules = measureBuildingFacing(input.building, coverage, options.facing);
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i)
        if (const std::string text =
                largeCellsText(options.measure, coverage.storeys[i].report.grid);
            !text.empty())
            tell(options.common, "coverage", input.building.document.storeys[i].id + ": " + text);
    std::vector<JunitCase> verdicts = judgeBuilding(options, input.building, coverage);
    for (JunitCase& verdict : judge(judgedInBuilding(input.building, coverage.rules)))
        verdicts.push_back(std::move(verdict));
    const std::optional<BuildingRunCoverage> run = measureStoreyRuns(options, input);
    if (options.format != nullptr) {
        if (isPattern(options.common.output))
            writeFiles(options, input, coverage, run);
        else
            writePanels(options, input, coverage, run);
        writeDependencies(options.common, input.files);
    }
    const BuildingRunCoverage* const of_run = run ? &*run : nullptr;
    int signal = 0;
    const std::optional<Advice> advice = adviceFor(options, input, coverage, signal);
    const Advice* const of_advice = advice ? &*advice : nullptr;
    if (!options.report.empty())
        writeAll(options.report,
                 buildingReport(options, input, coverage, of_run, of_advice, findings));
    writeAll("-", options.json ? buildingCoverageJson(input.building, coverage, of_run, of_advice)
                               : buildingCoverageText(input.building, coverage, of_run) +
                                     (advice ? suggestionsText(*advice) : ""));
    writeBuildingMaterial(options, input.building);
    if (signal != 0) endBySignal(signal);
    for (const JunitCase& verdict : verdicts)
        if (verdict.outcome == JunitCase::Outcome::Met)
            logInfo(options.common, "coverage", verdict.message);
    junit.write(baseName(input.environment_operand), verdicts);
    if (const std::string unmet = unmetText(verdicts); !unmet.empty()) throw UnmetError(unmet);
    return true;
}

}  // namespace ispace
