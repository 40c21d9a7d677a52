// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "coverage/far_holes.h"
#include "coverage/metrics.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "geom/curve_clip.h"
#include "raster/morphology.h"
#include "scene/sensor/ultrasound.h"

namespace ispace {

Layer markLayer(SharedCurves curves, std::uint64_t marks) {
    return {.curves = std::move(curves), .counts = false, .marks = marks};
}

namespace {

std::vector<double> redundancyOf(const std::vector<std::uint32_t>& times, const CellSet& indoor,
                                 std::size_t sets) {
    std::vector<std::size_t> counts(sets + 1);
    indoor.forEach([&](std::size_t cell) { ++counts[times[cell]]; });
    std::vector<double> shares(counts.size());
    if (const std::size_t all = indoor.count(); all > 0)
        for (std::size_t k = 0; k < counts.size(); ++k)
            shares[k] = static_cast<double>(counts[k]) / static_cast<double>(all);
    return shares;
}

std::size_t countSeenOnce(const CellSet& cells, const std::vector<std::uint32_t>& times) {
    std::size_t count = 0;
    cells.forEach([&](std::size_t cell) { count += times[cell] == 1 ? 1 : 0; });
    return count;
}

/// Counts the cells lost if one receiver is removed: those heard by just enough receivers,
/// including it, and not seen by another set.
std::size_t countNeeding(const Coverage& coverage, const CellSet& heard_by_this,
                         const std::vector<std::uint16_t>& heard,
                         const std::vector<std::uint32_t>& times) {
    const CellSet& joint = coverage.sets.back().cells;
    std::size_t count = 0;
    heard_by_this.forEach([&](std::size_t cell) {
        count += joint.test(cell) && heard[cell] == kMinReceivers && times[cell] == 1 ? 1 : 0;
    });
    return count;
}

std::vector<std::uint16_t> timesHeard(const Coverage& coverage) {
    std::vector<std::uint16_t> heard(coverage.target.grid.size());
    for (const SensorView& view : coverage.sensors)
        if (view.isPartial()) view.cells.forEach([&heard](std::size_t cell) { ++heard[cell]; });
    return heard;
}

void addSensorMetrics(Coverage& coverage, const std::vector<std::uint32_t>& times) {
    const double cell_area = coverage.target.grid.cellArea();
    const std::vector<std::uint16_t> heard = timesHeard(coverage);
    tbb::parallel_for(std::size_t{0}, coverage.sensors.size(), [&](std::size_t i) {
        const SensorView& view = coverage.sensors[i];
        SensorMetrics& metrics = coverage.report.sensors[i];
        const std::size_t seen = view.cells.count();
        metrics.area.grid = static_cast<double>(seen) * cell_area;
        const bool is_receiver = view.isPartial();
        const std::size_t alone = is_receiver ? countNeeding(coverage, view.cells, heard, times)
                                              : countSeenOnce(view.cells, times);
        metrics.marginal.grid = static_cast<double>(alone) * cell_area;
        if (!is_receiver) metrics.overlap.grid = static_cast<double>(seen - alone) * cell_area;
    });
}

/// Adds the unseen pieces of free floor, the largest first.
void addUnseen(Coverage& coverage, const CellSet& covered) {
    const Grid& grid = coverage.target.grid;
    CellSet cells = coverage.target.free;
    cells -= covered;
    const MapCells unseen(cells, grid.columns, grid.rows);
    const CellPieces pieces(unseen, CellPieces::Joined::BySides);
    const std::vector<CellIndex> places = deepestPlaces(unseen, pieces);
    auto& list = coverage.report.unseen;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        list.push_back({grid.center(grid.cell(places[i].x, places[i].y)),
                        static_cast<double>(pieces[i].cells) * grid.cellArea()});
    std::stable_sort(list.begin(), list.end(),
                     [](const auto& a, const auto& b) { return a.area > b.area; });
}

void addPieces(Coverage& coverage, const CellSet& covered) {
    const Grid& grid = coverage.target.grid;
    CellSet inside = covered;
    inside &= coverage.target.indoor;
    const CellPieces pieces(MapCells(inside, grid.columns, grid.rows), CellPieces::Joined::BySides);
    coverage.report.pieces = pieces.size();
    std::size_t largest = 0;
    for (const CellPiece& piece : pieces.list()) largest = std::max(largest, piece.cells);
    if (largest > 0)
        coverage.report.largest_piece =
            static_cast<double>(largest) / static_cast<double>(inside.count());
    addUnseen(coverage, covered);
}

}  // namespace

void addZoneLayers(std::span<const Zone> zones, std::vector<Layer>& layers) {
    for (std::size_t i = 0; i < zones.size(); ++i) {
        Polygon outline = zones[i].outline;
        if (signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
        layers.push_back(
            markLayer({curveOf(outline)}, std::uint64_t{1} << (kFirstZoneBit + i % kZonesAtOnce)));
    }
}

std::vector<Zone> zonesOf(const Environment& environment) {
    std::vector<Zone> zones;
    for (const Element& element : environment.elements())
        if (element.record.keyword() == "zone")
            zones.push_back({element.id, zoneOutline(element.record)});
    // The step of an overlay's lattice grows with the extent of its layers.
    for (Zone& zone : zones) {
        const std::vector<Curve> outline = {curveOf(zone.outline)};
        const std::vector<Curve> part = cutAlong(outline, environment.limits()).inside;
        if (!part.empty()) zone.outline = chords(part.front());
    }
    return zones;
}

double shareOf(double part, double whole) {
    return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0;
}

void addCellMetrics(Coverage& coverage, const std::vector<Zone>& zones) {
    const Target& target = coverage.target;
    const double cell_area = target.grid.cellArea();
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    CellSet covered(times.size());
    for (std::size_t cell = 0; cell < times.size(); ++cell)
        if (times[cell] > 0) covered.set(cell);
    CoverageReport& report = coverage.report;
    addSensorMetrics(coverage, times);
    report.total_effective_area.grid = static_cast<double>(covered.count()) * cell_area;
    const auto repeated =
        std::count_if(times.begin(), times.end(), [](std::uint32_t k) { return k > 1; });
    report.overlap.grid = static_cast<double>(repeated) * cell_area;
    report.coverage.grid = coveredShare(covered, target.indoor);
    report.free_coverage.grid = coveredShare(covered, target.free);
    report.redundancy = redundancyOf(times, target.indoor, coverage.sets.size());
    for (std::size_t i = 0; i < zones.size(); ++i) {
        CellSet zone = cellsWithin(target.grid, std::span(&zones[i].outline, 1));
        zone &= target.indoor;
        report.zones[i].coverage.grid = coveredShare(covered, zone);
    }
    if (!coverage.overlay) addPieces(coverage, covered);
}

namespace {

/// Returns the layers of all sets, the indoor region, the free floor and some zones.
std::vector<Layer> layersOf(const Coverage& coverage, FloorCurves floor,
                            std::span<const Zone> zones) {
    std::vector<Layer> layers;
    layers.reserve(coverage.sets.size() + 2 + zones.size());
    for (std::size_t i = 0; i < coverage.sets.size(); ++i)
        layers.push_back(
            {.curves = *coverage.sets[i].region, .number = static_cast<std::int64_t>(i) + 1});
    layers.push_back(markLayer(std::move(floor.indoor), kIndoorMark));
    layers.push_back(markLayer(std::move(floor.free), kFreeMark));
    addZoneLayers(zones, layers);
    return layers;
}

/// Reduces the count to 0 or 1 and keeps the floor marks.
LayerLabel withoutDepths(const LayerLabel& label) {
    return {.count = std::min(label.count, 1), .marks = label.marks & (kIndoorMark | kFreeMark)};
}

/// Areas of an overlay's faces, by count and set.
struct Areas {
    double covered = 0, repeated = 0, free_covered = 0;
    std::vector<double> indoor_by_count;  // [k], k > 0
    std::vector<double> alone;            // [set]

    explicit Areas(std::size_t sets) : indoor_by_count(sets + 1), alone(sets) {}
    void add(const LayerLabel& label, double area) {
        if (label.count == 0) return;
        covered += area;
        if (label.count > 1)
            repeated += area;
        else
            alone[static_cast<std::size_t>(label.numbers - 1)] += area;
        if ((label.marks & kIndoorMark) != 0)
            indoor_by_count[static_cast<std::size_t>(label.count)] += area;
        if ((label.marks & kFreeMark) != 0) free_covered += area;
    }
};

/// Covered indoor area of some zones.
struct ZoneAreas {
    std::vector<double> covered;  // [zone]

    void add(const LayerLabel& label, double area) {
        if (label.count > 0)
            forEachIndoorZone(label, [&](std::size_t zone) { covered[zone] += area; });
    }
    void setShares(std::span<ZoneMetrics> metrics) const {
        for (std::size_t i = 0; i < metrics.size(); ++i)
            metrics[i].coverage.exact = shareOf(covered[i], metrics[i].area);
    }
};

/// Connected regions of faces with a label that satisfies `in`, with their areas.
struct Pieces {
    std::vector<Region> regions;
    std::vector<double> areas;

    template <typename In>
    Pieces(const Overlay& overlay, In in)
        : regions(overlay.regions(in)), areas(overlay.areasOf(regions)) {}
};

void addPieces(CoverageReport& report, const Overlay& overlay, const FarHoles& holes) {
    std::optional<Pieces> covered, unseen;
    tbb::parallel_invoke(
        [&] {
            covered.emplace(overlay, [](const LayerLabel& label) {
                return label.count > 0 && (label.marks & kIndoorMark) != 0;
            });
        },
        [&] {
            unseen.emplace(overlay, [](const LayerLabel& label) {
                return label.count == 0 && (label.marks & kFreeMark) != 0;
            });
            holes.cutOut(unseen->regions, unseen->areas);
        });
    double sum = 0, largest = 0;
    for (const double area : covered->areas) {
        if (area < kMinPiece) continue;
        ++report.pieces;
        sum += area;
        largest = std::max(largest, area);
    }
    report.largest_piece = shareOf(largest, sum);
    std::vector<UncoveredSpot> spots(unseen->regions.size());
    tbb::parallel_for(std::size_t{0}, spots.size(), [&](std::size_t i) {
        if (unseen->areas[i] >= kMinPiece)
            spots[i] = {interiorPoint(unseen->regions[i]), unseen->areas[i]};
    });
    for (const UncoveredSpot& spot : spots)
        if (spot.area >= kMinPiece) report.unseen.push_back(spot);
    std::stable_sort(
        report.unseen.begin(), report.unseen.end(),
        [](const UncoveredSpot& a, const UncoveredSpot& b) { return a.area > b.area; });
}

/// Sets the metrics of sensors with a covered set each: not of receivers.
void addSensors(Coverage& coverage, const Areas& areas) {
    std::size_t set = 0;
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        const SensorView& view = coverage.sensors[i];
        if (view.isPartial()) continue;
        SensorMetrics& metrics = coverage.report.sensors[i];
        const double area = *metrics.area.exact;
        const double alone = std::clamp(areas.alone[set++], 0.0, area);
        metrics.marginal.exact = alone;
        metrics.overlap.exact = area - alone;
    }
}

/// Computes the area lost without each receiver: heard by just enough receivers including it, and
/// not seen by another set. Skipped if there are more receivers than marks.
void addReceivers(Coverage& coverage) {
    constexpr std::size_t kMax = 62;
    std::vector<const SensorView*> receivers;
    std::vector<SensorMetrics*> metrics;
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        if (!coverage.sensors[i].isPartial()) continue;
        receivers.push_back(&coverage.sensors[i]);
        metrics.push_back(&coverage.report.sensors[i]);
    }
    if (receivers.empty() || receivers.size() > kMax) return;
    std::vector<Layer> layers;
    layers.reserve(coverage.sets.size() + receivers.size());
    for (std::size_t i = 0; i < coverage.sets.size(); ++i)
        layers.push_back(
            {.curves = *coverage.sets[i].region, .number = static_cast<std::int64_t>(i)});
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        std::vector<const SensorView*> others = receivers;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        auto heard = regionHeardByEnough(others);
        if (!heard) return;
        layers.push_back(markLayer(std::move(*heard), std::uint64_t{1} << i));
    }
    const auto joint = static_cast<std::int64_t>(coverage.sets.size()) - 1;
    const Overlay overlay(layers);
    for (std::size_t i = 0; i < receivers.size(); ++i)
        metrics[i]->marginal.exact = std::max(0.0, overlay.area([&](const LayerLabel& label) {
            return label.count == 1 && label.numbers == joint && ((label.marks >> i) & 1U) == 0;
        }));
}

}  // namespace

std::vector<ZoneMetrics> zoneMetricsOf(const Environment& environment,
                                       const std::vector<Zone>& zones) {
    std::vector<ZoneMetrics> metrics;
    metrics.reserve(zones.size());
    for (const Zone& zone : zones) metrics.push_back({.id = zone.id});
    for (std::size_t first = 0; first < zones.size(); first += kZonesAtOnce) {
        const std::size_t count = std::min(kZonesAtOnce, zones.size() - first);
        std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoorMark)};
        addZoneLayers(std::span(zones).subspan(first, count), layers);
        forEachArea(layers, [&](const LayerLabel& label, double area) {
            forEachIndoorZone(label, [&](std::size_t zone) { metrics[first + zone].area += area; });
        });
    }
    for (ZoneMetrics& zone : metrics)
        if (zone.area < kMinPiece) zone.area = 0;
    return metrics;
}

FloorCurves floorCurvesOf(const Environment& environment, const std::vector<Region>& free_floor) {
    FloorCurves floor{curvesWithArcs(environment.indoor()), {}};
    for (const Region& piece : free_floor)
        for (Curve& curve : curvesWithArcs(piece)) floor.free.push_back(std::move(curve));
    return floor;
}

namespace {

/// Sets the shares of the floor by the areas of all faces.
void setShares(const Areas& areas, CoverageReport& report) {
    report.total_effective_area.exact = std::max(0.0, areas.covered);
    report.overlap.exact = std::max(0.0, areas.repeated);
    double indoor_covered = 0;
    for (const double area : areas.indoor_by_count) indoor_covered += area;
    report.coverage.exact = shareOf(indoor_covered, report.indoor_area);
    report.free_coverage.exact = shareOf(areas.free_covered, report.free_area);
    report.redundancy_exact.emplace();
    report.redundancy_exact->push_back(
        shareOf(report.indoor_area - indoor_covered, report.indoor_area));
    for (std::size_t k = 1; k < areas.indoor_by_count.size(); ++k)
        report.redundancy_exact->push_back(shareOf(areas.indoor_by_count[k], report.indoor_area));
}

}  // namespace

void addExactShares(Coverage& coverage, const Environment& environment, FarHoles& holes,
                    const std::vector<Zone>& zones, bool keep_depths, std::size_t most_crossings) {
    Areas areas(coverage.sets.size());
    const auto level = environment.level(coverage.target.height);
    const FloorCurves floor{curvesWithArcs(environment.indoor()),
                            holes.curvesWithout(coverage.sets)};
    for (std::size_t first = 0; first == 0 || first < zones.size(); first += kZonesAtOnce) {
        const std::size_t count = std::min(kZonesAtOnce, zones.size() - first);
        const std::vector<Layer> layers =
            layersOf(coverage, floor, std::span(zones).subspan(first, count));
        ZoneAreas by_zone{std::vector<double>(count)};
        const auto add = [&](const LayerLabel& label, double area) {
            if (first == 0) areas.add(label, area);
            by_zone.add(label, area);
        };
        if (first > 0)
            forEachArea(layers, add, most_crossings);
        else if (keep_depths)
            Overlay(layers, level->slice().sheets,
                    {.label = {}, .add_area = {}, .most_crossings = most_crossings})
                .addAreas(add);
        else
            Overlay(layers, level->slice().sheets,
                    Overlay::Coarse{
                        .label = withoutDepths, .add_area = add, .most_crossings = most_crossings});
        by_zone.setShares(std::span(coverage.report.zones).subspan(first, count));
    }
    setShares(areas, coverage.report);
}

void addExactMetrics(Coverage& coverage, const Environment& environment, FarHoles& holes,
                     const std::vector<Zone>& zones, bool keep_depths, std::size_t most_crossings) {
    CoverageReport& report = coverage.report;
    Areas areas(coverage.sets.size());
    const auto level = environment.level(coverage.target.height);
    const std::vector<Segment2>& sheets = level->slice().sheets;
    FloorCurves floor{curvesWithArcs(environment.indoor()), holes.curvesWithout(coverage.sets)};
    std::optional<Overlay> main;  // holds the first zones
    for (std::size_t first = 0; first == 0 || first < zones.size(); first += kZonesAtOnce) {
        const std::size_t count = std::min(kZonesAtOnce, zones.size() - first);
        const bool is_last = first + kZonesAtOnce >= zones.size();
        FloorCurves own = std::exchange(floor, is_last ? FloorCurves() : FloorCurves(floor));
        const std::vector<Layer> layers =
            layersOf(coverage, std::move(own), std::span(zones).subspan(first, count));
        ZoneAreas by_zone{std::vector<double>(count)};
        const auto add = [&](const LayerLabel& label, double area) {
            if (first == 0) areas.add(label, area);
            by_zone.add(label, area);
        };
        if (first > 0) {
            forEachArea(layers, add, most_crossings);
        } else if (keep_depths) {
            main.emplace(
                layers, sheets,
                Overlay::Coarse{.label = {}, .add_area = {}, .most_crossings = most_crossings});
            main->addAreas(add);
        } else {
            main.emplace(
                layers, sheets,
                Overlay::Coarse{
                    .label = withoutDepths, .add_area = add, .most_crossings = most_crossings});
        }
        by_zone.setShares(std::span(report.zones).subspan(first, count));
    }
    addReceivers(coverage);
    coverage.overlay = std::move(main);  // does not throw from here on

    setShares(areas, report);
    addSensors(coverage, areas);
    addPieces(report, *coverage.overlay, holes);
}

}  // namespace ispace
