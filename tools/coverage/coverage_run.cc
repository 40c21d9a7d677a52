// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage_run.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/part_file.h"
#include "base/run_files.h"
#include "cli/batch.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "coverage/crowd.h"
#include "coverage/presence.h"
#include "record/text.h"
#include "report/coverage_formats.h"
#include "report/coverage_report.h"
#include "report/map/depth_shades.h"
#include "report/trace_file.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "scene/sensor/ultrasound.h"
#include "trace/ray_world.h"

namespace ispace {

std::vector<TriedPose> readTried(const CoverageToolOptions& options,
                                 const std::vector<std::string>& named) {
    if (options.trace.empty()) return {};
    std::vector<std::string> streams = named;
    streams.insert(streams.end(), {options.other, options.trace});
    mustReadStdinOnce(streams);
    const std::string bytes = options.trace == "-" ? readStdin() : readAll(options.trace);
    return readTrace(bytes, displayName(options.trace)).poses;
}

std::vector<TriedPose> triedInRoom(const CoverageToolOptions& options, const std::string& storey,
                                   std::vector<TriedPose> tried) {
    const std::size_t all = tried.size();
    std::erase_if(tried, [&storey](const TriedPose& pose) {
        return !pose.room.empty() && pose.room != storey;
    });
    if (tried.empty() && all > 0)
        throw UsageError("--trace: the candidates of " + displayName(options.trace) +
                         (storey.empty() ? " are those of a building: give it, or one of its "
                                           "storeys with --storey"
                                         : " are those of other storeys than " + excerpt(storey)));
    return tried;
}

namespace {

/// A layout may add furniture, which is part of the comparison, but must not replace the room.
void mustBeSameRoom(const Environment& room, const Environment& other, const std::string& file) {
    if (room.limits() == other.limits() && room.indoor() == other.indoor()) return;
    throw FormatError({displayName(file), 0, 0,
                       "its walls make another room: layouts of one room can be compared"});
}

/// Returns the content of a model: the records of the scene, below the history of both inputs and
/// this command.
Document documentOf(const CoverageToolOptions& options, const SceneInput& input) {
    Document document;
    document.history = input.environment.history;
    if (input.layout)
        document.history.insert(document.history.end(), input.layout->history.begin(),
                                input.layout->history.end());
    document.history.push_back(options.history_line);
    document.records = input.scene.records;
    rebaseFiles(document.records, "",
                std::filesystem::path(options.common.output).parent_path().string());
    return document;
}

/// Seconds; most layouts are measured in less.
constexpr double kQuick = 0.5;

}  // namespace

Measured measure(const CoverageToolOptions& options, const Scene& scene, const Scene* other) {
    Worlds worlds(scene.environment);
    const auto progress =
        makeProgress("coverage", options.common.progress, options.common.quiet, kQuick);
    Measured measured{measureCoverage(scene, worlds, options.measure, progress.get()), {}};
    if (other == nullptr) return measured;
    mustBeSameRoom(scene.environment, other->environment, options.other);
    Worlds other_worlds(other->environment);
    measured.other = measureCoverage(*other, other_worlds, options.measure, progress.get());
    compare(measured.coverage, *measured.other, scene.environment.indoor(),
            options.other == "-" ? displayName("-") : baseName(options.other));
    return measured;
}

std::optional<RunCoverage> measureRecordedRun(const CoverageToolOptions& options,
                                              const Scene& scene) {
    if (options.run.empty()) return std::nullopt;
    RunReader reader(options.run);
    RunChanges changes = changesOfRun(options.run, scene, options.rules.max_work);
    RunCoverage run =
        measureRun(scene, reader,
                   {.plane = options.measure.plane, .density = options.measure.density}, &changes);
    if (!changes.failure().empty()) warn(options.common, "coverage", changes.failure());
    run.name = baseName(options.run);
    if (reader.isCut())
        warn(options.common, "coverage",
             "the record ends in the midst of a step, which is left out");
    return run;
}

std::optional<Presence> presenceOf(const CoverageToolOptions& options, const Scene& scene) {
    if (!options.presence) return std::nullopt;
    return measurePresence(scene, readWays(*options.presence, scene, options.common.seed),
                           options.measure.plane);
}

std::optional<Advice> suggest(const CoverageToolOptions& options, const SceneInput& input,
                              const Coverage& coverage, int& signal) {
    if (!options.suggestions) return std::nullopt;
    SuggestOptions wanted{.most = static_cast<std::size_t>(*options.suggestions),
                          .measure = options.measure,
                          .requirements = options.requirements,
                          .facing = options.facing,
                          .privacy = options.privacy};
    std::erase_if(wanted.facing, [](const FacingRule& rule) { return !rule.required; });
    SearchWatch watch(makeProgress("coverage", options.common.progress, options.common.quiet),
                      options.time_limit);
    Advice advice{suggestChanges(input.scene, coverage, wanted, shippedDevices(), watch),
                  editCommand(input.named, options.rules)};
    advice.is_cut = watch.stopped();
    signal = watch.signal();
    advice.is_short = missingFloor(input.scene, coverage, wanted) > 0 &&
                      (advice.suggestions.empty() ||
                       advice.suggestions.front().kind != Suggestion::Kind::Together);
    return advice;
}

namespace {

std::vector<Crowd> crowdsOf(const CoverageToolOptions& options, const Scene& scene) {
    switch (options.crowd->of) {
        case Robustness::CrowdOf::Scene:
            return {crowdOf(scene)};
        case Robustness::CrowdOf::Run:
            return crowdsOfRun(options.run, scene, kSamples);
        case Robustness::CrowdOf::Random:
            break;
    }
    const CrowdFloor floor(scene);
    std::vector<Crowd> crowds;
    for (std::uint64_t frame = 0; frame < kSamples; ++frame)
        crowds.push_back(floor.draw(static_cast<std::size_t>(options.crowd->people),
                                    {.seed = options.common.seed, .frame = frame}));
    return crowds;
}

}  // namespace

std::optional<Robustness> robustnessOf(const CoverageToolOptions& options, const Scene& scene,
                                       const Coverage& coverage) {
    if (!options.perturb && options.failures == 0 && !options.crowd) return std::nullopt;
    Robustness robustness{.requirements = options.requirements, .failures = options.failures};
    if (options.failures > 0)
        robustness.losses = worstFailures(scene, coverage, options.failures, options.requirements);
    const auto progress = makeProgress("coverage", options.common.progress, options.common.quiet);
    if (options.crowd) {
        robustness.crowd_of = options.crowd->of;
        robustness.people = options.crowd->people;
        robustness.crowd = measureCrowds(scene, coverage.report, options.measure,
                                         crowdsOf(options, scene), options.requirements, *progress);
    }
    if (!options.perturb) return robustness;
    robustness.tolerance = *options.perturb;
    robustness.mounting =
        perturbMounting(scene, coverage.report, options.measure, *options.perturb, kSamples,
                        options.common.seed, options.requirements, *progress);
    return robustness;
}

std::optional<CameraRules> cameraRulesOf(const CoverageToolOptions& options, const Scene& scene,
                                         const Coverage& coverage) {
    if (options.facing.empty() && options.privacy.empty()) return std::nullopt;
    CameraRules rules{measureFacing(scene, coverage, options.facing),
                      measurePrivacy(scene, options.measure.plane, options.privacy)};
    if (!options.facing.empty() && options.measure.plane == 0)
        tell(options.common, "coverage", std::string(kFacesOnFloor));
    return rules;
}

std::optional<ObjectiveFigures> objectivesOf(const CoverageToolOptions& options, const Scene& scene,
                                             const Coverage& coverage) {
    if (options.paths.empty() && !options.localise_to) return std::nullopt;
    ObjectiveFigures figures;
    for (const WayChoice& path : options.paths)
        figures.ways.push_back(findLeastSeenWay(scene, coverage, path));
    if (options.localise_to) figures.localisation = localise(scene, coverage, *options.localise_to);
    return figures;
}

std::vector<JunitCase> judge(const CameraRules& rules) { return judge(judgedRules(rules)); }

std::vector<JunitCase> judge(std::span<const JudgedRule> rules) {
    std::vector<JunitCase> verdicts;
    for (const JudgedRule& rule : rules)
        if (rule.is_required)
            verdicts.push_back(
                {.name = rule.rule,
                 .outcome = rule.is_met ? JunitCase::Outcome::Met : JunitCase::Outcome::Unmet,
                 .message = rule.rule + ": " + rule.finding});
    return verdicts;
}

void writeProduct(const CoverageToolOptions& options, const SceneInput& input,
                  const Measured& measured) {
    const std::string& output = options.common.output;
    const CoverageFormat& format = *options.format;
    CoverageProduct product{input.scene, measured.coverage,
                            measured.other ? &*measured.other : nullptr, options.map};
    product.document = documentOf(options, input);
    product.speeds = options.speeds;
    if (const auto* cells = std::get_if<CellSize>(&options.measure.cells))
        product.cell = cells->edge;
    if (format.beside_suffix == nullptr) {
        writeAll(output, format.write(product).product);
        return;
    }
    const std::string beside = withSuffix(output, format.beside_suffix);
    product.beside_name = std::filesystem::path(beside).filename().string();
    const CoverageFiles files = format.write(product);
    writeTogether(std::vector<NamedBytes>{{beside, files.beside}, {output, files.product}});
}

std::vector<Diagnostic> sensorFindings(const Scene& scene) {
    std::vector<Diagnostic> found = sceneWarnings(scene, sensorChecks());
    if (auto deaf = receiverFinding(scene)) found.push_back(*std::move(deaf));
    return found;
}

FindingFilter sensorChecks() { return {.checks = {"unplaced", "outside", "buried"}}; }

std::optional<Diagnostic> receiverFinding(const Scene& scene) {
    if (const std::size_t count = sensorsOf<Receiver>(scene).size();
        count > 0 && count < kMinReceivers)
        return Diagnostic{
            .file = "",
            .message = "ultrasound covers nothing: at least " + std::to_string(kMinReceivers) +
                       " receivers have to hear a tag, here are " + std::to_string(count),
            .severity = Severity::Warning};
    return std::nullopt;
}

std::string largeCellsText(const CoverageOptions& options, const Grid& grid) {
    const double edge = roundSignificant(grid.limits.width() / grid.columns);
    if (!std::holds_alternative<RoomCells>(options.cells) || edge <= kRoomCell) return "";
    return "the room is large: cells are " + formatDouble(edge) + " m instead of " +
           formatDouble(kRoomCell) + " m (--cell M makes them smaller)";
}

namespace {

template <typename SomeRequirement, typename Measured>
std::vector<JunitCase> verdictsOn(std::span<const SomeRequirement> requirements,
                                  const Measured& measured, const std::string& name) {
    std::vector<JunitCase> verdicts;
    verdicts.reserve(requirements.size());
    for (const SomeRequirement& requirement : requirements) {
        const Verdict verdict = checkRequirement(requirement, measured);
        verdicts.push_back(
            {.name = name + requirementText(requirement),
             .outcome = verdict.is_met ? JunitCase::Outcome::Met : JunitCase::Outcome::Unmet,
             .message = verdict.text});
    }
    return verdicts;
}

}  // namespace

std::vector<JunitCase> judge(std::span<const Requirement> requirements, const Coverage& coverage,
                             const std::string& name) {
    return verdictsOn(requirements, coverage, name);
}

std::vector<JunitCase> judge(std::span<const PresenceRequirement> requirements,
                             const Presence& presence) {
    return verdictsOn(requirements, presence, "");
}

std::string unmetText(std::span<const JunitCase> verdicts) {
    std::string text;
    for (const JunitCase& verdict : verdicts)
        if (verdict.outcome == JunitCase::Outcome::Unmet)
            text.append(text.empty() ? "" : "; ").append(verdict.message);
    return text;
}

Measured measureScene(const CoverageToolOptions& options, const SceneInput& input,
                      const Scene* other) {
    for (const Requirement& requirement : options.requirements)
        mustHaveZone(requirement, input.scene.environment);
    warn(options.common, "coverage", sensorFindings(input.scene));
    const auto& sensors = input.scene.sensors;
    const auto seeing = static_cast<std::size_t>(
        std::count_if(sensors.begin(), sensors.end(),
                      [](const Sensor& sensor) { return kindOf(sensor.model).perceives; }));
    // A page alone shows depths in a few shades.
    const bool by_shades =
        options.measure.keep_depths && options.format == nullptr && seeing > kFewDepths;
    CoverageToolOptions own = options;
    own.measure.keep_depths = options.measure.keep_depths && !by_shades;
    Measured measured = measure(own, input.scene, other);
    if (by_shades) addDepthShades(measured.coverage, input.scene);
    if (const std::string text = largeCellsText(options.measure, measured.coverage.report.grid);
        !text.empty())
        tell(options.common, "coverage", text);
    return measured;
}

}  // namespace ispace
