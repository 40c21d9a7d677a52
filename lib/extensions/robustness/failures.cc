// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/failures.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "coverage/metrics.h"
#include "env/level.h"
#include "extensions/robustness/figure_samples.h"
#include "scene/sensor/ultrasound.h"

namespace ispace::robustness {

namespace {

/// Floor that the failure of some sensors may uncover, by the sensors that see it.
struct SharedFloor {
    std::vector<std::size_t> whole, partial;  ///< indices of views, ascending
    std::vector<double> areas;                ///< of parts of the floor, see partOf()
};

/// Parts of the floor: indoor, free, and the zones.
constexpr std::size_t kIndoorPart = 0, kFreePart = 1, kFirstZonePart = 2;

std::size_t partOf(const Requirement& figure, const CoverageReport& report) {
    switch (figure.of) {
        case Requirement::Of::Free:
            return kFreePart;
        case Requirement::Of::Zone:
            return kFirstZonePart + zoneIndex(figure, report);
        case Requirement::Of::Indoor:
            break;
    }
    return kIndoorPart;
}

/// Returns the number of failures that uncover floor; empty if it is not covered at all.
std::optional<std::size_t> failuresToLose(std::size_t whole, std::size_t partial) {
    if (whole == 0 && partial < kMinReceivers) return std::nullopt;
    return whole + (partial < kMinReceivers ? 0 : partial - kMinReceivers + 1);
}

/// Collects floor by the sensors that see it.
class SharedFloors {
  public:
    SharedFloors(const Coverage& coverage, std::size_t most)
        : coverage_(coverage), most_(most), parts_(kFirstZonePart + coverage.report.zones.size()) {}

    void add(const std::vector<std::size_t>& views, std::size_t part, double area) {
        areas_.try_emplace(views, std::vector<double>(parts_)).first->second[part] += area;
    }
    /// Returns true if floor with these sensors can be uncovered by `most` failures.
    [[nodiscard]] bool matters(std::size_t whole, std::size_t partial) const {
        const auto needed = failuresToLose(whole, partial);
        return needed && *needed <= most_;
    }
    [[nodiscard]] bool matters(const std::vector<std::size_t>& views) const {
        const auto partial = static_cast<std::size_t>(
            std::count_if(views.begin(), views.end(),
                          [&](std::size_t view) { return coverage_.sensors[view].isPartial(); }));
        return matters(views.size() - partial, partial);
    }
    [[nodiscard]] std::vector<SharedFloor> take() const {
        std::vector<SharedFloor> floors;
        for (const auto& [views, areas] : areas_) {
            SharedFloor floor{{}, {}, areas};
            for (const std::size_t view : views)
                (coverage_.sensors[view].isPartial() ? floor.partial : floor.whole).push_back(view);
            floors.push_back(std::move(floor));
        }
        return floors;
    }

  private:
    const Coverage& coverage_;
    std::size_t most_, parts_;
    std::map<std::vector<std::size_t>, std::vector<double>> areas_;
};

/// The floor of each view: all that it sees, or with the pixels of a class.
struct FloorOfViews {
    std::vector<const CellSet*> cells;  ///< null: none
    std::vector<const SharedCurves*> regions;
    bool is_exact = true;
};

FloorOfViews floorOfViews(const Coverage& coverage, const std::optional<std::size_t>& density) {
    FloorOfViews floor;
    for (const SensorView& view : coverage.sensors) {
        const bool is_seen = !density || *density < view.classes.size();
        const auto& region = density && is_seen ? view.classes[*density].region : view.region;
        floor.cells.push_back(!is_seen  ? nullptr
                              : density ? &view.classes[*density].cells
                                        : &view.cells);
        floor.regions.push_back(is_seen && region ? &*region : nullptr);
        floor.is_exact &= !is_seen || region.has_value();
    }
    return floor;
}

constexpr std::size_t kMaxExactViews = 62;  // bits of LayerLabel::numbers

std::vector<SharedFloor> exactFloors(const Environment& environment, const Coverage& coverage,
                                     const FloorOfViews& seen, std::size_t most) {
    SharedFloors floors(coverage, most);
    const auto level = environment.level(coverage.target.height);
    const FloorCurves floor = floorCurvesOf(environment, level->freeFloor());
    const std::vector<Zone> zones = zonesOf(environment);
    for (std::size_t first = 0; first == 0 || first < zones.size(); first += kZonesAtOnce) {
        std::vector<Layer> layers = {markLayer(floor.indoor, kIndoorMark),
                                     markLayer(floor.free, kFreeMark)};
        for (std::size_t i = 0; i < seen.regions.size(); ++i)
            if (seen.regions[i] != nullptr)
                layers.push_back({.curves = *seen.regions[i], .number = std::int64_t{1} << i});
        const std::size_t count = std::min(kZonesAtOnce, zones.size() - first);
        addZoneLayers(std::span(zones).subspan(first, count), layers);
        forEachArea(layers, [&](const LayerLabel& label, double area) {
            if (label.count == 0) return;
            std::vector<std::size_t> views;
            for (auto bits = static_cast<std::uint64_t>(label.numbers); bits != 0; bits &= bits - 1)
                views.push_back(static_cast<std::size_t>(std::countr_zero(bits)));
            if (!floors.matters(views)) return;
            if (first == 0 && (label.marks & kIndoorMark) != 0)
                floors.add(views, kIndoorPart, area);
            if (first == 0 && (label.marks & kFreeMark) != 0) floors.add(views, kFreePart, area);
            forEachIndoorZone(label, [&](std::size_t zone) {
                floors.add(views, kFirstZonePart + first + zone, area);
            });
        });
    }
    return floors.take();
}

std::vector<SharedFloor> floorsOfCells(const Environment& environment, const Coverage& coverage,
                                       const FloorOfViews& seen, std::size_t most) {
    SharedFloors floors(coverage, most);
    const Grid& grid = coverage.target.grid;
    std::vector<std::uint16_t> whole(grid.size()), partial(grid.size());
    for (std::size_t i = 0; i < seen.cells.size(); ++i)
        if (seen.cells[i] != nullptr) {
            std::vector<std::uint16_t>& counts = coverage.sensors[i].isPartial() ? partial : whole;
            seen.cells[i]->forEach([&counts](std::size_t cell) { ++counts[cell]; });
        }
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  // cell, view
    for (std::size_t i = 0; i < seen.cells.size(); ++i)
        if (seen.cells[i] != nullptr)
            seen.cells[i]->forEach([&](std::size_t cell) {
                if (coverage.target.indoor.test(cell) && floors.matters(whole[cell], partial[cell]))
                    pairs.emplace_back(cell, i);
            });
    std::sort(pairs.begin(), pairs.end());
    std::vector<CellSet> zones;
    for (const Zone& zone : zonesOf(environment))
        zones.push_back(cellsWithin(grid, std::span(&zone.outline, 1)));
    for (std::size_t k = 0; k < pairs.size();) {
        const std::size_t cell = pairs[k].first;
        std::vector<std::size_t> views;
        for (; k < pairs.size() && pairs[k].first == cell; ++k) views.push_back(pairs[k].second);
        floors.add(views, kIndoorPart, grid.cellArea());
        if (coverage.target.free.test(cell)) floors.add(views, kFreePart, grid.cellArea());
        for (std::size_t i = 0; i < zones.size(); ++i)
            if (zones[i].test(cell)) floors.add(views, kFirstZonePart + i, grid.cellArea());
    }
    return floors.take();
}

bool isLost(const SharedFloor& floor, const std::vector<bool>& fails) {
    for (const std::size_t view : floor.whole)
        if (!fails[view]) return false;
    std::size_t left = 0;
    for (const std::size_t view : floor.partial) left += fails[view] ? 0 : 1;
    return left < kMinReceivers;
}

/// The set of failures that uncovers most of a part of the floor.
struct WorstSet {
    double lost = -1;
    std::vector<std::size_t> views;
};

/// Searches all sets of `count` views, in lexical order. \returns one for each part
std::vector<WorstSet> worstSets(const std::vector<SharedFloor>& floors, std::size_t views,
                                std::size_t count, std::size_t parts) {
    std::vector<WorstSet> worst(parts);
    std::vector<std::size_t> chosen(count);
    std::vector<bool> fails(views);
    const auto judge = [&] {
        std::vector<double> lost(parts);
        for (const SharedFloor& floor : floors)
            if (isLost(floor, fails))
                for (std::size_t part = 0; part < parts; ++part) lost[part] += floor.areas[part];
        for (std::size_t part = 0; part < parts; ++part)
            // Sums in another order differ by rounding: the first set of equals stays.
            if (lost[part] > worst[part].lost + 1e-9) worst[part] = {lost[part], chosen};
    };
    const auto choose = [&](auto& self, std::size_t depth, std::size_t from) -> void {
        if (depth == count) return judge();
        for (std::size_t view = from; view + (count - depth) <= views; ++view) {
            chosen[depth] = view;
            fails[view] = true;
            self(self, depth + 1, view + 1);
            fails[view] = false;
        }
    };
    choose(choose, 0, 0);
    return worst;
}

void mustBeFew(std::size_t views, std::size_t count, std::size_t floors) {
    constexpr double kMaxWork = 2e9;
    double sets = 1;
    for (std::size_t k = 0; k < count; ++k)
        sets *= static_cast<double>(views - k) / static_cast<double>(k + 1);
    if (sets * static_cast<double>(floors + 1) > kMaxWork)
        throw UsageError("too many sets of " + std::to_string(count) + " of " +
                         std::to_string(views) + " sensors: take fewer failures");
}

/// The rooms of a site: their views by number, and where their zones begin among all.
struct RoomViews {
    std::vector<std::string> ids;                   ///< of all views
    std::vector<std::vector<std::size_t>> numbers;  ///< of the views of each room
    std::vector<std::size_t> first_zones;           ///< one more than rooms
};

RoomViews viewsOf(std::span<const FailingRoom> rooms) {
    RoomViews views;
    views.first_zones.push_back(0);
    std::map<std::string, std::size_t> known;
    for (const FailingRoom& room : rooms) {
        std::vector<std::size_t> numbers;
        for (const SensorView& view : room.coverage.sensors) {
            const auto [at, is_new] = known.try_emplace(view.id, views.ids.size());
            if (is_new) views.ids.push_back(view.id);
            numbers.push_back(at->second);
        }
        views.numbers.push_back(std::move(numbers));
        views.first_zones.push_back(views.first_zones.back() + room.coverage.report.zones.size());
    }
    return views;
}

/// Renames views and parts of a room's floor to those of all rooms, and appends it.
void addFloors(std::vector<SharedFloor> floors, const RoomViews& views, std::size_t room,
               std::vector<SharedFloor>& all) {
    for (SharedFloor& floor : floors) {
        for (auto* const list : {&floor.whole, &floor.partial})
            for (std::size_t& view : *list) view = views.numbers[room][view];
        std::vector<double> areas(kFirstZonePart + views.first_zones.back());
        for (std::size_t part = 0; part < floor.areas.size(); ++part)
            areas[part < kFirstZonePart ? part : part + views.first_zones[room]] =
                floor.areas[part];
        floor.areas = std::move(areas);
        all.push_back(std::move(floor));
    }
}

/// Returns the area of the cells of a figure's floor.
double areaByCells(std::span<const FailingRoom> rooms, const RoomViews& views,
                   const Requirement& figure, const CoverageReport& planned) {
    if (figure.of == Requirement::Of::Zone) {
        const std::size_t number = zoneIndex(figure, planned);
        std::size_t room = 0;
        while (views.first_zones[room + 1] <= number) ++room;
        const Target& target = rooms[room].coverage.target;
        const Zone zone = zonesOf(rooms[room].scene.environment)[number - views.first_zones[room]];
        const CellSet cells = cellsWithin(target.grid, std::span(&zone.outline, 1));
        return static_cast<double>(countCommon(cells, target.indoor)) * target.grid.cellArea();
    }
    double area = 0;
    for (const FailingRoom& room : rooms) {
        const Target& target = room.coverage.target;
        const CellSet& cells = figure.of == Requirement::Of::Free ? target.free : target.indoor;
        area += static_cast<double>(cells.count()) * target.grid.cellArea();
    }
    return area;
}

/// Returns the areas by exact regions, or nothing if an overlay is not known.
std::optional<std::vector<SharedFloor>> tryExactFloors(const Environment& environment,
                                                       const Coverage& coverage,
                                                       const FloorOfViews& seen, std::size_t most) {
    if (!seen.is_exact || seen.regions.size() > kMaxExactViews) return std::nullopt;
    try {
        return exactFloors(environment, coverage, seen, most);
    } catch (const FormatError&) {
        return std::nullopt;  // too many crossings
    }
}

/// Returns the floors of all rooms by exact regions; nothing if those of a room are not known.
std::optional<std::vector<SharedFloor>> tryExactFloors(std::span<const FailingRoom> rooms,
                                                       const RoomViews& views,
                                                       const std::optional<std::size_t>& density,
                                                       std::size_t most) {
    std::vector<SharedFloor> floors;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        const auto& [scene, coverage] = rooms[i];
        auto of_room =
            tryExactFloors(scene.environment, coverage, floorOfViews(coverage, density), most);
        if (!of_room) return std::nullopt;
        addFloors(*std::move(of_room), views, i, floors);
    }
    return floors;
}

std::vector<SharedFloor> floorsOfCells(std::span<const FailingRoom> rooms, const RoomViews& views,
                                       const std::optional<std::size_t>& density,
                                       std::size_t most) {
    std::vector<SharedFloor> floors;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        const auto& [scene, coverage] = rooms[i];
        addFloors(floorsOfCells(scene.environment, coverage, floorOfViews(coverage, density), most),
                  views, i, floors);
    }
    return floors;
}

}  // namespace

std::vector<FigureLoss> worstFailures(const Scene& scene, const Coverage& coverage, int count,
                                      std::span<const Requirement> requirements) {
    const FailingRoom room{scene, coverage};
    return worstFailures({&room, 1}, coverage.report, count, requirements);
}

std::vector<FigureLoss> worstFailures(std::span<const FailingRoom> rooms,
                                      const CoverageReport& planned, int count,
                                      std::span<const Requirement> requirements) {
    const RoomViews views = viewsOf(rooms);
    const std::size_t failing = std::min(static_cast<std::size_t>(count), views.ids.size());
    std::map<std::optional<std::size_t>, std::pair<std::vector<WorstSet>, bool>> by_density;
    std::vector<FigureLoss> losses;
    for (const Requirement& figure : figuresOf(planned, requirements)) {
        RequiredFigure known = figureOf(figure, planned);
        auto found = by_density.find(figure.density);
        if (found == by_density.end()) {
            auto floors = tryExactFloors(rooms, views, figure.density, failing);
            const bool is_exact = floors.has_value();
            if (!floors) floors = floorsOfCells(rooms, views, figure.density, failing);
            mustBeFew(views.ids.size(), failing, floors->size());
            found = by_density
                        .emplace(figure.density,
                                 std::pair(worstSets(*floors, views.ids.size(), failing,
                                                     kFirstZonePart + planned.zones.size()),
                                           is_exact))
                        .first;
        }
        const auto& [worst, exact_areas] = found->second;
        const bool is_exact = exact_areas && known.share.exact;
        const std::optional<double> share = is_exact ? known.share.exact : known.share.grid;
        if (!share) continue;
        const WorstSet& set = worst[partOf(figure, planned)];
        const double area = is_exact ? known.area : areaByCells(rooms, views, figure, planned);
        FigureLoss loss{figure, std::move(known.name), *share, is_exact,
                        std::clamp(*share - shareOf(set.lost, area), 0.0, *share)};
        for (const std::size_t view : set.views) loss.sensors.push_back(views.ids[view]);
        losses.push_back(std::move(loss));
    }
    return losses;
}

}  // namespace ispace::robustness
