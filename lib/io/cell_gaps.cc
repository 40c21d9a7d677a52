// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cell_gaps.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <tuple>

#include "io/cell_distance.h"
#include "io/cell_pieces.h"
#include "io/cell_raster.h"

namespace ispace {

namespace {

constexpr std::array<CellPlace, 4> kSides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

enum Owner : std::uint8_t { Nobody, Outside, Rooms };

/// Floods free cells from those that have an owner, widest ways first.
class WideningFlood {
  public:
    WideningFlood(const MapCells& free, const std::vector<int>& clearance,
                  std::vector<Owner>& owners)
        : free_(free), clearance_(clearance), owners_(owners) {}

    void run() {
        for (int y = 0; y < free_.height(); ++y)
            for (int x = 0; x < free_.width(); ++x)
                if (owners_[free_.index(x, y)] != Nobody) pushAround({x, y}, kNoDistance);
        while (!open_.empty()) {
            const Step step = open_.top();
            open_.pop();
            Owner& owner = owners_[free_.index(step.to.x, step.to.y)];
            if (owner != Nobody) continue;
            owner = step.owner;
            pushAround(step.to, step.width);
        }
    }

  private:
    struct Step {
        int width = 0;          ///< squared clearance of the narrowest cell on the way
        std::size_t order = 0;  ///< of equally wide ways the one found first
        CellPlace to;
        Owner owner = Nobody;
        friend bool operator<(const Step& a, const Step& b) {
            return std::tie(a.width, b.order) < std::tie(b.width, a.order);
        }
    };

    void pushAround(CellPlace from, int width) {
        const Owner owner = owners_[free_.index(from.x, from.y)];
        for (const CellPlace side : kSides) {
            const CellPlace to{from.x + side.x, from.y + side.y};
            if (!free_.contains(to.x, to.y)) continue;
            const std::size_t i = free_.index(to.x, to.y);
            if (owners_[i] == Nobody)
                open_.push({std::min(width, clearance_[i]), ++order_, to, owner});
        }
    }

    const MapCells& free_;
    const std::vector<int>& clearance_;
    std::vector<Owner>& owners_;
    std::priority_queue<Step> open_;
    std::size_t order_ = 0;
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
    const double half = (width + 1) / 2;
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
    WideningFlood(free, clearance, owners).run();
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
