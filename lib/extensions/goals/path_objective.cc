// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/path_objective.h"

#include <cstdint>

#include "arrange/arrange.h"
#include "arrange/coverage_model.h"
#include "arrange/search/case_values.h"
#include "arrange/search/worst_case.h"
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "extensions/goals/cell_floor.h"
#include "extensions/goals/cell_paths.h"

namespace ispace::goals {

namespace {

/// Each way between the zones is a case of the search for the worst one.
class PathSearch final : public ObjectiveSearch {
  public:
    PathSearch(const CoverageModel& model, CellPaths paths)
        : model_(model), paths_(std::move(paths)) {
        cases_.problem = &model.problem();
        cases_.ways = &paths_;
        cases_.blocks = {{0, model.problem().cells()}};
        cases_.shortest = paths_.leastSeen([](std::uint32_t) { return true; }).seen;
    }

    [[nodiscard]] std::uint64_t total() const override { return cases_.shortest; }

    [[nodiscard]] SearchResult find(Progress& progress) const override {
        return searchWorstCase(cases_, model_.searchOptions(), progress);
    }

    void report(std::span<const CountedView> views, Arrangement& result) const override {
        std::vector<SensorCells> cells;
        cells.reserve(views.size());
        for (const CountedView& view : views) cells.push_back({&view.cells, view.multiplicity});
        result.value = model_.share(CaseValues(cases_, cells).worst().value);
        result.whole = static_cast<double>(cases_.shortest) * kPathUnit;
    }

  private:
    const CoverageModel& model_;
    CellPaths paths_;
    WorstCaseProblem cases_;
};

}  // namespace

std::unique_ptr<ObjectiveSearch> PathObjective::searchIn(const CoverageModel& model) const {
    const std::string name =
        "between " + printable(between_.from) + " and " + printable(between_.to);
    const std::size_t all = model.problem().cells();
    CellPaths paths;
    paths.from = paths.to = CellSet(all);
    for (std::size_t i = 0; i < model.site().rooms.size(); ++i) {
        if (!model.hasRoom(i)) continue;
        const RoomModel& own = model.room(i);
        const Environment& room = own.scene().environment;
        const std::size_t first = addFloor(room, own.target(), paths);
        const auto add = [&](const StoreyZone& zone, CellSet& cells) {
            if (zone.storey == i) cells |= freeCellsOf(room, own.target(), zone.zone, first, all);
        };
        add(from_, paths.from);
        add(to_, paths.to);
    }
    for (const passages::SitePassage& passage : passages_) {
        CellSet& cells = paths.passages.emplace_back(all);
        for (const auto& [room, floor] : passage.landings)
            if (model.hasRoom(room))
                cells |=
                    landingCellsOf(model.room(room).scene().environment, model.room(room).target(),
                                   floor, model.cellsOfRoom(room).first, all);
    }
    if (!paths.exist())
        throw UnmetError("no way " + name + " leads over free cells (--cell M makes them smaller)");
    auto search = std::make_unique<PathSearch>(model, std::move(paths));
    if (search->total() == 0) throw UnmetError("the zones touch: a way " + name + " is never seen");
    return search;
}

std::string PathObjective::finding(const Arrangement& found) const {
    return "by cells the way from " + printable(between_.from) + " to " + printable(between_.to) +
           " that is seen least is seen for " + formatFixed(*found.value * *found.whole, 2) +
           " m; no layout of these candidates makes it more than " +
           formatFixed(found.candidate_bound * *found.whole, 2) + " m";
}

}  // namespace ispace::goals
