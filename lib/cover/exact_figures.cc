// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <optional>

#include "cover/figures.h"
#include "cover/sensor_views.h"
#include "geom/boolean.h"

namespace ispace {

namespace {

/// Zones take the bits from here on; of more than fit, the others are measured in further passes.
constexpr std::size_t kFirstZoneBit = 2, kZonesAtOnce = 62;

std::uint64_t zoneMark(std::size_t zone) {
    return std::uint64_t{1} << (kFirstZoneBit + zone % kZonesAtOnce);
}

Layer markLayer(std::vector<Curve> curves, std::uint64_t marks) {
    return {.curves = std::move(curves), .counts = false, .marks = marks};
}

void addZoneLayers(std::span<const Zone> zones, std::vector<Layer>& layers) {
    for (std::size_t i = 0; i < zones.size(); ++i) {
        Polygon outline = zones[i].outline;
        if (signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
        layers.push_back(markLayer({curveOf(outline)}, zoneMark(i)));
    }
}

/// Calls add(zone, label, area) for each zone that holds a face of the indoor region.
template <typename Add>
void addIndoorAreas(const Overlay& overlay, Add add) {
    overlay.addAreas([&](const LayerLabel& label, double area) {
        if ((label.marks & kIndoorMark) == 0) return;
        for (std::uint64_t bits = label.marks >> kFirstZoneBit; bits != 0; bits &= bits - 1)
            add(static_cast<std::size_t>(std::countr_zero(bits)), label, area);
    });
}

/// All sets over indoor region, free floor and some zones.
Overlay overlayOf(const Coverage& coverage, const Environment& environment,
                  const std::vector<Region>& free_floor, std::span<const Zone> zones) {
    std::vector<Layer> layers;
    layers.reserve(coverage.sets.size() + 2 + zones.size());
    for (std::size_t i = 0; i < coverage.sets.size(); ++i)
        layers.push_back(
            {.curves = *coverage.sets[i].region, .number = static_cast<std::int64_t>(i) + 1});
    layers.push_back(markLayer(curvesWithArcs(environment.indoor()), kIndoorMark));
    std::vector<Curve> free;
    for (const Region& piece : free_floor)
        for (Curve& curve : curvesWithArcs(piece)) free.push_back(std::move(curve));
    layers.push_back(markLayer(std::move(free), kFreeMark));
    addZoneLayers(zones, layers);
    return Overlay(layers, environment.slice(coverage.target.height).sheets);
}

/// Areas of an overlay, by what they count for.
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

void addZones(std::span<ZoneFigures> figures, const Overlay& overlay) {
    std::vector<double> covered(figures.size());
    addIndoorAreas(overlay, [&](std::size_t zone, const LayerLabel& label, double area) {
        if (label.count > 0) covered[zone] += area;
    });
    for (std::size_t i = 0; i < figures.size(); ++i)
        figures[i].coverage.exact = shareOf(covered[i], figures[i].area);
}

void addPieces(CoverageReport& report, const Overlay& overlay) {
    const std::vector<Region> covered = overlay.regions([](const LayerLabel& label) {
        return label.count > 0 && (label.marks & kIndoorMark) != 0;
    });
    double sum = 0, largest = 0;
    for (const double area : overlay.areasOf(covered)) {
        if (area < kLeastPiece) continue;
        ++report.pieces;
        sum += area;
        largest = std::max(largest, area);
    }
    report.largest_piece = shareOf(largest, sum);
    const std::vector<Region> unseen = overlay.regions(
        [](const LayerLabel& label) { return label.count == 0 && (label.marks & kFreeMark) != 0; });
    const std::vector<double> areas = overlay.areasOf(unseen);
    for (std::size_t i = 0; i < unseen.size(); ++i)
        if (areas[i] >= kLeastPiece) report.unseen.push_back({interiorPoint(unseen[i]), areas[i]});
    std::stable_sort(report.unseen.begin(), report.unseen.end(),
                     [](const UnseenSpot& a, const UnseenSpot& b) { return a.area > b.area; });
}

/// Of the sensors whose views are sets of their own: not of receivers.
void addSensors(Coverage& coverage, const Areas& areas) {
    std::size_t set = 0;
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        const SensorView& view = coverage.sensors[i];
        if (view.isPartial()) continue;
        SensorFigures& figures = coverage.report.sensors[i];
        const double area = *figures.area.exact;
        const double alone = std::clamp(areas.alone[set++], 0.0, area);
        figures.marginal.exact = alone;
        figures.overlap.exact = area - alone;
    }
}

/// What is lost without one receiver: what enough of them hear with it alone, and nothing else
/// sees. Left out for more receivers than there are marks.
void addReceivers(Coverage& coverage) {
    constexpr std::size_t kMost = 62;
    std::vector<const SensorView*> receivers;
    std::vector<SensorFigures*> figures;
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        if (!coverage.sensors[i].isPartial()) continue;
        receivers.push_back(&coverage.sensors[i]);
        figures.push_back(&coverage.report.sensors[i]);
    }
    if (receivers.empty() || receivers.size() > kMost) return;
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
        figures[i]->marginal.exact = std::max(0.0, overlay.area([&](const LayerLabel& label) {
            return label.count == 1 && label.numbers == joint && ((label.marks >> i) & 1U) == 0;
        }));
}

}  // namespace

std::vector<ZoneFigures> zoneFiguresOf(const Environment& environment,
                                       const std::vector<Zone>& zones) {
    std::vector<ZoneFigures> figures;
    figures.reserve(zones.size());
    for (const Zone& zone : zones) figures.push_back({.id = zone.id});
    for (std::size_t first = 0; first < zones.size(); first += kZonesAtOnce) {
        const std::size_t count = std::min(kZonesAtOnce, zones.size() - first);
        std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoorMark)};
        addZoneLayers(std::span(zones).subspan(first, count), layers);
        addIndoorAreas(Overlay(layers), [&](std::size_t zone, const LayerLabel&, double area) {
            figures[first + zone].area += area;
        });
    }
    for (ZoneFigures& zone : figures)
        if (zone.area < kLeastPiece) zone.area = 0;
    return figures;
}

void addExactFigures(Coverage& coverage, const Environment& environment,
                     const std::vector<Region>& free_floor, const std::vector<Zone>& zones) {
    CoverageReport& report = coverage.report;
    std::optional<Overlay> main;  // with the first zones
    for (std::size_t first = 0; first == 0 || first < zones.size(); first += kZonesAtOnce) {
        const std::size_t count = std::min(kZonesAtOnce, zones.size() - first);
        Overlay overlay =
            overlayOf(coverage, environment, free_floor, std::span(zones).subspan(first, count));
        addZones(std::span(report.zones).subspan(first, count), overlay);
        if (first == 0) main = std::move(overlay);
    }
    addReceivers(coverage);
    coverage.overlay = std::move(main);  // from here on nothing throws

    Areas areas(coverage.sets.size());
    coverage.overlay->addAreas(
        [&areas](const LayerLabel& label, double area) { areas.add(label, area); });
    report.total_effective_area.exact = std::max(0.0, areas.covered);
    report.overlap.exact = std::max(0.0, areas.repeated);
    double indoor_covered = 0;
    for (const double area : areas.indoor_by_count) indoor_covered += area;
    report.coverage.exact = shareOf(indoor_covered, report.indoor_area);
    report.free_coverage.exact = shareOf(areas.free_covered, report.free_area);
    areas.indoor_by_count[0] = report.indoor_area - indoor_covered;
    report.redundancy_exact.emplace();
    for (const double area : areas.indoor_by_count)
        report.redundancy_exact->push_back(shareOf(area, report.indoor_area));
    addSensors(coverage, areas);
    addPieces(report, *coverage.overlay);
}

}  // namespace ispace
