// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/rooms.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "raster/grid.h"
#include "raster/morphology.h"

namespace ispace {

namespace {

constexpr double kMinShare = 1.0 / 16;  ///< of the largest piece
constexpr double kBorderWeight = 1.0 / 8;

}  // namespace

std::optional<std::size_t> likeliestRoom(const CellPieces& pieces, double resolution) {
    std::size_t largest = 0;
    for (const CellPiece& piece : pieces.list()) largest = std::max(largest, piece.cells);
    const double least = std::min(kMinRoomArea / (resolution * resolution),
                                  kMinShare * static_cast<double>(largest));
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
    pieces.forEachRun([&](const RowRun& run, std::size_t piece) {
        const int* row = &clearance[cells.index(0, run.row)];
        widest[piece] =
            std::max(widest[piece], *std::max_element(row + run.first, row + run.last + 1));
    });
    const double least = kMinRoomArea / (resolution * resolution);
    // Half a cell: the floor's edge lies that much before the middles of the cells outside.
    const double radius = kMinRoomWidth / 2 / resolution;
    const std::optional<std::size_t> likeliest = likeliestRoom(pieces, resolution);
    std::vector<std::size_t> rooms;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (i == likeliest ||
            (pieces[i].border == 0 && static_cast<double>(pieces[i].cells) >= least &&
             widest[i] >= radius * radius))
            rooms.push_back(i);
    return rooms;
}

namespace {

enum Owner : std::uint8_t { Nobody, Outside, Rooms };

/// Floods free cells from those that have an owner, widest ways first.
class WideningFlood {
  public:
    /// \param widest squared clearance that cells without an owner have at most
    WideningFlood(const MapCells& free, const std::vector<int>& clearance, int widest,
                  std::vector<Owner>& owners)
        : free_(free),
          clearance_(clearance),
          owners_(owners),
          open_(static_cast<std::size_t>(widest) + 1) {}

    void run() {
        const std::vector<Owner> before = owners_;
        for (int y = 0; y < free_.height(); ++y)
            for (int x = 0; x < free_.width(); ++x)
                if (before[free_.index(x, y)] != Nobody) pushAround({x, y}, kNoDistance);
        // Ways only get narrower. What finds a cell first comes the widest way, so it owns it.
        for (std::size_t width = open_.size(); width-- > 0;)
            for (std::size_t i = 0; i < open_[width].size(); ++i)
                pushAround(open_[width][i], static_cast<int>(width));
    }

  private:
    /// \param width squared clearance of the narrowest cell on the way so far
    void pushAround(CellPlace from, int width) {
        const Owner owner = owners_[free_.index(from.x, from.y)];
        for (const CellPlace side : kSides) {
            const CellPlace to{from.x + side.x, from.y + side.y};
            if (!free_.contains(to.x, to.y)) continue;
            const std::size_t i = free_.index(to.x, to.y);
            if (owners_[i] != Nobody) continue;
            owners_[i] = owner;
            open_[static_cast<std::size_t>(std::min(width, clearance_[i]))].push_back(to);
        }
    }

    const MapCells& free_;
    const std::vector<int>& clearance_;
    std::vector<Owner>& owners_;
    std::vector<std::vector<CellPlace>> open_;  ///< by the squared clearance on the way
};

}  // namespace

MapCells barrierCells(const std::vector<Segment2>& lines, int width, int height) {
    // Middles of cells are whole numbers in the grid, places in cells are not.
    const Grid grid{
        {{0, 0}, {static_cast<double>(width), static_cast<double>(height)}}, width, height};
    std::vector<CellPair> pairs;
    for (const Segment2& line : lines) appendCrossings(line, grid, pairs);
    MapCells cells(width, height);
    for (const CellPair& pair : pairs)
        if (pair.near_column >= 0 && pair.near_row >= 0 && pair.near_column < width &&
            pair.near_row < height)
            cells.insert(static_cast<int>(pair.near_column), static_cast<int>(pair.near_row));
    return cells;
}

MapCells gapCells(const MapCells& free, double width) {
    const std::vector<int> clearance = squaredDistances(free, Beyond::In);
    // Wider than the grid is as wide as it.
    const double half =
        (std::min(width, static_cast<double>(free.width() + free.height())) + 1) / 2;
    MapCells broad(free.width(), free.height());
    for (int y = 0; y < free.height(); ++y)
        for (int x = 0; x < free.width(); ++x)
            if (clearance[free.index(x, y)] > half * half) broad.insert(x, y);
    const CellPieces pieces(broad, CellPieces::Joined::BySides);
    std::vector<Owner> owners(clearance.size(), Nobody);
    pieces.forEachRun([&](const RowRun& run, std::size_t piece) {
        std::fill_n(owners.begin() + static_cast<std::ptrdiff_t>(free.index(run.first, run.row)),
                    run.last - run.first + 1, pieces[piece].border > 0 ? Outside : Rooms);
    });
    WideningFlood(free, clearance, static_cast<int>(half * half), owners).run();
    MapCells cut(free.width(), free.height());
    for (int y = 0; y < free.height(); ++y)
        for (int x = 0; x < free.width(); ++x) {
            if (owners[free.index(x, y)] != Outside) continue;
            for (const CellPlace side : kSides) {
                const CellPlace to{x + side.x, y + side.y};
                if (free.contains(to.x, to.y) && owners[free.index(to.x, to.y)] == Rooms)
                    cut.insert(x, y);
            }
        }
    return cut;
}

namespace {

template <typename Test>
MapCells cellsWhere(const MapCells& like, const std::vector<int>& values, Test test) {
    MapCells cells(like.width(), like.height());
    std::size_t i = 0;
    for (int y = 0; y < like.height(); ++y)
        for (int x = 0; x < like.width(); ++x, ++i)
            if (test(values[i])) cells.insert(x, y);
    return cells;
}

}  // namespace

MapCells reachedByDisc(const MapCells& cells, double radius, const std::vector<CellPlace>& from) {
    // Half a cell: the edge of the cells outside lies that much before their middles.
    const double reach = (radius + 0.5) * (radius + 0.5);
    const MapCells middles = cellsWhere(cells, squaredDistances(cells, Beyond::Out),
                                        [reach](int squared) { return squared >= reach; });
    const CellPieces pieces(middles, CellPieces::Joined::BySides);
    MapCells chosen(cells.width(), cells.height());
    const auto choose = [&](std::size_t piece) {
        pieces.forEachRun([&](const RowRun& run, std::size_t of) {
            if (of != piece) return;
            for (int x = run.first; x <= run.last; ++x) chosen.insert(x, run.row);
        });
    };
    if (from.empty() && pieces.size() > 0) {
        const auto& list = pieces.list();
        choose(static_cast<std::size_t>(
            std::max_element(list.begin(), list.end(),
                             [](const auto& a, const auto& b) { return a.cells < b.cells; }) -
            list.begin()));
    }
    const int steps = static_cast<int>(std::ceil(radius));
    for (const CellPlace place : from) {
        // The nearest middle whose disc covers the place.
        std::optional<std::size_t> nearest;
        double least = reach;
        for (int v = -steps; v <= steps; ++v)
            for (int u = -steps; u <= steps; ++u) {
                const double squared = static_cast<double>(u) * u + static_cast<double>(v) * v;
                if (squared >= least || !middles.contains(place.x + u, place.y + v)) continue;
                least = squared;
                nearest = pieces.at({place.x + u, place.y + v});
            }
        if (nearest) choose(*nearest);
    }
    return cellsWhere(cells, squaredDistances(complement(chosen), Beyond::In),
                      [reach](int squared) { return squared < reach; });
}

}  // namespace ispace
