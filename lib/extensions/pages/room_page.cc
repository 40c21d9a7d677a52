// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/room_page.h"

#include <cstddef>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "drawing/plan/plan.h"
#include "env/environment.h"
#include "env/zone.h"
#include "extensions/pages/page_writer.h"
#include "record/text.h"
#include "scene/findings/findings.h"

namespace ispace::pages {

namespace {

PageSection summaryOf(const Scene& scene, const EnvironmentInfo& info) {
    const Box2& limits = info.limits;
    PageSection section{"summary", "Summary", {}};
    section.blocks.push_back(PageText{
        "The room has " + squareMetres(info.indoor_area) + " of indoor floor, " +
        squareMetres(info.free_area) + " of it free at " + formatFixed(kScanHeight, 2) +
        " m, within " + formatFixed(limits.width(), 2) + " m by " + formatFixed(limits.depth(), 2) +
        " m; its highest wall has " + formatFixed(info.height, 2) + " m."});
    PageTable table{"records", "lr", {"kind", "number"}, {}};
    for (const auto& [keyword, count] : info.counts)
        table.rows.push_back({keyword, std::to_string(count)});
    section.blocks.push_back(std::move(table));
    if (!scene.sensors.empty())
        section.blocks.push_back(
            PageText{"coverage(1) reports the floor that its sensors see.", Tone::Small});
    return section;
}

PageSection findingsOf(const RoomPageInput& input) {
    PageSection section{"findings", "Findings", {}};
    for (const Diagnostic& warning : input.warnings)
        section.blocks.push_back(PageText{printable(warning.message), Tone::Bad});
    for (const Finding& finding : checkScene(input.scene))
        section.blocks.push_back(
            PageText{printable(finding.text()),
                     finding.severity == Severity::Error ? Tone::Bad : Tone::Plain});
    if (section.blocks.empty())
        section.blocks.push_back(PageText{"envc --check finds no mistake.", Tone::Good});
    return section;
}

/// Lists zones with their area, and openings with their middle and width.
PageSection partsOf(const Environment& environment) {
    PageSection section{"parts", "Zones, doors and windows", {}};
    PageTable zones{"zones", "lrrr", {"zone", "area", "x", "y"}, {}};
    PageTable openings{"doors and windows", "llrrr", {"opening", "kind", "x", "y", "width"}, {}};
    for (const Element& element : environment.elements()) {
        if (element.record.keyword() != "zone") continue;
        const Region zone{zoneOutline(element.record), {}};
        const Point2 middle = bounds(zone.outline).center();
        zones.rows.push_back({element.id, squareMetres(std::abs(signedArea(zone.outline))),
                              formatFixed(middle.x, 2), formatFixed(middle.y, 2)});
    }
    for (const char* keyword : {"door", "window"})
        for (const Doorway& opening : doorwaysOf(environment, keyword)) {
            const auto& [a, b] = opening.line;
            const Point2 middle = a + 0.5 * (b - a);
            openings.rows.push_back({opening.id, keyword, formatFixed(middle.x, 2),
                                     formatFixed(middle.y, 2), formatFixed(distance(a, b), 2)});
        }
    if (!zones.rows.empty()) section.blocks.push_back(std::move(zones));
    if (!openings.rows.empty()) section.blocks.push_back(std::move(openings));
    return section;
}

PageSection recordsOf(const RoomPageInput& input) {
    constexpr std::size_t kReadable = 60'000;  // characters
    PageSection section{"records", "Records", {}};
    Document document;
    document.records = input.scene.records;
    std::string text = writeRecordText(document);
    if (text.size() > kReadable)
        section.blocks.push_back(PageText{"The records have " + std::to_string(text.size()) +
                                              " characters; envc --to env writes them.",
                                          Tone::Small});
    else
        section.blocks.push_back(PageCode{std::move(text)});
    section.blocks.push_back(PageText{kCommandCaption, Tone::Small});
    section.blocks.push_back(PageCode{input.command});
    return section;
}

}  // namespace

ReportPage roomPage(const RoomPageInput& input) {
    const Scene& scene = input.scene;
    const EnvironmentInfo info = describe(scene.environment, scene.records, scene.digest());
    ReportPage page;
    page.title = input.name.empty() ? "Room" : input.name;
    page.subtitle = squareMetres(info.indoor_area) + " · " + info.digest;
    page.sections.push_back(summaryOf(scene, info));
    PlanOptions options;
    options.format = PictureFormat::Svg;  // to scale
    options.found = input.found;
    page.sections.push_back(
        {"plan", "Plan", {PageFigure{"Coordinates in metres.", planPicture(scene, options)}}});
    page.sections.push_back(findingsOf(input));
    if (PageSection parts = partsOf(scene.environment); !parts.blocks.empty())
        page.sections.push_back(std::move(parts));
    if (input.found != nullptr && input.found->any_plan)
        page.sections.push_back(
            {"rooms", "Rooms that were found", {PageCode{roomsText(*input.found)}}});
    page.sections.push_back(recordsOf(input));
    return typeset(std::move(page));
}

ReportPage pageOf(const RoomReport& report) {
    const SiteScene& building = report.building;
    if (building.isRoomAlone())
        return roomPage(
            {*building.scenes.front(), report.name, report.command, report.found, report.warnings});
    ReportPage page;
    page.title = report.name.empty() ? "Building" : report.name;
    double area = 0;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Scene& scene = *building.scenes[i];
        area += scene.environment.indoor().area();
        const Storey& storey = building.document.storeys[i];
        const std::string name = storey.record.has("name") ? storey.record.text("name") : storey.id;
        RoomPageInput room{scene, name, report.command};
        if (i == 0) room.warnings = report.warnings;
        ReportPage own = roomPage(room);
        for (std::size_t k = 0; k < own.sections.size(); ++k) {
            PageSection& section = own.sections[k];
            section.id = storey.id + '-' + section.id;
            section.title = name + ": " + section.title;
            section.begins_sheet |= k == 0 && i > 0;
            page.sections.push_back(std::move(section));
        }
    }
    page.subtitle = squareMetres(area) + " · " + building.document.digest();
    return typeset(std::move(page));
}

}  // namespace ispace::pages
