// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_gaps.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "raster/cell_distance.h"
#include "raster/cell_pieces.h"
#include "raster/cell_raster.h"

namespace ispace {

namespace {

constexpr std::array<CellPlace, 4> kSides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

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
    // Middles of cells are whole numbers in the frame, places in cells are not.
    const CellFrame frame{{0, 0}, 1, width, height};
    std::vector<CellPair> pairs;
    for (const Segment2& line : lines) appendCrossings(line, frame, pairs);
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
    pieces.forEachRun([&](const CellRun& run, std::size_t piece) {
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

}  // namespace ispace
