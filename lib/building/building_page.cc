// SPDX-License-Identifier: GPL-3.0-or-later
#include "building/building_page.h"

#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "report/coverage_report.h"
#include "report/map/map.h"
#include "report/run_report.h"

namespace ispace {

namespace {

/// Returns the share that sensors see, as a clause.
std::string seenText(const Metric& coverage) {
    const auto share = coverage.exact ? coverage.exact : coverage.grid;
    return "The sensors see " + (share ? percentText(*share) : std::string("an unknown share")) +
           (share && !coverage.exact ? " (by cells)" : "") + " of the indoor floor.";
}

PageSection buildingSummary(const BuildingPageInput& input) {
    const BuildingCoverage& coverage = input.coverage;
    std::size_t sensors = 0;
    for (const std::size_t in_storey : coverage.sensors) sensors += in_storey;
    PageSection section{"summary", "Summary", {}};
    section.blocks.push_back(
        PageText{"The building has " + std::to_string(coverage.storeys.size()) + " storeys with " +
                 squareMetres(coverage.indoor_area) + " of indoor floor, " +
                 squareMetres(coverage.free_area) + " of it free, and " + std::to_string(sensors) +
                 (sensors == 1 ? " sensor." : " sensors.")});
    section.blocks.push_back(PageText{seenText(coverage.coverage)});
    if (input.run != nullptr && !input.run->sum.all.time_shares.empty())
        section.blocks.push_back(
            PageText{"In the run of " + formatFixed(input.run->sum.end - input.run->sum.begin, 2) +
                     " s robots and people on storeys were seen for " +
                     percentText(1 - input.run->sum.all.time_shares.front()) + " of their time."});
    if (input.run != nullptr)
        for (PageText& text : incidentsOf(input.run->sum))
            section.blocks.push_back(std::move(text));
    if (!input.requirements.empty())
        section.blocks.push_back(requirementsTable(input.requirements));
    return section;
}

PageSection storeysSection(const BuildingPageInput& input) {
    std::vector<TextRow> rows = storeyRows(input.building, input.coverage);
    PageTable table{
        "shares of the floor that sensors see, by cells and exactly",
        "lr",
        std::move(rows.front()),
        {std::make_move_iterator(rows.begin() + 1), std::make_move_iterator(rows.end())}};
    PageSection section{"storeys", "Storeys", {}};
    section.blocks.push_back(std::move(table));
    if (input.run != nullptr) section.blocks.push_back(PageCode{runText(input.run->sum)});
    return section;
}

PageSection storeySection(const BuildingPageInput& input, std::size_t storey) {
    const Storey& own = input.building.document.storeys[storey];
    const Coverage& coverage = input.coverage.storeys[storey];
    const RunCoverage* const run =
        input.run == nullptr || input.run->storeys[storey].members.empty()
            ? nullptr
            : &input.run->storeys[storey];
    MapOptions options;
    options.redundancy_scale = redundancyScale(input.coverage);
    options.run = run;
    PageSection section{"storey" + std::to_string(storey + 1), "Storey " + own.id, {}};
    section.blocks.push_back(PageFigure{
        run == nullptr ? "Floor by the number of sensors that see it; coordinates in metres."
                       : "Ways of robots and people by the number of sensors that saw them.",
        coverageMap(*input.coverage.floors[storey], coverage, options)});
    section.blocks.push_back(PageCode{coverageText(coverage.report)});
    if (run != nullptr) section.blocks.push_back(PageCode{runText(*run)});
    return section;
}

}  // namespace

ReportPage buildingPage(const BuildingPageInput& input) {
    ReportPage page;
    page.title =
        input.name + (input.name.empty() ? "" : ": ") + (input.run == nullptr ? "coverage" : "run");
    page.subtitle = std::to_string(input.coverage.storeys.size()) + " storeys · " +
                    squareMetres(input.coverage.indoor_area);
    page.sections.push_back(buildingSummary(input));
    page.sections.push_back(storeysSection(input));
    for (const PageSection& section : input.more) page.sections.push_back(section);
    for (std::size_t i = 0; i < input.coverage.storeys.size(); ++i)
        page.sections.push_back(storeySection(input, i));
    if (input.advice != nullptr) page.sections.push_back(adviceSection(*input.advice));
    if (input.advice != nullptr && !input.advice->suggestions.empty())
        page.sections.push_back(adviceCommands(*input.advice));
    PageSection records{"records", "Appendix: records and command", {}};
    records.blocks.push_back(
        PageText{"Digest of the building: " + input.building.document.digest(), Tone::Small});
    records.blocks.push_back(PageText{"The command of this report:", Tone::Small});
    records.blocks.push_back(PageCode{input.command});
    page.sections.push_back(std::move(records));
    return page;
}

}  // namespace ispace
