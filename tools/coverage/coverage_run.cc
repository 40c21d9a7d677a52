// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage_run.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
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
#include "cli/common_options.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "cli/storey_operands.h"
#include "record/text.h"
#include "report/coverage_formats.h"
#include "report/map/depth_shades.h"
#include "report/map/map.h"
#include "report/trace_file.h"
#include "scene/findings/findings.h"
#include "scene/sensor/ultrasound.h"
#include "site/coupling.h"

namespace ispace {

namespace {

/// Seconds; most layouts are measured in less.
constexpr double kQuick = 0.5;

const Storey& storeyOf(const SiteInput& input, std::size_t room) {
    return input.building.document.storeys[room];
}

}  // namespace

SiteParts SiteResults::parts() const {
    SiteParts parts;
    parts.storeys.resize(coverage.storeys.size());
    for (std::size_t i = 0; i < found.parts.storeys.size(); ++i)
        join(parts.storeys[i], found.parts.storeys[i]);
    join(parts.sum, found.parts.sum);
    return parts;
}

void nameInRoom(CoverageToolOptions& options, const SiteInput& input) {
    const auto take = [&input](std::string& zone) { zone = inOwnStorey(input, zone); };
    for (Requirement& requirement : options.requirements) take(requirement.zone);
}

void fitOptions(CoverageToolOptions& options, const SiteInput& input) {
    nameInRoom(options, input);
    options.groups->fit(input);
    if (options.format == nullptr) return;
    if (input.isOneRoom()) {
        options.common.output =
            roomFile(options.common.output, input.storey, input.environment_operand);
        return;
    }
    mustBeOneProduct(options.common);
    if (!options.format->picture)
        mustNameStoreys(options.common.output, options.format->name, options.format->suffix);
}

namespace {

/// A layout may add furniture, which is part of the comparison, but must not replace the room.
void mustBeSameRoom(const Environment& room, const Environment& other, const std::string& file) {
    if (room.limits() == other.limits() && room.indoor() == other.indoor()) return;
    throw FormatError({displayName(file), 0, 0,
                       "its walls make another room: layouts of one room can be compared"});
}

/// Returns a warning of too few ultrasound receivers; empty if there are none or enough.
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

/// Tells if the cells of a room are larger than usual by default.
void reportLargeCells(const CoverageToolOptions& options, const SiteInput& input,
                      const SiteCoverage& coverage) {
    if (!std::holds_alternative<RoomCells>(options.measure.cells)) return;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        const Grid& grid = coverage.storeys[i].report.grid;
        const double edge = roundSignificant(grid.limits.width() / grid.columns);
        if (edge <= kRoomCell) continue;
        report(options.common, "coverage",
               storeyOf(input, i).prefix() + "the room is large: cells are " + formatDouble(edge) +
                   " m instead of " + formatDouble(kRoomCell) + " m (--cell M makes them smaller)");
    }
}

/// Returns the number of sensors that see floor.
std::size_t countSeeing(const SiteScene& building) {
    std::size_t count = 0;
    for (const auto& scene : building.scenes)
        count += static_cast<std::size_t>(
            std::count_if(scene->sensors.begin(), scene->sensors.end(),
                          [](const Sensor& sensor) { return kindOf(sensor.model).perceives; }));
    return count;
}

}  // namespace

void measure(const CoverageToolOptions& options, const SiteInput& input,
             std::vector<std::string>& files, SiteResults& results) {
    std::optional<OtherSite> other;
    if (!options.other.empty()) {
        other = readOtherLayout(input, options.other, options.rules);
        warn(options.common, "coverage", other->warnings);
        files.insert(files.end(), other->files.begin(), other->files.end());
    }
    for (const Requirement& requirement : options.requirements)
        mustHaveZone(requirement, input.building);
    warn(options.common, "coverage", sensorFindings(input.building));
    // A page alone shows depths in a few shades.
    const bool by_shades = options.measure.keep_depths && options.format == nullptr &&
                           countSeeing(input.building) > kFewDepths;
    CoverageOptions how = options.measure;
    how.keep_depths = how.keep_depths && !by_shades;
    const auto progress =
        makeProgress("coverage", options.common.progress, options.common.quiet, kQuick);
    SiteCoverage& coverage = results.coverage;
    coverage = measureSite(input.building, how, progress.get());
    if (other) {
        for (std::size_t i = 0; i < input.rooms().size(); ++i)
            mustBeSameRoom(input.rooms()[i]->environment, other->building.scenes[i]->environment,
                           options.other);
        results.other = measureSite(other->building, how, progress.get());
        compareStoreys(coverage, *results.other,
                       options.other == "-" ? displayName("-") : baseName(options.other));
    }
    if (by_shades)
        for (std::size_t i = 0; i < coverage.storeys.size(); ++i)
            addDepthShades(coverage.storeys[i], *coverage.floors[i], redundancyScale(coverage));
    reportLargeCells(options, input, coverage);
}

std::vector<TriedPose> readTried(const CoverageToolOptions& options, const SiteInput& input) {
    if (options.trace.empty()) return {};
    std::vector<std::string> streams = input.named;
    streams.insert(streams.end(), {options.other, options.trace});
    mustReadStdinOnce(streams);
    const std::string bytes = options.trace == "-" ? readStdin() : readAll(options.trace);
    std::vector<TriedPose> tried = readTrace(bytes, displayName(options.trace)).poses;
    const std::string file = displayName(options.trace);
    if (input.isOneRoom()) {
        const std::size_t all = tried.size();
        std::erase_if(tried, [&input](const TriedPose& pose) {
            return !pose.room.empty() && pose.room != input.storey;
        });
        if (tried.empty() && all > 0)
            throw UsageError("--trace: the candidates of " + file +
                             (input.storey.empty()
                                  ? " are those of a building: give it, or one of its storeys "
                                    "with --storey"
                                  : " are those of other storeys than " + excerpt(input.storey)));
        return tried;
    }
    const std::vector<std::string> ids = input.ids();
    for (const TriedPose& pose : tried) {
        if (pose.room.empty())
            throw UsageError("--trace: the candidates of " + file +
                             " are those of one room: choose it with --storey (" +
                             input.building.document.storeyList() + ')');
        if (std::find(ids.begin(), ids.end(), pose.room) == ids.end())
            throw UsageError("--trace: the building has no storey " + excerpt(pose.room) + " (" +
                             input.building.document.storeyList() + ')');
    }
    return tried;
}

namespace {

/// Returns the content of a model: the records of the scene, below the history of both inputs and
/// this command.
Document documentOf(const CoverageToolOptions& options, const SiteInput& input, std::size_t room,
                    const Scene& scene) {
    Document document;
    document.history = storeyOf(input, room).room->history;
    if (input.layout)
        document.history.insert(document.history.end(), input.layout->history.begin(),
                                input.layout->history.end());
    document.history.push_back(options.history_line);
    document.records = scene.records;
    rebaseFiles(document.records, "",
                std::filesystem::path(options.common.output).parent_path().string());
    return document;
}

/// Returns what the map of a room shows. \param parts of its report; they outlive the map
MapOptions mapOf(const CoverageToolOptions& options, const SiteInput& input,
                 const SiteResults& results, const SiteParts& parts, std::size_t room) {
    MapOptions map = options.map;
    // The last section lies below the others.
    if (!parts.storeys.empty())
        for (auto part = parts.storeys[room].rbegin(); part != parts.storeys[room].rend(); ++part)
            if (const MapLayer* const layer = (*part)->mapLayer()) map.layers.push_back(layer);
    if (input.isOneRoom()) {
        map.title = input.environment_operand == "-" ? "" : baseName(input.environment_operand);
        map.trace = results.tried;
        return map;
    }
    map.title = storeyOf(input, room).id;
    map.redundancy_scale = redundancyScale(results.coverage);
    std::copy_if(results.tried.begin(), results.tried.end(), std::back_inserter(map.trace),
                 [&map](const TriedPose& pose) { return pose.room == map.title; });
    return map;
}

/// Writes the map of a room, with its accompanying file.
void writeProduct(const CoverageToolOptions& options, const SiteInput& input,
                  const SiteResults& results, std::size_t room) {
    const std::string& output = options.common.output;
    const CoverageFormat& format = *options.format;
    const Scene& scene = *results.coverage.floors[room];
    const SiteParts parts = results.parts();
    CoverageProduct product{scene, results.coverage.storeys[room],
                            results.other ? &results.other->storeys[room] : nullptr,
                            mapOf(options, input, results, parts, room)};
    product.document = documentOf(options, input, room, scene);
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

/// Draws all storeys on one page.
void writePanels(const CoverageToolOptions& options, const SiteInput& input,
                 const SiteResults& results) {
    const SiteParts parts = results.parts();
    std::vector<Picture> panels;
    for (std::size_t i = 0; i < results.coverage.storeys.size(); ++i) {
        MapOptions map = mapOf(options, input, results, parts, i);
        map.format = *options.format->picture;
        panels.push_back(coverageMap(*results.coverage.floors[i], results.coverage.storeys[i], map,
                                     results.other ? &results.other->storeys[i] : nullptr));
    }
    Picture page = panelsOf(panels);
    page.describe(baseName(input.environment_operand),
                  "Coverage of its storeys, the lowest at the bottom");
    writeAll(options.common.output, page.write(*options.format->picture));
}

}  // namespace

void writeProducts(const CoverageToolOptions& options, const SiteInput& input,
                   const SiteResults& results) {
    if (input.isOneRoom()) return writeProduct(options, input, results, 0);
    if (!isStoreyPattern(options.common.output)) return writePanels(options, input, results);
    for (std::size_t i = 0; i < input.rooms().size(); ++i) {
        CoverageToolOptions own = options;
        own.common.output = storeyFile(options.common.output, storeyOf(input, i).id);
        claimOutput(own.common.output, "the map of a storey");
        writeProduct(own, input, results, i);
    }
}

std::vector<Diagnostic> sensorFindings(const SiteScene& building) {
    std::vector<Diagnostic> found =
        storeyWarnings(Coupling(building), {.checks = {"unplaced", "outside", "buried"}});
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        if (auto deaf = receiverFinding(*building.scenes[i])) {
            deaf->message.insert(0, building.document.storeys[i].prefix());
            found.push_back(*std::move(deaf));
        }
    return found;
}

namespace {

JunitCase caseOf(std::string name, bool is_met, std::string message) {
    return {.name = std::move(name),
            .outcome = is_met ? JunitCase::Outcome::Met : JunitCase::Outcome::Unmet,
            .message = std::move(message)};
}

}  // namespace

std::vector<JunitCase> judge(std::span<const Requirement> requirements, const SiteScene& building,
                             const SiteCoverage& coverage, const std::string& name) {
    std::vector<JunitCase> verdicts;
    verdicts.reserve(requirements.size());
    for (const Requirement& requirement : requirements) {
        Verdict verdict = checkRequirement(requirement, building, coverage);
        verdicts.push_back(
            caseOf(name + requirementText(requirement), verdict.is_met, std::move(verdict.text)));
    }
    return verdicts;
}

std::vector<JunitCase> judgeAll(const CoverageToolOptions& options, const SiteScene& building,
                                const SiteResults& results) {
    std::vector<JunitCase> verdicts = judge(options.requirements, building, results.coverage);
    for (const JudgedShare& one : results.found.judged)
        verdicts.push_back(caseOf(one.requirement, one.verdict.is_met, one.verdict.text));
    return verdicts;
}

std::string unmetText(std::span<const JunitCase> verdicts) {
    std::string text;
    for (const JunitCase& verdict : verdicts)
        if (verdict.outcome == JunitCase::Outcome::Unmet)
            text.append(text.empty() ? "" : "; ").append(verdict.message);
    return text;
}

}  // namespace ispace
