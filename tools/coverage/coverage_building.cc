// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage_building.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/run_files.h"
#include "building/building_coverage.h"
#include "building/building_page.h"
#include "building/building_presence.h"
#include "building/building_robustness.h"
#include "building/building_suggestions.h"
#include "building/coupling.h"
#include "cli/building_operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "coverage/coverage_run.h"
#include "passage/least_seen_trip.h"
#include "report/coverage_formats.h"
#include "report/coverage_report.h"
#include "report/map/map.h"
#include "report/objective_report.h"
#include "report/presence_report.h"
#include "report/robustness_report.h"
#include "scene/run/run_reader.h"

namespace ispace {

namespace {

/// \throws UsageError for an option that is about one room
void mustBeAboutBuildings(const CoverageToolOptions& options, const StoreyedDocument& building) {
    std::string option;
    if (!options.run.empty() && recordedBuilding(options.run).empty())
        option = "--run by the record of one room";
    if (options.presence && !options.presence->record.empty() &&
        recordedBuilding(options.presence->record).empty())
        option = "--presence by the record of one room";
    if (!option.empty()) refuseSeveralRooms(option, building);
    if (options.format != nullptr) mustBeOneProduct(options.common);
    if (options.format != nullptr && !options.format->picture)
        mustNameStoreys(options.common.output, options.format->name, options.format->suffix);
}

std::vector<JunitCase> judgeBuilding(const CoverageToolOptions& options,
                                     const BuildingScene& building,
                                     const BuildingCoverage& coverage,
                                     const std::string& name = "") {
    std::vector<JunitCase> verdicts;
    for (const Requirement& requirement : options.requirements) {
        std::vector<JunitCase> one =
            judge({&requirement, 1}, subjectOf(requirement, building, coverage), name);
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

/// The parts of a report that were asked for, on each storey and in sum.
struct BuildingResults {
    std::optional<BuildingRunCoverage> run;
    std::optional<Robustness> robustness;
    std::vector<Presence> presence;
    std::optional<Presence> presence_sum;
    std::vector<ObjectiveFigures> objectives;
    std::optional<ObjectiveFigures> objectives_sum;
    std::optional<Advice> advice;
    std::vector<TriedPose> tried;  ///< of --trace

    [[nodiscard]] BuildingParts parts() const {
        BuildingParts parts;
        if (run) parts = partsOf(*run);
        parts.storeys.resize(std::max({parts.storeys.size(), presence.size(), objectives.size()}));
        for (std::size_t i = 0; i < presence.size(); ++i) parts.storeys[i].presence = &presence[i];
        for (std::size_t i = 0; i < objectives.size(); ++i)
            parts.storeys[i].objectives = &objectives[i];
        if (robustness) parts.sum.robustness = &*robustness;
        if (presence_sum) parts.sum.presence = &*presence_sum;
        if (objectives_sum) parts.sum.objectives = &*objectives_sum;
        if (advice) parts.sum.advice = &*advice;
        return parts;
    }
};

/// Measures --presence on each storey: a record's ways, or wanderers on all free floor.
void measurePresences(const CoverageToolOptions& options, BuildingInput& input,
                      const BuildingCoverage& coverage, BuildingResults& results) {
    if (!options.presence) return;
    const bool wanders = options.presence->record.empty();
    const auto people =
        spreadOverStoreys(coverage, static_cast<std::size_t>(options.presence->people));
    const std::vector<RoomWays> ways =
        waysOfStoreys(*options.presence, input.building, people, options.common.seed);
    for (std::size_t i = 0; i < ways.size(); ++i) {
        if (!wanders) input.files.push_back(RecordedFiles(ways[i].choice.record).robots);
        Presence presence =
            measurePresence(*coverage.floors[i], readWays(ways[i], *input.building.scenes[i]),
                            options.measure.plane);
        nameWholly(input.building.document.storeys[i], wanders, presence);
        results.presence.push_back(std::move(presence));
    }
    results.presence_sum = sumOverStoreys(results.presence);
}

/// Measures --path through the building, and --localise on each storey and over all.
void measureObjectives(const CoverageToolOptions& options, const BuildingScene& building,
                       const BuildingCoverage& coverage, BuildingResults& results) {
    if (options.paths.empty() && !options.localise_to) return;
    BuildingObjectives measured =
        measureObjectives(building, coverage, options.paths, 1, options.localise_to);
    results.objectives = std::move(measured.storeys);
    results.objectives_sum = std::move(measured.all);
}

/// Returns the crowds of --crowd: by sample, then by storey.
std::vector<BuildingCrowd> crowdsOf(const CoverageToolOptions& options, const BuildingInput& input,
                                    const BuildingCoverage& coverage) {
    const std::size_t storeys = input.building.scenes.size();
    std::vector<BuildingCrowd> crowds;
    if (options.crowd->of == Robustness::CrowdOf::Random) {
        const std::vector<std::size_t> people =
            spreadOverStoreys(coverage, static_cast<std::size_t>(options.crowd->people));
        crowds.assign(kSamples, BuildingCrowd(storeys));
        for (std::size_t i = 0; i < storeys; ++i) {
            if (people[i] == 0) continue;
            const CrowdFloor floor(*input.building.scenes[i]);
            for (std::size_t k = 0; k < kSamples; ++k)
                crowds[k][i] = floor.draw(
                    people[i], {.seed = seedOfStorey(options.common.seed, i), .frame = k});
        }
        return crowds;
    }
    if (options.crowd->of == Robustness::CrowdOf::Scene) {
        crowds.emplace_back();
        for (const auto& scene : input.building.scenes) crowds[0].push_back(crowdOf(*scene));
        return crowds;
    }
    // The storeys of a record have the same moments.
    for (std::size_t i = 0; i < storeys; ++i) {
        const std::vector<Crowd> of_storey =
            crowdsOfRun(options.run + '/' + input.building.document.storeys[i].id,
                        *input.building.scenes[i], kSamples);
        crowds.resize(i == 0 ? of_storey.size() : std::min(crowds.size(), of_storey.size()),
                      BuildingCrowd(storeys));
        for (std::size_t k = 0; k < crowds.size(); ++k) crowds[k][i] = of_storey[k];
    }
    return crowds;
}

std::optional<Robustness> robustnessOf(const CoverageToolOptions& options,
                                       const BuildingInput& input,
                                       const BuildingCoverage& coverage) {
    if (!options.perturb && options.failures == 0 && !options.crowd) return std::nullopt;
    Robustness robustness{.requirements = options.requirements, .failures = options.failures};
    if (options.failures > 0)
        robustness.losses =
            worstFailuresOfBuilding(coverage, options.failures, options.requirements);
    const auto progress = makeProgress("coverage", options.common.progress, options.common.quiet);
    if (options.crowd) {
        robustness.crowd_of = options.crowd->of;
        robustness.people = options.crowd->people;
        robustness.crowd =
            crowdBuilding(input.building, coverage, options.measure,
                          crowdsOf(options, input, coverage), options.requirements, *progress);
    }
    if (!options.perturb) return robustness;
    robustness.tolerance = *options.perturb;
    robustness.mounting =
        perturbBuilding(input.building, coverage, options.measure, *options.perturb, kSamples,
                        options.common.seed, options.requirements, *progress);
    return robustness;
}

/// Measures the other layout of --compare, and compares the storeys with it.
void compareWithOther(const CoverageToolOptions& options, BuildingInput& input,
                      BuildingCoverage& coverage) {
    if (options.other.empty()) return;
    const auto other =
        readBuildingInput({{input.environment_operand, options.other}, options.rules, true});
    if (!other) throw UsageError("--compare: " + options.other + " is no layout of a building");
    warn(options.common, "coverage", other->warnings);
    input.files.insert(input.files.end(), other->files.begin(), other->files.end());
    compareStoreys(coverage, measureBuilding(other->building, options.measure),
                   baseName(options.other));
}

const RunCoverage* runOf(const std::optional<BuildingRunCoverage>& run, std::size_t storey) {
    return run && !run->storeys[storey].members.empty() ? &run->storeys[storey] : nullptr;
}

/// Reads --trace. \throws UsageError for candidates of a room, and of other buildings
std::vector<TriedPose> readTriedIn(const CoverageToolOptions& options, BuildingInput& input) {
    std::vector<TriedPose> tried = readTried(options, input.named);
    if (!options.trace.empty()) input.files.push_back(options.trace);
    for (const TriedPose& pose : tried) {
        if (pose.room.empty())
            refuseSeveralRooms("--trace of the candidates of one room", input.building.document);
        const auto& storeys = input.building.document.storeys;
        if (std::none_of(storeys.begin(), storeys.end(),
                         [&pose](const Storey& storey) { return storey.id == pose.room; }))
            throw UsageError("--trace: the building has no storey " + excerpt(pose.room) + " (" +
                             input.building.document.storeyList() + ')');
    }
    return tried;
}

/// Returns those of a storey.
std::vector<TriedPose> triedIn(const std::vector<TriedPose>& all, const std::string& storey) {
    std::vector<TriedPose> tried;
    std::copy_if(all.begin(), all.end(), std::back_inserter(tried),
                 [&storey](const TriedPose& pose) { return pose.room == storey; });
    return tried;
}

/// Draws all storeys on one page.
void writePanels(const CoverageToolOptions& options, const BuildingInput& input,
                 const BuildingCoverage& coverage, const BuildingResults& results) {
    std::vector<Picture> panels;
    const std::uint32_t scale = redundancyScale(coverage);
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        MapOptions map = options.map;
        map.format = *options.format->picture;
        map.title = input.building.document.storeys[i].id;
        map.redundancy_scale = scale;
        map.run = runOf(results.run, i);
        map.trace = triedIn(results.tried, map.title);
        if (!results.objectives.empty()) map.objectives = &results.objectives[i];
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
                const BuildingCoverage& coverage, const BuildingResults& results) {
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        const Storey& storey = input.building.document.storeys[i];
        CoverageToolOptions own = options;
        own.common.output = storeyFile(options.common.output, storey.id);
        own.map.title = storey.id;
        own.map.redundancy_scale = redundancyScale(coverage);
        own.map.run = runOf(results.run, i);
        own.map.trace = triedIn(results.tried, storey.id);
        if (!results.objectives.empty()) own.map.objectives = &results.objectives[i];
        claimOutput(own.common.output, "the map of a storey");
        SceneInput room{*coverage.floors[i], *storey.room, input.layout, {}, {}, {}, {}};
        writeProduct(own, room, {coverage.storeys[i], {}});
    }
}

std::optional<Advice> adviceFor(const CoverageToolOptions& options, const BuildingInput& input,
                                const BuildingCoverage& coverage, int& signal) {
    if (!options.suggestions) return std::nullopt;
    SuggestOptions wanted{.most = static_cast<std::size_t>(*options.suggestions),
                          .measure = options.measure,
                          .requirements = options.requirements,
                          .facing = options.facing,
                          .privacy = options.privacy};
    std::erase_if(wanted.facing, [](const FacingRule& rule) { return !rule.required; });
    SearchWatch watch(makeProgress("coverage", options.common.progress, options.common.quiet),
                      options.time_limit);
    Advice advice{suggestForBuilding(input.building, coverage, wanted, watch),
                  editCommand(input.named, options.rules)};
    advice.is_cut = watch.stopped();
    signal = watch.signal();
    advice.is_short = missingFloor(coverage.rules) > 0 &&
                      (advice.suggestions.empty() ||
                       advice.suggestions.front().kind != Suggestion::Kind::Together ||
                       advice.suggestions.front().unmet > 0);
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
                           const BuildingCoverage& coverage, const BuildingResults& results,
                           const std::vector<Diagnostic>& findings) {
    const std::string suffix = suffixOf(options.report);
    const BuildingParts parts = results.parts();
    if (suffix == "json") return buildingCoverageJson(input.building, coverage, parts);
    BuildingPageInput page{input.building, coverage, "", options.history_line, {}};
    page.run = results.run ? &*results.run : nullptr;
    page.advice = parts.sum.advice;
    const auto add_text = [&page](const char* id, const char* title, std::string text) {
        page.more.push_back({id, title, {PageCode{std::move(text)}}});
    };
    if (coverage.comparison)
        add_text("comparison", "Beside another layout",
                 comparisonText(*coverage.comparison, coverage.coverage));
    if (parts.sum.objectives != nullptr)
        add_text("objectives", "Positions", objectivesText(*parts.sum.objectives));
    if (parts.sum.presence != nullptr)
        add_text("presence", "Presence", presenceText(*parts.sum.presence));
    if (results.robustness) page.more.push_back(robustnessSection(*results.robustness));
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
    const auto progress = makeProgress("coverage", options.common.progress, options.common.quiet);
    page.progress = progress.get();
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

void tellLargeCells(const CoverageToolOptions& options, const StoreyedDocument& building,
                    const BuildingCoverage& coverage) {
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i)
        if (const std::string text =
                largeCellsText(options.measure, coverage.storeys[i].report.grid);
            !text.empty())
            tell(options.common, "coverage", building.storeys[i].id + ": " + text);
}

}  // namespace

bool coverBuildingOf(const BatchJob& job, const CoverageToolOptions& options, JobOutcome& outcome) {
    auto input = readBuildingInput({job.operands, options.rules, false});
    if (!input) return false;
    outcome.files = input->files;
    addZones(options.zones, input->building);
    const auto& scenes = input->building.scenes;
    if (!input->layout && std::all_of(scenes.begin(), scenes.end(),
                                      [](const auto& scene) { return scene->sensors.empty(); }))
        throw UsageError(input->environment_operand +
                         " holds no placed sensor: give a layout after it");
    warnOfImport(options.common, "coverage", *input);
    warn(options.common, "coverage", findingsOf(input->building));
    const BuildingCoverage coverage = measureBuilding(input->building, options.measure);
    tellLargeCells(options, input->building.document, coverage);
    outcome.line = buildingCoverageJson(input->building, coverage);
    outcome.verdicts = judgeBuilding(options, input->building, coverage, job.name + ": ");
    return true;
}

std::vector<std::string> operandsOf(const CoverageToolOptions& options) {
    if (options.run.empty() || !options.operands.empty()) return options.operands;
    if (const std::string building = recordedBuilding(options.run); !building.empty())
        return {building};
    static_cast<void>(RunReader(options.run));  // fails before a missing layout does
    const std::string scene = sceneOfRecord(options.run);
    return scene.empty() ? std::vector<std::string>() : std::vector{scene};
}

void takeStorey(CoverageToolOptions& options, const SceneInput& input) {
    const auto must_be_of_room = [](const char* option, const std::string& folder) {
        if (holdsBuilding(folder))
            throw UsageError(std::string(option) + ": " + folder +
                             " is the record of a building: leave out --storey and ENV");
    };
    must_be_of_room("--run", options.run);
    if (options.presence) must_be_of_room("--presence", options.presence->record);
    if (options.format != nullptr)
        options.common.output =
            roomFile(options.common.output, input.storey, input.environment_operand);
}

bool coverBuilding(const CoverageToolOptions& options, JunitFile& junit) {
    auto read = readBuildingInput({operandsOf(options), options.rules, true});
    if (!read) return false;
    BuildingInput& input = *read;
    mustBeAboutBuildings(options, input.building.document);
    addZones(options.zones, input.building);
    warnOfImport(options.common, "coverage", input);
    if (!options.report.empty()) mustBeWritable(options.report);
    const std::vector<Diagnostic> findings = findingsOf(input.building);
    warn(options.common, "coverage", findings);
    BuildingCoverage coverage = measureBuilding(input.building, options.measure);
    compareWithOther(options, input, coverage);
    if (!options.facing.empty() || !options.privacy.empty())
        coverage.rules = measureBuildingRules(input.building, coverage, options.measure,
                                              options.facing, options.privacy);
    if (!options.facing.empty() && options.measure.plane == 0)
        tell(options.common, "coverage", std::string(kFacesOnFloor));
    tellLargeCells(options, input.building.document, coverage);
    std::vector<JunitCase> verdicts = judgeBuilding(options, input.building, coverage);
    for (JunitCase& verdict : judge(judgedInBuilding(input.building, coverage.rules)))
        verdicts.push_back(std::move(verdict));
    BuildingResults results;
    results.tried = readTriedIn(options, input);
    results.run = measureStoreyRuns(options, input);
    measureObjectives(options, input.building, coverage, results);
    measurePresences(options, input, coverage, results);
    if (results.presence_sum)
        for (JunitCase& verdict : judge(options.presence_requirements, *results.presence_sum))
            verdicts.push_back(std::move(verdict));
    if (options.format != nullptr) {
        if (isStoreyPattern(options.common.output))
            writeFiles(options, input, coverage, results);
        else
            writePanels(options, input, coverage, results);
        writeDependencies(options.common, input.files);
    }
    results.robustness = robustnessOf(options, input, coverage);
    int signal = 0;
    results.advice = adviceFor(options, input, coverage, signal);
    if (!options.report.empty())
        writeAll(options.report, buildingReport(options, input, coverage, results, findings));
    const BuildingParts parts = results.parts();
    writeAll("-", options.json ? buildingCoverageJson(input.building, coverage, parts)
                               : buildingCoverageText(input.building, coverage, parts));
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
