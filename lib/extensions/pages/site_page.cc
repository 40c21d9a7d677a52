// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/site_page.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "extensions/pages/cables.h"
#include "extensions/pages/installation.h"
#include "extensions/pages/page_writer.h"
#include "report/coverage_report.h"
#include "report/map/map.h"
#include "site/coupling.h"

namespace ispace::pages {

namespace {

/// Returns the share that sensors see, as a clause.
std::string seenText(const Metric& coverage) {
    const auto share = coverage.exact ? coverage.exact : coverage.grid;
    return "The sensors see " + (share ? percentText(*share) : std::string("an unknown share")) +
           (share && !coverage.exact ? " (by cells)" : "") + " of the indoor floor.";
}

PageSection buildingSummary(const SiteReport& input, std::span<const PageAdditions> additions) {
    const SiteCoverage& coverage = input.coverage;
    std::size_t sensors = 0;
    for (const std::size_t in_storey : coverage.sensors) sensors += in_storey;
    PageSection section{"summary", "Summary", {}};
    section.blocks.push_back(
        PageText{"The building has " + std::to_string(coverage.storeys.size()) + " storeys with " +
                 squareMetres(coverage.indoor_area) + " of indoor floor, " +
                 squareMetres(coverage.free_area) + " of it free, and " + std::to_string(sensors) +
                 (sensors == 1 ? " sensor." : " sensors.")});
    section.blocks.push_back(PageText{seenText(coverage.coverage)});
    for (const PageAdditions& added : additions)
        for (const PageText& text : added.sight) section.blocks.push_back(text);
    for (PageText& text : findingTexts(input.findings)) section.blocks.push_back(std::move(text));
    if (!input.requirements.empty())
        section.blocks.push_back(requirementsTable(input.requirements));
    for (const PageAdditions& added : additions)
        for (const PageText& text : added.judged) section.blocks.push_back(text);
    return section;
}

PageSection storeysSection(const SiteReport& input, std::span<const PageAdditions> additions) {
    std::vector<TextRow> rows = storeyRows(input.building, input.coverage);
    PageTable table{
        "shares of the floor that sensors see, by cells and exactly",
        "lr",
        std::move(rows.front()),
        {std::make_move_iterator(rows.begin() + 1), std::make_move_iterator(rows.end())}};
    PageSection section{"storeys", "Storeys", {}};
    section.blocks.push_back(std::move(table));
    for (const PageAdditions& added : additions)
        for (const PageBlock& table : added.tables) section.blocks.push_back(table);
    return section;
}

PageText storeySummary(const Coverage& coverage) {
    const CoverageReport& report = coverage.report;
    const std::size_t sensors = coverage.sensors.size();
    PageText text{"The storey has " + squareMetres(report.indoor_area) + " of indoor floor, " +
                  squareMetres(report.free_area) + " of it free at " +
                  formatFixed(report.height, 2) + " m; " +
                  (sensors == 0   ? "no sensor sees it."
                   : sensors == 1 ? "one sensor sees it."
                                  : std::to_string(sensors) + " sensors see it.")};
    if (sensors > 0) text.text += ' ' + sightText(report, sensors).text;
    return text;
}

/// Returns true for a storey without floor and sensors, such as a roof: a row of the storeys' table
/// says all.
bool isEmpty(const Coverage& coverage) {
    return coverage.report.indoor_area <= kNoFloor && coverage.sensors.empty();
}

PageSection storeySection(const SiteReport& input, std::size_t storey) {
    const Storey& own = input.building.document.storeys[storey];
    const Coverage& coverage = input.coverage.storeys[storey];
    static const ReportParts none;
    const ReportParts& parts = input.parts.storeys.empty() ? none : input.parts.storeys[storey];
    const PageSubject subject{PageSubject::Of::Storey, coverage.report,
                              input.coverage.floors[storey].get(), &coverage};
    const std::vector<PageAdditions> additions = additionsOf(parts, subject);
    std::string caption;
    for (const PageAdditions& added : additions)
        if (!added.caption.empty()) caption = added.caption;
    MapOptions options;
    options.redundancy_scale = redundancyScale(input.coverage);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (!additions[i].caption.empty()) options.layers.push_back(parts[i]->mapLayer());
    for (const StoreyPassage& passage : input.building.document.passages)
        if (std::find(passage.storeys.begin(), passage.storeys.end(), storey) !=
            passage.storeys.end())
            options.passages.push_back(
                {passage.id, passage.record.keyword(), footprintOf(passage, own)});
    PageSection section{"storey" + std::to_string(storey + 1), "Storey " + own.id, {}};
    constexpr double kUnseen = 0.5;  // of the column's width
    section.blocks.push_back(storeySummary(coverage));
    section.blocks.push_back(PageFigure{
        caption.empty() ? "Floor by the number of sensors that see it; coordinates in metres."
                        : caption,
        coverageMap(*input.coverage.floors[storey], coverage, options),
        coverage.sensors.empty() && caption.empty() ? kUnseen : 1});
    for (PageBlock& table : zoneTables(coverage.report)) section.blocks.push_back(std::move(table));
    for (const PageAdditions& added : additions)
        for (const PageBlock& table : added.tables) section.blocks.push_back(table);
    return section;
}

/// Adds the installation of a storey, the floor and the pictures of its sensors, and with a cover a
/// sheet for each camera.
void addSensorsOf(const SiteReport& input, const CabledRoom& room, std::size_t storey,
                  ReportPage& page, std::vector<PageSection>& sheets) {
    const Storey& own = input.building.document.storeys[storey];
    const Coverage& coverage = input.coverage.storeys[storey];
    const std::vector<Installation> installations = installationsOf(room.scene);
    if (coverage.sensors.empty()) return;
    const std::string id = "storey" + std::to_string(storey + 1);
    PageSection pictures{id + "-sensors", "Storey " + own.id + ": sensors", {}};
    pictures.blocks.push_back(sensorsTable(*input.coverage.floors[storey], coverage));
    if (installations.empty()) {
        page.sections.push_back(std::move(pictures));
        return;
    }
    const PageTable table = installationTable(room.scene, coverage, installations, room.cables);
    PageSection section{id + "-installation", "Storey " + own.id + ": installation", {}};
    section.blocks.push_back(table);
    section.blocks.push_back(installationPlan(room.scene, coverage, installations));
    section.blocks.push_back(wallFacesTable(installations));
    std::vector<PageFigure> figures = sensorPictures(room.scene, coverage, input.progress);
    if (page.cover.isGiven())
        for (PageSection& sheet : cameraSheets(room.scene, coverage, table, figures)) {
            sheet.id.insert(0, id + '-');
            sheet.title += " of storey " + own.id;
            sheets.push_back(std::move(sheet));
        }
    page.sections.push_back(std::move(section));
    for (PageFigure& figure : figures) pictures.blocks.push_back(std::move(figure));
    page.sections.push_back(std::move(pictures));
}

PageSection recordsOf(const SiteReport& input) {
    PageSection section{"records", "Appendix: records and command", {}};
    section.blocks.push_back(
        PageText{"Digest of the building: " + input.building.document.digest(), Tone::Small});
    for (std::size_t i = 0; i < input.coverage.floors.size(); ++i) {
        if (input.coverage.floors[i]->placed.empty()) continue;
        section.blocks.push_back(PageText{
            "The layout of " + input.building.document.storeys[i].id + ", as a .3dm file holds it:",
            Tone::Small});
        section.blocks.push_back(PageCode{layoutText(*input.coverage.floors[i])});
    }
    section.blocks.push_back(PageText{kCommandCaption, Tone::Small});
    section.blocks.push_back(PageCode{input.command});
    return section;
}

ReportPage pageOfRoom(const SiteReport& input, const PageStyle& style) {
    CoveragePageInput page{*input.coverage.floors.front(), input.coverage.storeys.front(),
                           input.name, input.command, input.requirements};
    page.parts = partsOfRoom(input.parts);
    page.more = input.more;
    page.media = style.media;
    page.cover = style.cover;
    page.paper = style.paper;
    page.prices = style.prices;
    page.findings = input.findings;
    page.progress = input.progress;
    return coveragePage(page);
}

}  // namespace

ReportPage sitePage(const SiteReport& input, const PageStyle& style) {
    if (input.building.isRoomAlone()) return pageOfRoom(input, style);
    const CoverageReport& first = input.coverage.storeys.front().report;
    const std::vector<PageAdditions> additions =
        additionsOf(input.parts.sum, {PageSubject::Of::Site, first});
    ReportPage page;
    page.title = input.name + (input.name.empty() ? "" : ": ") + titleOf(additions);
    page.cover = style.cover;
    if (!page.cover.title.empty()) page.title = page.cover.title;
    page.paper = style.paper;
    page.subtitle = std::to_string(input.coverage.storeys.size()) + " storeys · " +
                    squareMetres(input.coverage.indoor_area);
    const auto add = [&](std::vector<PageSection> PageAdditions::*const place) {
        for (const PageAdditions& added : additions)
            for (const PageSection& section : added.*place) page.sections.push_back(section);
    };
    page.sections.push_back(buildingSummary(input, additions));
    page.sections.push_back(storeysSection(input, additions));
    for (const PageSection& section : input.more) page.sections.push_back(section);
    if (input.coverage.comparison)
        page.sections.push_back(
            {"comparison",
             "Beside another layout",
             {PageCode{comparisonText(*input.coverage.comparison, input.coverage.coverage)}}});
    add(&PageAdditions::figures);
    std::vector<CabledRoom> rooms;
    std::vector<PageSection> sheets;
    std::int64_t sensors = 0;
    for (const Coverage& storey : input.coverage.storeys) sensors += std::ssize(storey.sensors);
    if (input.progress != nullptr) input.progress->begin("pictures of the report", sensors);
    for (std::size_t i = 0; i < input.coverage.storeys.size(); ++i) {
        const Scene& scene = *input.building.scenes[i];
        rooms.push_back({scene, cablesOf(scene)});
        if (isEmpty(input.coverage.storeys[i])) continue;
        page.sections.push_back(storeySection(input, i));
        addSensorsOf(input, rooms.back(), i, page, sheets);
    }
    if (input.progress != nullptr) input.progress->end();
    const std::vector<MaterialItem> material = materialOf(rooms, style.prices);
    if (!material.empty())
        page.sections.push_back(
            {"material", "Material", {materialTable(material, style.prices.currency)}});
    page.sections.push_back(methodsSection(first));
    for (PageSection& sheet : sheets) page.sections.push_back(std::move(sheet));
    add(&PageAdditions::closing);
    const std::size_t appendix = page.sections.size();
    add(&PageAdditions::appendices);
    page.sections.push_back(recordsOf(input));
    page.sections[appendix].begins_sheet = style.cover.isGiven();
    return typeset(std::move(page));
}

}  // namespace ispace::pages
