// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_cleaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "raster/cell_pieces.h"
#include "raster/cell_smoothing.h"
#include "raster/cell_strips.h"

namespace ispace {

namespace {

constexpr double kWidestSpeck = 0.3;  ///< metres
constexpr double kCoarse = 0.15;      ///< metres a cell from which on one is no noise
constexpr std::size_t kLargestPinhole = 8;

/// Sides between a cell of the set and one that is not.
std::size_t countEdges(const MapCells& cells) {
    const auto n = static_cast<std::size_t>(cells.width());
    std::vector<std::uint8_t> below(n);
    std::size_t edges = 0;
    const auto count_between = [&](std::span<const std::uint8_t> row) {
        for (std::size_t i = 0; i < n; ++i) edges += row[i] ^ below[i];
    };
    for (int y = 0; y < cells.height(); ++y) {
        const std::span<const std::uint8_t> row = cells.row(y);
        count_between(row);
        forEachRunOf(row, [&edges](int, int) { edges += 2; });
        std::copy(row.begin(), row.end(), below.begin());
    }
    count_between(std::vector<std::uint8_t>(n));
    return edges;
}

/// An island of other cells in the floor.
struct Island {
    std::size_t piece = 0, cells = 0;
    bool is_occupied = false;
};

/// Islands that are small enough to be noise at all.
std::vector<Island> smallIslands(const RoomCells& room, const CellPieces& others,
                                 double resolution) {
    std::vector<bool> is_occupied(others.size());
    others.forEachRun([&](const CellRun& run, std::size_t piece) {
        const auto row = room.occupied.row(run.row);
        if (std::find(row.begin() + run.first, row.begin() + run.last + 1, 1) !=
            row.begin() + run.last + 1)
            is_occupied[piece] = true;
    });
    std::vector<Island> islands;
    for (std::size_t i = 0; i < others.size(); ++i)
        if (others[i].border == 0 && others[i].extent() * resolution < kWidestSpeck * 1.001)
            islands.push_back({i, others[i].cells, is_occupied[i]});
    return islands;
}

/// The most cells that chance joins to one speck, where single cells of noise are as frequent as
/// in this room: the expected number of larger ones is below a half.
std::size_t largestSpeckByChance(const std::vector<Island>& islands, std::size_t floor_cells) {
    // Shapes of n cells joined by sides or corners (fixed polyplets).
    constexpr std::array<double, 9> kShapes{0, 1, 4, 20, 110, 638, 3832, 23592, 147941};
    std::size_t noise = 0;
    for (const Island& island : islands)
        if (island.cells <= 2) noise += island.cells;
    const double share = static_cast<double>(noise) / static_cast<double>(floor_cells);
    std::size_t largest = 2;
    while (largest + 1 < kShapes.size() &&
           kShapes[largest + 1] * std::pow(share, static_cast<double>(largest + 1)) *
                   static_cast<double>(floor_cells) >=
               0.5)
        ++largest;
    return largest;
}

void fillSpecks(RoomCells& room, double resolution, Cleaning& done) {
    const CellPieces others(complement(room.floor), CellPieces::Joined::ByCorners);
    const std::vector<Island> islands = smallIslands(room, others, resolution);
    if (islands.empty()) return;
    const std::size_t largest = largestSpeckByChance(islands, room.floor.count());
    std::vector<bool> is_speck(others.size());
    for (const Island& island : islands) {
        if (island.cells > (island.is_occupied ? largest : std::max(largest, kLargestPinhole)))
            continue;
        is_speck[island.piece] = true;
        ++done.specks;
        done.speck_cells += island.cells;
    }
    others.forEachRun([&](const CellRun& run, std::size_t piece) {
        if (!is_speck[piece]) return;
        room.floor.insertRun(run.row, run.first, run.last);
    });
}

}  // namespace

Cleaning& Cleaning::operator+=(const Cleaning& other) {
    specks += other.specks;
    speck_cells += other.speck_cells;
    spikes += other.spikes;
    spike_cells += other.spike_cells;
    slit_cells += other.slit_cells;
    edges += other.edges;
    return *this;
}

Cleaning cleanRoom(RoomCells& room, double resolution, const std::vector<CellPlace>& keep) {
    Cleaning done;
    if (resolution >= kCoarse) return done;
    fillSpecks(room, resolution, done);
    removeSpikes(room, resolution, keep, done);
    done.slit_cells = fillSlits(room);
    fillSpecks(room, resolution, done);  // that were in strips, and rests of slits
    flattenWalls(room.floor);
    done.edges = countEdges(room.floor);
    return done;
}

}  // namespace ispace
