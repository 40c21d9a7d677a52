// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/coverage_page.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "extensions/pages/indoor_floor.h"
#include "extensions/pages/installation.h"
#include "extensions/pages/page_writer.h"
#include "extensions/pages/screen_map.h"
#include "record/text.h"
#include "report/map/map.h"
#include "report/map/sensor_colors.h"
#include "scene/sensor/density_classes.h"
#include "scene/sensor/lens_resolution.h"

namespace ispace::pages {

namespace {

std::string marginText(const JudgedRequirement& requirement) {
    if (!requirement.margin) return "-";
    const std::string text = formatFixed(100 * *requirement.margin, 2);
    return (text.front() == '-' ? "" : "+") + text;
}

std::optional<double> best(const Metric& metric) {
    return metric.exact ? metric.exact : metric.grid;
}

std::string shareText(const Metric& metric) {
    const auto share = best(metric);
    if (!share) return "unknown";
    return percentText(*share) + (metric.exact ? "" : " (by cells)");
}

std::string pointText(Point2 p) {
    return "(" + formatFixed(p.x, 2) + ", " + formatFixed(p.y, 2) + ")";
}

/// Returns "3 sensors: 2 × urg-04lx, 1 × camera".
std::string sensorsText(const Scene& scene) {
    std::map<std::string, std::size_t> counts;
    for (const Sensor& sensor : scene.sensors) ++counts[deviceText(sensor)];
    const std::size_t all = scene.sensors.size();
    if (all == 0) return "no sensors";
    std::string text = std::to_string(all) + (all == 1 ? " sensor" : " sensors");
    std::string_view separator = ": ";
    for (const auto& [device, count] : counts) {
        text.append(separator).append(std::to_string(count)).append(" × ").append(device);
        separator = ", ";
    }
    return text;
}

/// Returns the share of indoor floor that two sensors or more see.
std::optional<double> seenTwice(const CoverageReport& report) {
    const std::vector<double>& shares =
        report.redundancy_exact ? *report.redundancy_exact : report.redundancy;
    if (!report.redundancy_exact && !report.coverage.grid) return std::nullopt;
    double sum = 0;
    for (std::size_t k = 2; k < shares.size(); ++k) sum += shares[k];
    return sum;
}

/// Returns the share of floor on which cameras identify people, as a clause; "" without cameras.
std::string identifiedText(const CoverageReport& report) {
    for (std::size_t i = 0; i < report.densities.indoor.size(); ++i)
        if (const DensityClass& one = densityClasses()[i]; one.name == "identify")
            return "; cameras identify people (" + classNames(i) + ", from " +
                   formatDouble(one.pixels_per_metre) + " pixels a metre up) on " +
                   shareText(report.densities.indoor[i]);
    return "";
}

}  // namespace

std::vector<PageAdditions> additionsOf(const ReportParts& parts, const PageSubject& subject) {
    std::vector<PageAdditions> additions;
    additions.reserve(parts.size());
    for (const auto& section : parts) additions.push_back(section->page(subject));
    return additions;
}

std::string titleOf(std::span<const PageAdditions> additions) {
    for (const PageAdditions& added : additions)
        if (!added.title.empty()) return added.title;
    return "coverage";
}

PageText sightText(const CoverageReport& report, std::size_t sensors) {
    std::string seen = "The sensors see " + shareText(report.coverage) + " of the indoor floor" +
                       judgedAtText(report);
    if (const auto twice = seenTwice(report); twice && sensors > 1)
        seen += ", and two or more of them " + percentText(*twice);
    seen += identifiedText(report) + ".";
    if (!report.unseen.empty())
        seen += " The largest spot of free floor that none sees has " +
                squareMetres(report.unseen.front().area) + " around " +
                pointText(report.unseen.front().place) + ".";
    return {std::move(seen)};
}

namespace {

PageSection summaryOf(const CoveragePageInput& input, std::span<const PageAdditions> additions) {
    const CoverageReport& report = input.coverage.report;
    PageSection section{"summary", "Summary", {}};
    section.blocks.push_back(PageText{"The room has " + squareMetres(report.indoor_area) +
                                      " of indoor floor, " + squareMetres(report.free_area) +
                                      " of it free at " + formatFixed(report.height, 2) +
                                      " m, and " + sensorsText(input.scene) + "."});
    if (!input.scene.sensors.empty())
        section.blocks.push_back(sightText(report, input.scene.sensors.size()));
    for (const PageAdditions& added : additions)
        for (const PageText& text : added.sight) section.blocks.push_back(text);
    for (PageText& text : findingTexts(input.findings)) section.blocks.push_back(std::move(text));
    for (const JudgedRequirement& one : input.requirements)
        section.blocks.push_back(
            PageText{"Required: " + one.requirement + "; " + outcomeText(one.is_met, one.finding),
                     one.is_met ? Tone::Good : Tone::Bad});
    for (const PageAdditions& added : additions)
        for (const PageText& text : added.judged) section.blocks.push_back(text);
    return section;
}

/// Sets the pixels a radian of a camera.
void addResolution(const Camera& camera, MapSensor& sensor) {
    constexpr int kRings = 32, kBearings = 16;
    const LensResolution lens(camera);
    sensor.widest = camera.widestInPicture();
    sensor.bearings = camera.isLopsided() ? kBearings : 1;
    for (std::size_t k = 0; k < sensor.bearings; ++k) {
        const double bearing = 2 * std::numbers::pi * static_cast<double>(k) / kBearings;
        for (int i = 0; i <= kRings; ++i) {
            const auto [c, s] = cosSin(i * (1.0 / kRings) * sensor.widest);
            sensor.resolution.push_back(
                lens.at({c, -s * std::cos(bearing), -s * std::sin(bearing)}));
        }
    }
}

PageSection mapOf(const CoveragePageInput& input) {
    using Media = CoveragePageInput::Media;
    // Maps of thousands of views take more memory than all the rest.
    const Picture blank(1, 1);
    ScreenMap screen = input.media == Media::Paper ? ScreenMap{blank, blank, {}}
                                                   : drawScreenMap(input.scene, input.coverage);
    MapIndex index{screen.view, {}, {"density 2015", "density 2025", "views"}};
    const std::vector<Color> colors = sensorColors(input.coverage);
    for (const SensorView& view : input.coverage.sensors) {
        const Sensor& sensor = input.scene.sensors[view.index];
        const auto* const camera = sensor.tryAs<Camera>();
        const bool is_level = sensor.is<Laser>() && sensor.pose.isLevel();
        index.sensors.push_back({view.id, std::string(view.kind->noun), view.pose,
                                 is_level ? view.pose.position.z : input.coverage.report.plane,
                                 colors[index.sensors.size()]});
        if (camera != nullptr) addResolution(*camera, index.sensors.back());
    }
    PageSection section{"map", "Map", {}};
    section.blocks.push_back(PageMap{
        {"Floor by the number of sensors that see it; coordinates in metres.",
         input.media == Media::Screen ? blank : coverageMap(input.scene, input.coverage, {})},
        std::move(screen.map),
        std::move(index)});
    section.blocks.push_back(PageFigure{"", std::move(screen.legend), 1, true});
    return section;
}

constexpr DensityStandard kStandards[] = {DensityStandard::Classes2015,
                                          DensityStandard::Levels2025};

/// Lists zones with the share of their floor that sensors see.
PageTable zonesOfReport(const CoverageReport& report) {
    PageTable table{"share of each zone's floor", "lr", {"zone", "area", "seen"}, {}};
    for (const ZoneMetrics& zone : report.zones)
        table.rows.push_back({zone.id, squareMetres(zone.area),
                              zone.area > 0 ? shareText(zone.coverage) : "outside the room"});
    return table;
}

/// Lists the whole floor and zones with the shares that cameras see, by the names of a standard.
PageTable densitiesOfReport(const CoverageReport& report, DensityStandard standard) {
    PageTable table{"share of the floor that cameras see with at least this many pixels a metre, " +
                        std::string(nameOf(standard)) +
                        "; each column includes the finer ones to its right, so that a row may "
                        "sum to more than 100%",
                    "lr",
                    {"floor"},
                    {}};
    for (const std::size_t index : classesOf(standard))
        table.heads.push_back(std::string(className(index, standard)) + ", " +
                              formatDouble(densityClasses()[index].pixels_per_metre));
    const auto add = [&](std::string name, const std::vector<Metric>& densities) {
        TextRow row = {std::move(name)};
        for (const std::size_t index : classesOf(standard))
            row.push_back(shareText(densities[index]));
        table.rows.push_back(std::move(row));
    };
    add("indoor", report.densities.indoor);
    for (const ZoneMetrics& zone : report.zones)
        if (zone.area > 0) add("zone " + zone.id, zone.densities);
    return table;
}

void addRequirements(const CoveragePageInput& input, ReportPage& page) {
    const CoverageReport& report = input.coverage.report;
    const bool has_cameras = !report.densities.indoor.empty();
    if (input.requirements.empty() && report.zones.empty() && !has_cameras) return;
    PageSection section{
        "requirements",
        input.requirements.empty() ? "Zones and densities" : "Requirements and zones",
        {}};
    if (!input.requirements.empty())
        section.blocks.push_back(requirementsTable(input.requirements));
    for (PageBlock& table : zoneTables(report)) section.blocks.push_back(std::move(table));
    page.sections.push_back(std::move(section));
}

}  // namespace

std::vector<PageText> findingTexts(const std::vector<Diagnostic>& findings) {
    std::vector<PageText> texts;
    texts.reserve(findings.size());
    for (const Diagnostic& finding : findings)
        texts.push_back({"Found: " + finding.message + ".", Tone::Bad});
    return texts;
}

PageTable sensorsTable(const Scene& scene, const Coverage& coverage) {
    PageTable table{
        "indoor floor in square metres: seen, seen by no other sensor, shared with others",
        "llr",
        {"sensor", "device", "sees", "alone", "shared"},
        {}};
    const std::vector<IndoorFloor> floors = indoorFloors(scene, coverage);
    for (std::size_t i = 0; i < floors.size(); ++i) {
        const SensorView& view = coverage.sensors[i];
        const IndoorFloor& floor = floors[i];
        table.rows.push_back({view.id,
                              view.model.empty() ? std::string(view.kind->keyword) : view.model,
                              formatFixed(floor.seen, 2), formatFixed(floor.alone, 2),
                              formatFixed(floor.seen - floor.alone, 2)});
    }
    return table;
}

namespace {

/// \return the sheets of cameras, with a cover
std::vector<PageSection> addInstallation(const CoveragePageInput& input, ReportPage& page) {
    if (input.scene.sensors.empty()) return {};
    const std::vector<Installation> installations = installationsOf(input.scene);
    PageSection section{"installation", "Installation", {}};
    const std::vector<Cable> cables = cablesOf(input.scene);
    const PageTable table = installationTable(input.scene, input.coverage, installations, cables);
    section.blocks.push_back(table);
    section.blocks.push_back(installationPlan(input.scene, input.coverage, installations));
    section.blocks.push_back(wallFacesTable(installations));
    if (!installations.empty()) page.sections.push_back(std::move(section));
    if (input.progress != nullptr)
        input.progress->begin("pictures of the report", std::ssize(input.coverage.sensors));
    std::vector<PageFigure> figures = sensorPictures(input.scene, input.coverage, input.progress);
    if (input.progress != nullptr) input.progress->end();
    std::vector<PageSection> sheets;
    if (input.cover.isGiven()) sheets = cameraSheets(input.scene, input.coverage, table, figures);
    PageSection pictures{"sensors", "Sensors", {}};
    pictures.blocks.push_back(sensorsTable(input.scene, input.coverage));
    for (PageFigure& figure : figures) pictures.blocks.push_back(std::move(figure));
    page.sections.push_back(std::move(pictures));
    PageTable material =
        materialTable(materialOf(input.scene, cables, input.prices), input.prices.currency);
    page.sections.push_back({"material", "Material", {std::move(material)}});
    return sheets;
}

}  // namespace

PageSection methodsSection(const CoverageReport& report) {
    PageSection section{"methods", "Methods and limits", {}};
    const auto add = [&](std::string text) { section.blocks.push_back(PageText{std::move(text)}); };
    add("A level laser sees the floor in its slice, at its height; all other sensors see the plane "
        "at " +
        formatFixed(report.plane, 2) +
        " m, within field of view and range, where no wall or thing hides it. Clear glass lets "
        "light pass. Sensors, robots and people hide no floor.");
    add("Shares are of the indoor floor, the region that the walls enclose" +
        std::string(report.coverage.exact
                        ? "; they are computed in closed form, without cells."
                        : "; they are counted on " + cellsText(report.grid) + "."));
    if (report.outside.value_or(0) >= kMinPiece)
        add("Sensors also see " + squareMetres(*report.outside) +
            " beyond the limits of the room, through windows and open doors, which is part of no "
            "other figure.");
    if (!report.exact_missing.empty())
        add("Some figures are counted on cells: " + printable(report.exact_missing) + ".");
    if (!report.densities.indoor.empty())
        add("Pixels a metre are those of the lens with its distortion on a flat target that faces "
            "the camera, along the line on it that has fewest; those beside people are of their "
            "faces, at 1.60 m. Light, motion and focus are not part of them.");
    add("A layout is as good as its plan: measure the room before mounting, and keep the distances "
        "to walls rather than the coordinates where the two differ.");
    return section;
}

std::string layoutText(const Scene& scene) {
    Document layout;
    layout.kind = DocumentKind::Layout;
    for (const PlacedRecord& placed : scene.placed)
        layout.records.push_back(scene.records[placed.record]);
    return writeRecordText(layout);
}

std::vector<PageBlock> zoneTables(const CoverageReport& report) {
    std::vector<PageBlock> tables;
    if (!report.zones.empty()) tables.emplace_back(zonesOfReport(report));
    if (!report.densities.indoor.empty())
        for (const DensityStandard standard : kStandards)
            tables.emplace_back(densitiesOfReport(report, standard));
    return tables;
}

namespace {

PageSection recordsOf(const CoveragePageInput& input) {
    PageSection section{"records", "Appendix: records and command", {}};
    section.blocks.push_back(PageText{
        "The layout, as a .3dm file holds it. Digest of the room: " + input.coverage.report.digest,
        Tone::Small});
    section.blocks.push_back(PageCode{layoutText(input.scene)});
    section.blocks.push_back(PageText{kCommandCaption, Tone::Small});
    section.blocks.push_back(PageCode{input.command});
    return section;
}

}  // namespace

PageTable requirementsTable(std::span<const JudgedRequirement> requirements) {
    PageTable table{"each requirement with its measurement, and the margin in points of a per cent",
                    "llrl",
                    {"requirement", "result", "margin", "measured"},
                    {}};
    for (const JudgedRequirement& one : requirements) {
        table.rows.push_back(
            {one.requirement, one.is_met ? "met" : "not met", marginText(one), one.finding});
        table.tones.push_back(one.is_met ? Tone::Good : Tone::Bad);
    }
    return table;
}

ReportPage coveragePage(const CoveragePageInput& input) {
    ReportPage page;
    const PageSubject subject{PageSubject::Of::Room, input.coverage.report, &input.scene,
                              &input.coverage};
    const std::vector<PageAdditions> additions = additionsOf(input.parts, subject);
    page.title = input.name + (input.name.empty() ? "" : ": ") + titleOf(additions);
    if (!input.cover.title.empty()) page.title = input.cover.title;
    page.cover = input.cover;
    page.paper = input.paper;
    page.subtitle = sensorsText(input.scene) + " · " +
                    squareMetres(input.coverage.report.indoor_area) + " · " +
                    shareText(input.coverage.report.coverage);
    const auto add = [&](std::vector<PageSection> PageAdditions::*const place) {
        for (const PageAdditions& added : additions)
            for (const PageSection& section : added.*place) page.sections.push_back(section);
    };
    page.sections.push_back(summaryOf(input, additions));
    page.sections.push_back(mapOf(input));
    for (const PageSection& section : input.more) page.sections.push_back(section);
    addRequirements(input, page);
    add(&PageAdditions::figures);
    std::vector<PageSection> sheets = addInstallation(input, page);
    add(&PageAdditions::closing);
    page.sections.push_back(methodsSection(input.coverage.report));
    for (PageSection& sheet : sheets) page.sections.push_back(std::move(sheet));
    const std::size_t appendix = page.sections.size();
    add(&PageAdditions::appendices);
    page.sections.push_back(recordsOf(input));
    page.sections[appendix].begins_sheet = input.cover.isGiven();
    return typeset(std::move(page));
}

}  // namespace ispace::pages
