// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/indoor_floor.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "coverage/metrics.h"
#include "geom/curve.h"

namespace ispace::pages {

namespace {

IndoorFloor floorByCells(const Coverage& coverage, const SensorView& view,
                         const std::vector<std::uint32_t>& times) {
    CellSet cells = view.cells;
    cells &= coverage.target.indoor;
    std::size_t alone = 0;
    cells.forEach([&](std::size_t cell) { alone += times[cell] == 1 ? 1 : 0; });
    const double size = coverage.target.grid.cellArea();
    return {static_cast<double>(cells.count()) * size, static_cast<double>(alone) * size};
}

/// Returns the exact area of the indoor part of a region; empty if an overlay has too many
/// crossings.
std::optional<double> indoorPart(const Environment& environment, const std::vector<Curve>& region) {
    constexpr std::uint64_t kRegionMark = 2;
    double area = 0;
    try {
        const std::vector<Layer> layers = {
            markLayer(curvesWithArcs(environment.indoor()), kIndoorMark),
            markLayer(region, kRegionMark)};
        forEachArea(layers, [&area](const LayerLabel& label, double part) {
            if (label.marks == (kIndoorMark | kRegionMark)) area += part;
        });
    } catch (const FormatError&) {
        return std::nullopt;
    }
    return std::max(0.0, area);
}

}  // namespace

std::vector<IndoorFloor> indoorFloors(const Scene& scene, const Coverage& coverage) {
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    std::vector<double> alone(coverage.sets.size());
    if (coverage.overlay)
        coverage.overlay->addAreas([&alone](const LayerLabel& label, double area) {
            const auto set = static_cast<std::size_t>(label.numbers - 1);
            if ((label.marks & kIndoorMark) != 0 && label.count == 1 && set < alone.size())
                alone[set] += area;
        });
    std::vector<IndoorFloor> floors;
    std::size_t set = 0;  // receivers form one, behind those of all other sensors
    for (const SensorView& view : coverage.sensors) {
        IndoorFloor floor = floorByCells(coverage, view, times);
        if (!view.isPartial()) {
            const double own = alone[set++];
            if (coverage.overlay && view.region)
                if (const auto seen = indoorPart(scene.environment, *view.region))
                    floor = {*seen, std::min(*seen, std::max(0.0, own))};
        }
        floors.push_back(floor);
    }
    return floors;
}

}  // namespace ispace::pages
