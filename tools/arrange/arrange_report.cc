// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/arrange_report.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "cli/progress_bar.h"
#include "passage/least_seen_trip.h"
#include "report/map/map.h"
#include "report/page/coverage_page.h"
#include "site/site_page.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

/// Lists the values of a robust layout by case, or in the worst of them, and in the mean.
PageTable casesOf(const RobustChoice& robust, const RobustValues& values) {
    PageTable table{"values in the cases of the search", "lr", {"case", "value"}, {}};
    std::string worst = "worst of all";
    if (robust.of == RobustChoice::Of::Rooms)
        for (std::size_t i = 0; i < values.names.size(); ++i)
            table.rows.push_back({values.names[i], percentText(values.shares[i])});
    if (robust.of == RobustChoice::Of::Failures) {
        for (const std::string& id : values.failed)
            worst += (&id == &values.failed.front() ? ": without " : " and ") + id;
    } else if (robust.of != RobustChoice::Of::Rooms) {
        worst = "worst of " + std::to_string(values.shares.size()) +
                (robust.of == RobustChoice::Of::Crowd ? " crowds" : " mountings");
    }
    table.rows.push_back({std::move(worst), percentText(values.worst)});
    table.rows.push_back({"mean", meanText(robust, values)});
    return table;
}

/// Returns the lines that arrange prints, and the curve as a table.
PageSection resultOf(const ArrangeToolOptions& options, const ArrangeWork& work,
                     const Arrangement& arrangement) {
    PageSection section{"result", "Result of the search", {}};
    constexpr std::string_view kTool = "arrange: ";
    Arrangement without_curve = arrangement;
    without_curve.curve.clear();
    std::string text = reportText(work, without_curve);
    if (!arrangement.is_reached) text += shortfallText(work.how, arrangement) + '\n';
    text += inexactText(work.how, arrangement);
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line = std::string_view(text).substr(begin, end - begin);
        if (line.starts_with(kTool)) line.remove_prefix(kTool.size());
        if (!line.empty()) section.blocks.push_back(PageText{std::string(line)});
        begin = end + 1;
    }
    if (arrangement.robust) section.blocks.push_back(casesOf(work.how.robust, *arrangement.robust));
    if (!arrangement.alternatives.empty()) {
        PageTable others{"layouts that differ by a metre or 30 degrees in some sensor",
                         "lrrr",
                         {"layout", "value", "gap", "coverage"},
                         {}};
        for (std::size_t i = 0; i < arrangement.alternatives.size(); ++i) {
            const Arrangement& other = arrangement.alternatives[i];
            others.rows.push_back({baseName(numberedFile(options.common.output, i + 2)),
                                   percentText(other.candidate_value), percentText(gapOf(other)),
                                   percentText(other.coverage)});
        }
        section.blocks.push_back(std::move(others));
    }
    if (arrangement.curve.empty()) return section;
    PageTable table{
        "coverage by the number of sensors", "rrr", {"sensors", "coverage", "at most"}, {}};
    for (const CurvePoint& point : arrangement.curve)
        table.rows.push_back(
            {std::to_string(point.sensors), percentText(point.value), percentText(point.bound)});
    section.blocks.push_back(std::move(table));
    return section;
}

/// Returns the building with sensors that were placed.
SiteScene placedBuilding(const ArrangeWork& work, const std::vector<Placement>& sensors) {
    SiteScene placed = work.input.building;
    for (std::size_t i = 0; i < placed.scenes.size(); ++i)
        placed.scenes[i] =
            std::make_shared<const Scene>(withPlaced(*placed.scenes[i], work.groups, sensors, i));
    return placed;
}

/// Draws a map of gains in each storey: a page with panels, or a file for each storey.
/// \param scale receives that of the colours
void writeStoreyHeat(const ArrangeWork& work, const GainMap& gains,
                     const std::vector<std::string>& files, MapOptions map, std::uint32_t& scale) {
    const SiteCoverage coverage =
        measureSite(placedBuilding(work, gains.before),
                    {.plane = work.how.plane, .density = work.how.pixel_density});
    scale = std::max(scale, redundancyScale(coverage));
    map.redundancy_scale = scale;
    const std::string title = map.title;
    std::vector<Picture> panels;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        const std::string& id = work.input.building.document.storeys[i].id;
        map.title = id;
        map.title.append(": ").append(title);
        map.trace.clear();
        for (const TriedPose& tried : gains.poses)
            if (tried.room == id) map.trace.push_back(tried);
        panels.push_back(coverageMap(*coverage.floors[i], coverage.storeys[i], map));
        if (files.size() > 1) writeAll(files[i], panels.back().write(map.format));
    }
    if (files.size() == 1) writeAll(files.front(), panelsOf(panels).write(map.format));
}

}  // namespace

std::vector<std::string> heatFiles(const ArrangeToolOptions& options, const ArrangeWork& work,
                                   std::size_t number) {
    const std::string file =
        number == 1 ? options.heat_file : numberedFile(options.heat_file, number);
    if (work.input.isOneRoom())
        return {roomFile(file, work.input.storey, work.input.environment_operand)};
    if (!isStoreyPattern(file)) return {file};
    std::vector<std::string> files;
    for (const std::string& id : work.input.ids()) files.push_back(storeyFile(file, id));
    return files;
}

void writeHeat(const ArrangeToolOptions& options, const ArrangeWork& work,
               const Arrangement& arrangement) {
    const std::string suffix = suffixOf(options.heat_file);
    // The last map, with the most sensors, sets the colours of all.
    std::uint32_t scale = 0;
    for (std::size_t i = arrangement.gains.size(); i-- > 0;) {
        const GainMap& gains = arrangement.gains[i];
        const std::vector<std::string> files = heatFiles(options, work, i + 1);
        MapOptions map;
        map.format = suffix == "svg"   ? PictureFormat::Svg
                     : suffix == "pdf" ? PictureFormat::Pdf
                                       : PictureFormat::Png;
        map.title = "gain of " + printable(gains.sensor) + ", after " +
                    std::to_string(gains.before.size()) + " placed";
        if (!work.input.isOneRoom()) {
            writeStoreyHeat(work, gains, files, map, scale);
            continue;
        }
        const Scene scene = withPlaced(work.input.only(), work.groups, gains.before);
        Worlds worlds(scene.environment);
        const Coverage coverage = measureCoverage(
            scene, worlds, {.plane = work.how.plane, .density = work.how.pixel_density});
        scale = std::max(scale, redundancyScale(coverage.report));
        map.redundancy_scale = scale;
        map.trace = gains.poses;
        writeAll(files.front(), drawCoverageMap(scene, coverage, map));
    }
}

namespace {

/// Returns the building with the layout that was found.
SiteScene placedBuilding(const ArrangeWork& work, const Arrangement& arrangement) {
    return placedBuilding(work, arrangement.sensors);
}

CoverageOptions measuredAs(const ArrangeOptions& how) {
    return {.plane = how.plane, .density = how.pixel_density};
}

/// Judges the faces in each storey.
std::vector<FacingResult> facingOf(const ArrangeWork& work, const SiteCoverage& coverage) {
    std::vector<FacingResult> all;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i)
        for (FacingResult& result :
             measureFacing(*coverage.floors[i], coverage.storeys[i], work.goals[i].facing)) {
            result.rule.zone.insert(0, work.input.building.document.storeys[i].id + '/');
            all.push_back(std::move(result));
        }
    return all;
}

}  // namespace

std::optional<CameraRules> cameraRulesOf(const ArrangeWork& work, const Arrangement& arrangement) {
    if (work.how.facing.empty() && work.how.privacy.empty()) return std::nullopt;
    CameraRules rules{{}, arrangement.privacy};
    if (work.how.facing.empty()) return rules;
    if (!work.input.isOneRoom()) {
        rules.facing =
            facingOf(work, measureSite(placedBuilding(work, arrangement), measuredAs(work.how)));
        return rules;
    }
    const Scene scene = withPlaced(work.input.only(), work.groups, arrangement.sensors);
    Worlds worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, measuredAs(work.how));
    rules.facing = measureFacing(scene, coverage, work.how.facing);
    return rules;
}

namespace {

/// Judges --objective path and localise in each storey and over all.
std::optional<SiteObjectives> objectivesIn(const ArrangeWork& work, const SiteScene& building,
                                           const SiteCoverage& coverage) {
    const ObjectiveChoice& objective = work.how.objective;
    if (objective.isCoverage()) return std::nullopt;
    const bool is_path = objective.of == ObjectiveChoice::Of::Path;
    return measureObjectives(building, coverage, {&objective.way, is_path ? 1U : 0U},
                             work.how.redundancy,
                             is_path ? std::nullopt : std::optional(objective.within));
}

std::optional<ObjectiveFigures> objectivesOf(const ObjectiveChoice& objective, int times,
                                             const Scene& scene, const Coverage& coverage) {
    ObjectiveFigures figures;
    if (objective.isCoverage()) return std::nullopt;
    if (objective.of == ObjectiveChoice::Of::Path)
        figures.ways.push_back(findLeastSeenWay(scene, coverage, objective.way, times));
    else
        figures.localisation = localise(scene, coverage, objective.within);
    return figures;
}

}  // namespace

std::optional<ObjectiveFigures> objectivesOf(const ArrangeWork& work,
                                             const Arrangement& arrangement) {
    if (work.how.objective.isCoverage()) return std::nullopt;
    // Positions are judged by cells; the regions for ways may take longer than a limit of time
    // allows.
    CoverageOptions measured = measuredAs(work.how);
    measured.exact = work.how.objective.of == ObjectiveChoice::Of::Path && arrangement.is_complete;
    if (!work.input.isOneRoom()) {
        const SiteScene building = placedBuilding(work, arrangement);
        return objectivesIn(work, building, measureSite(building, measured))->all;
    }
    const Scene scene = withPlaced(work.input.only(), work.groups, arrangement.sensors);
    Worlds worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, measured);
    return objectivesOf(work.how.objective, work.how.redundancy, scene, coverage);
}

namespace {

/// Returns the name of the room or building; "" from stdin.
std::string nameOf(const SiteInput& input) {
    return input.environment_operand != "-" ? baseName(input.environment_operand) : "";
}

std::vector<JudgedRequirement> targetOf(const ArrangeWork& work, const Arrangement& arrangement) {
    if (!work.how.target) return {};
    return {{formatPercent(*work.how.target), arrangement.is_reached,
             "the sensors cover " + percentText(arrangement.value.value_or(arrangement.coverage)) +
                 (work.how.weights.isUniform() ? "" : " of the floor that counts"),
             arrangement.value.value_or(arrangement.coverage) - *work.how.target}};
}

/// Returns the bytes of a page by the suffix of its file.
std::string finished(const ArrangeToolOptions& options, const ReportPage& page) {
    return suffixOf(options.report_file) == "pdf" ? pdfOf(page) : htmlOf(page);
}

std::string buildingReport(const ArrangeToolOptions& options, const ArrangeWork& work,
                           const Arrangement& arrangement, const std::string& command) {
    const SiteScene building = placedBuilding(work, arrangement);
    const SiteCoverage coverage = measureSite(building, measuredAs(work.how));
    const std::optional<SiteObjectives> objectives = objectivesIn(work, building, coverage);
    if (suffixOf(options.report_file) == "json") {
        SiteParts parts;
        if (objectives) {
            parts.storeys.resize(coverage.storeys.size());
            for (std::size_t i = 0; i < parts.storeys.size(); ++i)
                parts.storeys[i].objectives = &objectives->storeys[i];
            parts.sum.objectives = &objectives->all;
        }
        return siteCoverageJson(building, coverage, parts);
    }
    SitePageInput input{building, coverage, nameOf(work.input), command,
                        targetOf(work, arrangement)};
    PageSection result = resultOf(options, work, arrangement);
    const CameraRules rules{facingOf(work, coverage), arrangement.privacy};
    for (const JudgedRule& rule : judgedRules(rules))
        result.blocks.push_back(PageText{rule.rule + ": " + rule.finding});
    input.more.push_back(std::move(result));
    if (objectives) input.parts.sum.objectives = &objectives->all;
    input.cover = coverOf(options.page);
    input.paper = paperOf(options.page);
    input.prices = pricesOf(options.page);
    const auto progress = makeProgress("arrange", options.common.progress, options.common.quiet);
    input.progress = progress.get();
    return finished(options, sitePage(input));
}

}  // namespace

std::string reportFile(const ArrangeToolOptions& options, const ArrangeWork& work,
                       const Arrangement& arrangement, const Document& layout,
                       const std::string& command) {
    if (!work.input.isOneRoom()) return buildingReport(options, work, arrangement, command);
    const Scene scene = makeScene(work.input.environment(), &layout, shippedDevices());
    Worlds worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, measuredAs(work.how));
    const CameraRules rules{measureFacing(scene, coverage, work.how.facing), arrangement.privacy};
    ReportParts parts;
    if (!rules.facing.empty() || !rules.privacy.empty()) parts.rules = &rules;
    const auto objectives = objectivesOf(work.how.objective, work.how.redundancy, scene, coverage);
    if (objectives) parts.objectives = &*objectives;
    if (suffixOf(options.report_file) == "json") return coverageJson(coverage.report, parts);
    CoveragePageInput page{scene, coverage, nameOf(work.input), command};
    page.parts = parts;
    page.more.push_back(resultOf(options, work, arrangement));
    if (work.how.target)
        page.requirements.push_back({formatPercent(*work.how.target), arrangement.is_reached,
                                     "the sensors cover " + percentText(arrangement.coverage),
                                     arrangement.coverage - *work.how.target});
    page.cover = coverOf(options.page);
    page.paper = paperOf(options.page);
    page.prices = pricesOf(options.page);
    const auto progress = makeProgress("arrange", options.common.progress, options.common.quiet);
    page.progress = progress.get();
    return finished(options, coveragePage(page));
}

void writeMaterialOf(const ArrangeToolOptions& options, const ArrangeWork& work,
                     const Arrangement& arrangement, const Document& layout) {
    if (options.page.material.empty() && options.page.prices.empty()) return;
    std::vector<std::shared_ptr<const Scene>> scenes;
    if (!work.input.isOneRoom())
        scenes = placedBuilding(work, arrangement).scenes;
    else
        scenes.push_back(std::make_shared<const Scene>(
            makeScene(work.input.environment(), &layout, shippedDevices())));
    if (const std::string text = writeMaterialOf(options.page, scenes); !text.empty())
        warn(options.common, "arrange", text);
}

}  // namespace ispace
