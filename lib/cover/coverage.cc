// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/coverage.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "base/number.h"
#include "cover/metrics.h"
#include "geom/boolean.h"
#include "sense/scan.h"

namespace ispace {

namespace {

SensorMetrics metricsOf(const Scene& scene, const SensorView& view) {
    SensorMetrics metrics{.id = view.id, .model = view.model, .kind = view.kind};
    if (const auto* laser = std::get_if<Laser>(&scene.sensors[view.index].model))
        metrics.slice_area = sliceArea(*laser, view.beams);
    if (view.region) metrics.area.exact = std::max(0.0, signedArea(*view.region));
    return metrics;
}

/// Cells are a bit a sensor, twice: of its view, and of the set it is.
void mustFit(const Scene& scene, const Grid& grid) {
    constexpr double kMostBytes = 8e9;
    const auto sensors =
        std::count_if(scene.sensors.begin(), scene.sensors.end(),
                      [](const Sensor& sensor) { return kindOf(sensor.model).perceives; });
    const double bytes = static_cast<double>(sensors) * static_cast<double>(grid.size()) / 4;
    if (bytes > kMostBytes)
        throw UsageError("cells of all sensors take " + formatFixed(bytes / 1e9, 1) +
                         " GB: use fewer cells");
}

/// Exact metrics, or the reason why there are none.
void tryExactMetrics(Coverage& coverage, const Environment& environment,
                     const std::vector<Region>& free_floor, const std::vector<Zone>& zones) {
    std::string& missing = coverage.report.exact_missing;
    for (const SensorView& view : coverage.sensors)
        if (!view.region) {
            missing = "what " + view.id + " sees is known by cells only";
            return;
        }
    for (const SeenSet& set : coverage.sets)
        if (!set.region) {
            missing = "what enough receivers hear is known by cells only";
            return;
        }
    try {
        addExactMetrics(coverage, environment, free_floor, zones);
    } catch (const FormatError& error) {
        missing = error.diagnostics().front().message;
    }
}

/// Layers of both, told apart by their numbers.
constexpr std::int64_t kThisNumber = 1, kOtherNumber = std::int64_t{1} << 32;

void addLayers(const Coverage& coverage, std::int64_t number, std::vector<Layer>& layers) {
    for (const SeenSet& set : coverage.sets)
        layers.push_back({.curves = *set.region, .number = number});
}

void compareExactly(const Coverage& coverage, const Coverage& other, const Regions& indoor,
                    Comparison& comparison) {
    std::vector<Layer> layers;
    layers.reserve(coverage.sets.size() + other.sets.size() + 1);
    addLayers(coverage, kThisNumber, layers);
    addLayers(other, kOtherNumber, layers);
    layers.push_back({.curves = curvesWithArcs(indoor), .counts = false, .marks = kIndoorMark});
    double gained = 0, lost = 0;
    try {
        Overlay(layers).addAreas([&](const LayerLabel& label, double area) {
            if (label.count == 0 || (label.marks & kIndoorMark) == 0) return;
            if (label.numbers < kOtherNumber) gained += area;
            if (label.numbers % kOtherNumber == 0) lost += area;
        });
    } catch (const FormatError&) {
        return;  // each for itself could be laid out, but not both together
    }
    comparison.gained.exact = std::max(0.0, gained);
    comparison.lost.exact = std::max(0.0, lost);
}

}  // namespace

Coverage measureCoverage(const Scene& scene, Worlds& worlds, const CoverageOptions& options) {
    const Environment& environment = scene.environment;
    Coverage coverage;
    coverage.target = makeTarget(environment, options.cells, options.height);
    const Grid& grid = coverage.target.grid;
    mustFit(scene, grid);
    coverage.sensors = viewsOf(scene, worlds, grid, options);
    coverage.sets = setsOf(coverage.sensors, grid);

    CoverageReport& report = coverage.report;
    report.digest = scene.digest;
    report.limits = environment.limits();
    report.grid = grid;
    report.height = options.height;
    report.plane = options.plane;
    report.indoor_area = environment.indoor().area();
    const std::vector<Region> free_floor = environment.freeFloor(options.height);
    report.free_area = totalArea(free_floor);
    report.sensors.reserve(coverage.sensors.size());
    for (const SensorView& view : coverage.sensors)
        report.sensors.push_back(metricsOf(scene, view));
    const std::vector<Zone> zones = zonesOf(environment);
    report.zones = zoneMetricsOf(environment, zones);
    if (options.exact) tryExactMetrics(coverage, environment, free_floor, zones);
    addCellMetrics(coverage, zones);
    return coverage;
}

void compare(Coverage& coverage, const Coverage& other, const Regions& indoor,
             const std::string& name) {
    assert(coverage.target.grid == other.target.grid);
    Comparison comparison{.name = name, .coverage = other.report.coverage};
    const double cell_area = coverage.target.grid.cellArea();
    const CellSet& inside = coverage.target.indoor;
    const auto area_without = [&](CellSet cells, const CellSet& without) {
        cells -= without;
        return static_cast<double>(countCommon(cells, inside)) * cell_area;
    };
    const CellSet mine = coveredCells(coverage), theirs = coveredCells(other);
    comparison.gained.grid = area_without(mine, theirs);
    comparison.lost.grid = area_without(theirs, mine);
    if (coverage.overlay && other.overlay) compareExactly(coverage, other, indoor, comparison);
    coverage.report.comparison = comparison;
}

std::vector<std::uint32_t> timesSeen(const Coverage& coverage) {
    std::vector<std::uint32_t> times(coverage.target.grid.size());
    for (const SeenSet& set : coverage.sets)
        set.cells.forEach([&times](std::size_t cell) { ++times[cell]; });
    return times;
}

CellSet coveredCells(const Coverage& coverage) {
    CellSet covered(coverage.target.grid.size());
    for (const SeenSet& set : coverage.sets) covered |= set.cells;
    return covered;
}

std::optional<double> coveredShare(const CellSet& covered, const CellSet& target) {
    const std::size_t all = target.count();
    if (all == 0) return std::nullopt;
    return static_cast<double>(countCommon(covered, target)) / static_cast<double>(all);
}

}  // namespace ispace
