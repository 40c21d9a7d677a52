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
#include "report/map/map.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

/// Lists the values of a layout in the cases of the search.
PageTable casesOf(const LayoutCases& cases, const CaseShares& values) {
    PageTable table{"values in the cases of the search", "lr", {"case", "value"}, {}};
    for (CaseRow& row : cases.rows(values))
        table.rows.push_back({std::move(row.name), std::move(row.value)});
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
    if (arrangement.cases) section.blocks.push_back(casesOf(*work.how.cases, *arrangement.cases));
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

/// Returns the room or building with sensors that were placed.
SiteScene placedSite(const ArrangeWork& work, const std::vector<Placement>& sensors) {
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
        measureSite(placedSite(work, gains.before),
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
        RayScenes worlds(scene.environment);
        const Coverage coverage = measureCoverage(
            scene, worlds, {.plane = work.how.plane, .density = work.how.pixel_density});
        scale = std::max(scale, redundancyScale(coverage.report));
        map.redundancy_scale = scale;
        map.trace = gains.poses;
        writeAll(files.front(), drawCoverageMap(scene, coverage, map));
    }
}

namespace {

CoverageOptions measuredAs(const ArrangeOptions& how) {
    return {.plane = how.plane, .density = how.pixel_density};
}

/// Returns a layout as groups of extensions see it.
ArrangedSite judgedSite(const ArrangeWork& work, const Arrangement& arrangement,
                        const SiteScene& placed, const SiteCoverage* coverage) {
    return {work.input, *work.site, work.groups, work.how, arrangement, placed, coverage};
}

}  // namespace

ArrangeFindings findingsOf(const ArrangeToolOptions& options, const ArrangeWork& work,
                           const Arrangement& arrangement) {
    if (!options.groups->isAsked()) return {};
    const SiteScene placed = placedSite(work, arrangement.sensors);
    return options.groups->judge(judgedSite(work, arrangement, placed, nullptr));
}

ArrangeFindings figuresOf(const ArrangeToolOptions& options, const ArrangeWork& work,
                          const Arrangement& arrangement) {
    ArrangeFindings figures;
    if (!work.how.objective) return figures;
    const SiteScene placed = placedSite(work, arrangement.sensors);
    options.objective->judge(judgedSite(work, arrangement, placed, nullptr), figures);
    return figures;
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

/// Returns the site with the layout as it was written: of a room alone with its records.
SiteScene laidOut(const ArrangeWork& work, const Arrangement& arrangement, const Document& layout) {
    if (!work.input.isOneRoom()) return placedSite(work, arrangement.sensors);
    SiteScene site = work.input.building;
    site.scenes = {std::make_shared<const Scene>(
        makeScene(work.input.environment(), &layout, shippedDevices()))};
    return site;
}

}  // namespace

std::string reportFile(const ArrangeToolOptions& options, const ArrangeWork& work,
                       const Arrangement& arrangement, const Document& layout,
                       const std::string& command) {
    const SiteScene site = laidOut(work, arrangement, layout);
    const SiteCoverage coverage = measureSite(site, measuredAs(work.how));
    const ArrangedSite judged = judgedSite(work, arrangement, site, &coverage);
    ArrangeFindings findings = options.groups->judge(judged);
    if (work.how.objective) options.objective->judge(judged, findings);
    SiteParts& parts = findings.parts;
    const ReportGroup* const form = options.reports->of(options.report_file);
    if (form == nullptr) return siteCoverageJson(site, coverage, parts);
    SiteReport report{site, coverage, nameOf(work.input), command, targetOf(work, arrangement)};
    report.parts = std::move(parts);
    report.more.push_back(resultOf(options, work, arrangement));
    const auto progress = makeProgress("arrange", options.common.progress, options.common.quiet);
    report.progress = progress.get();
    return form->bytesOf(form->page(report, options.report_file), options.report_file);
}

void writeReportLists(const ArrangeToolOptions& options, const ArrangeWork& work,
                      const Arrangement& arrangement, const Document& layout) {
    if (!options.reports->isAsked()) return;
    const SiteScene site = laidOut(work, arrangement, layout);
    warn(options.common, "arrange", options.reports->writeFiles(site.scenes));
}

}  // namespace ispace
