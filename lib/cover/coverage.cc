// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/coverage.h"

#include <tbb/parallel_for.h>

#include "base/error.h"
#include "cover/visible.h"
#include "geom/boolean.h"
#include "sense/scan.h"

namespace ispace {

namespace {

std::vector<double> redundancyOf(const std::vector<std::uint32_t>& times, const CellSet& indoor,
                                 std::size_t sensors) {
    std::vector<std::size_t> counts(sensors + 1);
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

void addSensorFigures(Coverage& coverage, const std::vector<PlacedLaser>& lasers,
                      const std::vector<std::uint32_t>& times) {
    const double cell_area = coverage.target.grid.cellArea();
    for (std::size_t i = 0; i < lasers.size(); ++i) {
        SensorFigures figures;
        figures.id = lasers[i].id;
        figures.model = lasers[i].laser.model;
        figures.slice_area = sliceArea(lasers[i].laser, coverage.beams[i]);
        figures.marginal_area =
            static_cast<double>(countSeenOnce(coverage.seen[i], times)) * cell_area;
        coverage.report.sensors.push_back(figures);
    }
}

}  // namespace

Target makeTarget(const Environment& environment, int columns, int rows, double height) {
    if (columns < 1 || rows < 1 || columns > kMostCells / rows)
        throw UsageError("a grid of " + std::to_string(columns) + " x " + std::to_string(rows) +
                         " cells cannot be made, wanted at least 1 each way and at most " +
                         std::to_string(kMostCells) + " in all");
    Target target;
    target.grid = {environment.limits(), columns, rows};
    target.height = height;
    target.indoor = cellsIn(target.grid, environment.indoor());
    target.free = target.indoor;
    target.free -= cellsBlocked(target.grid, environment.slice(height));
    return target;
}

Coverage measureCoverage(const Scene& scene, Worlds& worlds, int columns, int rows, double height) {
    Coverage coverage;
    coverage.target = makeTarget(scene.environment, columns, rows, height);
    const Grid& grid = coverage.target.grid;
    const std::vector<PlacedLaser>& lasers = scene.lasers;
    for (const PlacedLaser& sensor : lasers) worlds.prepare(sensor.pose);
    coverage.seen.resize(lasers.size());
    coverage.beams.resize(lasers.size());
    tbb::parallel_for(std::size_t{0}, lasers.size(), [&](std::size_t i) {
        const RayWorld& world = worlds.at(lasers[i].pose);
        coverage.seen[i] = cellsSeen(grid, world, lasers[i]);
        coverage.beams[i] = castBeams(world, lasers[i]);
    });

    CellSet covered(grid.size());
    for (const CellSet& seen : coverage.seen) covered |= seen;
    const std::vector<std::uint32_t> times = timesSeen(grid, coverage.seen);
    CoverageReport& report = coverage.report;
    report.digest = scene.digest;
    report.limits = grid.limits;
    report.columns = columns;
    report.rows = rows;
    report.height = height;
    report.indoor_area = scene.environment.indoor().area();
    report.free_area = totalArea(scene.environment.freeFloor(height));
    addSensorFigures(coverage, lasers, times);
    report.total_effective_area.grid = static_cast<double>(covered.count()) * grid.cellArea();
    report.coverage.grid = coveredShare(covered, coverage.target.indoor);
    report.free_coverage.grid = coveredShare(covered, coverage.target.free);
    report.redundancy = redundancyOf(times, coverage.target.indoor, lasers.size());
    return coverage;
}

std::vector<std::uint32_t> timesSeen(const Grid& grid, const std::vector<CellSet>& seen) {
    std::vector<std::uint32_t> times(grid.size());
    for (const CellSet& cells : seen) cells.forEach([&times](std::size_t cell) { ++times[cell]; });
    return times;
}

double coveredShare(const CellSet& covered, const CellSet& target) {
    const std::size_t all = target.count();
    if (all == 0) return 0;
    return static_cast<double>(countCommon(covered, target)) / static_cast<double>(all);
}

}  // namespace ispace
