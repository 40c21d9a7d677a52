// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_rooms.h"

#include <algorithm>

#include "raster/cell_distance.h"

namespace ispace {

namespace {

constexpr double kLeastRoom = 1;          ///< m2
constexpr double kLeastRoomWidth = 0.5;   ///< metres
constexpr double kLeastShare = 1.0 / 16;  ///< of the largest piece
constexpr double kBorderWeight = 1.0 / 8;

}  // namespace

std::optional<std::size_t> likeliestRoom(const CellPieces& pieces, double resolution) {
    std::size_t largest = 0;
    for (const CellPiece& piece : pieces.list()) largest = std::max(largest, piece.cells);
    const double least = std::min(kLeastRoom / (resolution * resolution),
                                  kLeastShare * static_cast<double>(largest));
    // By rank; of pieces without any, as a border all around, by size.
    std::optional<std::size_t> best;
    std::pair<double, std::size_t> best_rank;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const auto cells = static_cast<double>(pieces[i].cells);
        if (cells < least) continue;
        const double weight =
            pieces[i].border == 0 ? 1 : std::min(kBorderWeight, 1 - pieces.borderShare(i));
        const std::pair rank{weight * cells, pieces[i].cells};
        if (best && rank <= best_rank) continue;
        best = i;
        best_rank = rank;
    }
    return best;
}

std::vector<std::size_t> closedRooms(const MapCells& cells, const CellPieces& pieces,
                                     double resolution) {
    const std::vector<int> clearance = squaredDistances(cells, Beyond::In);
    std::vector<int> widest(pieces.size());
    pieces.forEachRun([&](const CellRun& run, std::size_t piece) {
        const int* row = &clearance[cells.index(0, run.row)];
        widest[piece] =
            std::max(widest[piece], *std::max_element(row + run.first, row + run.last + 1));
    });
    const double least = kLeastRoom / (resolution * resolution);
    // Half a cell: the floor's edge lies that much before the middles of the cells outside.
    const double radius = kLeastRoomWidth / 2 / resolution;
    const std::optional<std::size_t> likeliest = likeliestRoom(pieces, resolution);
    std::vector<std::size_t> rooms;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (i == likeliest ||
            (pieces[i].border == 0 && static_cast<double>(pieces[i].cells) >= least &&
             widest[i] >= radius * radius))
            rooms.push_back(i);
    return rooms;
}

}  // namespace ispace
