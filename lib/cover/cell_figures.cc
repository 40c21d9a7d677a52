// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "cover/figures.h"
#include "raster/morphology.h"
#include "sense/ultrasound.h"

namespace ispace {

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

/// Cells that are lost if one receiver is removed: those that just enough receivers hear, this one
/// among them, and nothing else sees.
std::size_t countNeeding(const Coverage& coverage, const CellSet& heard_by_this,
                         const std::vector<std::uint16_t>& heard,
                         const std::vector<std::uint32_t>& times) {
    const CellSet& joint = coverage.sets.back().cells;
    std::size_t count = 0;
    heard_by_this.forEach([&](std::size_t cell) {
        count += joint.test(cell) && heard[cell] == kLeastReceivers && times[cell] == 1 ? 1 : 0;
    });
    return count;
}

std::vector<std::uint16_t> timesHeard(const Coverage& coverage) {
    std::vector<std::uint16_t> heard(coverage.target.grid.size());
    for (const SensorView& view : coverage.sensors)
        if (view.isPartial()) view.cells.forEach([&heard](std::size_t cell) { ++heard[cell]; });
    return heard;
}

void addSensorFigures(Coverage& coverage, const std::vector<std::uint32_t>& times) {
    const double cell_area = coverage.target.grid.cellArea();
    const std::vector<std::uint16_t> heard = timesHeard(coverage);
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        const SensorView& view = coverage.sensors[i];
        SensorFigures& figures = coverage.report.sensors[i];
        const std::size_t seen = view.cells.count();
        figures.area.grid = static_cast<double>(seen) * cell_area;
        const bool is_receiver = view.isPartial();
        const std::size_t alone = is_receiver ? countNeeding(coverage, view.cells, heard, times)
                                              : countSeenOnce(view.cells, times);
        figures.marginal.grid = static_cast<double>(alone) * cell_area;
        if (!is_receiver) figures.overlap.grid = static_cast<double>(seen - alone) * cell_area;
    }
}

/// The pieces of free floor that nothing sees, the largest first.
void addUnseen(Coverage& coverage, const CellSet& covered) {
    const Grid& grid = coverage.target.grid;
    CellSet cells = coverage.target.free;
    cells -= covered;
    const MapCells unseen(cells, grid.columns, grid.rows);
    const CellPieces pieces(unseen, CellPieces::Joined::BySides);
    const std::vector<CellPlace> places = deepestPlaces(unseen, pieces);
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

std::vector<Zone> zonesOf(const Environment& environment) {
    std::vector<Zone> zones;
    for (const Element& element : environment.elements())
        if (element.record.keyword() == "zone")
            zones.push_back({element.id, zoneOutline(element.record)});
    return zones;
}

double shareOf(double part, double whole) {
    return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0;
}

void addCellFigures(Coverage& coverage, const std::vector<Zone>& zones) {
    const Target& target = coverage.target;
    const double cell_area = target.grid.cellArea();
    const CellSet covered = coveredCells(coverage);
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    CoverageReport& report = coverage.report;
    addSensorFigures(coverage, times);
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

}  // namespace ispace
