// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms, gaps and noise of a map of cells. Clearances are exact squared Euclidean distances
// (raster/distance), in cells.
//
// Gaps close where the floor is narrowest: floor that a disc of the gap's width fits into belongs
// to the outside or to the rooms, and the rest is flooded by the widest way, narrower cells later
// (bottleneck paths: M. Pollack, The maximum capacity through a network, 1960). Squared clearances
// are small whole numbers, so buckets replace a heap: O(cells + width squared).
//
// Noise is judged by chance: where cells of noise have the density p, chance makes a(n) p^n
// clusters of n cells for each cell, a(n) the number of fixed polyplets (OEIS A006770). Clusters of
// which chance makes less than half a one in the room are things; those of up to two cells are
// always noise, those of more than eight never.
#include "io/map/map_rooms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

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
    // By rank; if no piece has one, as with a border all around, by size.
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
    const std::vector<int> clearance = squaredDistances(cells, BorderRule::In);
    std::vector<int> widest(pieces.size());
    pieces.forEachRun([&](const RowRun& run, std::size_t piece) {
        const int* row = &clearance[cells.index(0, run.row)];
        widest[piece] =
            std::max(widest[piece], *std::max_element(row + run.first, row + run.last + 1));
    });
    const double least = kMinRoomArea / (resolution * resolution);
    // Half a cell: the floor's edge lies that much before the centres of the cells outside.
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
        // Widths only fall along a way, so the first visit of a cell comes by the widest way and
        // owns it.
        for (std::size_t width = open_.size(); width-- > 0;)
            for (std::size_t i = 0; i < open_[width].size(); ++i)
                pushAround(open_[width][i], static_cast<int>(width));
    }

  private:
    /// \param width squared clearance of the narrowest cell on the way so far
    void pushAround(CellIndex from, int width) {
        const Owner owner = owners_[free_.index(from.x, from.y)];
        for (const CellIndex side : kSides) {
            const CellIndex to{from.x + side.x, from.y + side.y};
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
    std::vector<std::vector<CellIndex>> open_;  ///< by the squared clearance on the way
};

}  // namespace

MapCells barrierCells(const std::vector<Segment2>& lines, int width, int height) {
    // Cell centres are integers in the grid, points in cells are not.
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
    const std::vector<int> clearance = squaredDistances(free, BorderRule::In);
    // A wider disc than the grid counts as one of the grid's width.
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
            for (const CellIndex side : kSides) {
                const CellIndex to{x + side.x, y + side.y};
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

/// An opening of the set: erosion to the disc's centres, of these the piece nearest to each point,
/// dilation back. Both steps compare exact squared distances of cell centres with one limit.
MapCells reachedByDisc(const MapCells& cells, double radius, const std::vector<CellIndex>& from) {
    // Half a cell: the edge of the cells outside lies that much before their centres.
    const double reach = (radius + 0.5) * (radius + 0.5);
    const MapCells middles = cellsWhere(cells, squaredDistances(cells, BorderRule::Out),
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
    for (const CellIndex place : from) {
        // The nearest centre with a disc that covers the point.
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
    return cellsWhere(cells, squaredDistances(complement(chosen), BorderRule::In),
                      [reach](int squared) { return squared < reach; });
}

namespace {

constexpr int kMaxBump = 3;  ///< cells
constexpr int kFlank = 6;    ///< cells

/// Fills slits of unknown between rays from their tips, while a cell has floor on three sides and
/// its other neighbours are connected. So no line that separates floor is broken.
class SlitFilling {
  public:
    explicit SlitFilling(MapRoom& room) : room_(room) {}

    /// \return the number of cells that became floor
    std::size_t run() {
        for (int y = 1; y + 1 < room_.floor.height(); ++y)
            for (int x = 1; x + 1 < room_.floor.width(); ++x) follow({x, y});
        return filled_;
    }

  private:
    static constexpr std::array<CellIndex, 8> kAround{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

    void follow(CellIndex at) {
        while (isTip(at)) {
            room_.floor.insert(at.x, at.y);
            ++filled_;
            // At most one group of cells remains around it: the slit continues there.
            for (const CellIndex step : kAround) {
                const CellIndex next{at.x + step.x, at.y + step.y};
                if (!isTip(next)) continue;
                at = next;
                break;
            }
        }
    }

    [[nodiscard]] bool isTip(CellIndex at) const {
        if (at.x < 1 || at.y < 1 || at.x + 1 >= room_.floor.width() ||
            at.y + 1 >= room_.floor.height() || room_.floor.contains(at.x, at.y) ||
            room_.occupied.contains(at.x, at.y))
            return false;
        const auto is_floor = [&](std::size_t i) {
            const CellIndex step = kAround[i % kAround.size()];
            return room_.floor.contains(at.x + step.x, at.y + step.y);
        };
        int sides = 0, groups = 0;
        for (std::size_t i = 0; i < kAround.size(); i += 2) sides += is_floor(i) ? 1 : 0;
        if (sides < 3) return false;  // most cells
        for (std::size_t i = 0; i < kAround.size(); ++i)
            groups += is_floor(i) && !is_floor(i + 1) ? 1 : 0;
        return groups == 1;
    }

    MapRoom& room_;
    std::size_t filled_ = 0;
};

/// Flattens walls along one axis: a bump is a run of up to kMaxBump cells of one kind beside a
/// wall's line that is straight for kFlank cells on each side of it. Tops of round pillars have
/// shorter sides.
class Flattener {
  public:
    explicit Flattener(MapCells& floor) : floor_(floor) {}

    /// \param along, across unit steps along the wall, and from the wall to the bump
    void run(CellIndex along, CellIndex across) {
        for (int y = 0; y < floor_.height(); ++y)
            for (int x = 0; x < floor_.width(); ++x) {
                x = firstEdge(x, y, across);
                if (x == floor_.width()) break;
                const bool kind = floor_.contains(x, y);
                if (isKind(x - along.x, y - along.y, kind)) continue;  // not the begin of a run
                if (isKind(x + across.x, y + across.y, kind)) continue;
                if (!isKind(x - across.x, y - across.y, kind)) continue;
                flatten({x, y}, along, across, kind);
            }
    }

  private:
    [[nodiscard]] bool isKind(int x, int y, bool kind) const {
        return floor_.contains(x, y) == kind;
    }
    [[nodiscard]] bool inGrid(int x, int y) const {
        return x >= 0 && y >= 0 && x < floor_.width() && y < floor_.height();
    }

    /// Finds the first cell from (x, y) along the row that may differ in kind from the one across.
    [[nodiscard]] int firstEdge(int x, int y, CellIndex across) const {
        constexpr int kAtOnce = 32;
        const bool in_grid = y + across.y >= 0 && y + across.y < floor_.height();
        if (x == 0 || !in_grid) return x;
        const std::uint8_t* const here = floor_.row(y).data();
        const std::uint8_t* const there = floor_.row(y + across.y).data() + across.x;
        while (x + kAtOnce < floor_.width() && std::memcmp(here + x, there + x, kAtOnce) == 0)
            x += kAtOnce;
        return x;
    }

    void flatten(CellIndex at, CellIndex along, CellIndex across, bool kind) {
        int length = 1;
        while (length <= kMaxBump && isKind(at.x + length * along.x, at.y + length * along.y, kind))
            ++length;
        if (length > kMaxBump) return;
        // The wall behind is straight, the row of the bump and the one before it are empty.
        for (int i = -kFlank; i < length + kFlank; ++i) {
            const int x = at.x + i * along.x;
            const int y = at.y + i * along.y;
            if (!isKind(x - across.x, y - across.y, kind)) return;
            if (isKind(x + across.x, y + across.y, kind)) return;
            if ((i < 0 || i >= length) && isKind(x, y, kind)) return;
        }
        for (int i = 0; i < length; ++i) {
            const int x = at.x + i * along.x;
            const int y = at.y + i * along.y;
            if (!inGrid(x, y)) return;
            if (kind)
                floor_.erase(x, y);
            else
                floor_.insert(x, y);
        }
    }

    MapCells& floor_;
};

constexpr std::size_t kMaxPinhole = 8;  ///< cells
constexpr double kCoarse = 0.3;         ///< share of the width: a cell this large is no noise

void flattenWalls(MapCells& floor) {
    Flattener flattener(floor);
    for (const CellIndex along : {CellIndex{1, 0}, CellIndex{0, 1}})
        for (const int side : {1, -1}) flattener.run(along, {side * along.y, side * along.x});
}

/// Counts sides between a cell of the set and one outside it.
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

/// Finds islands small enough to be noise.
std::vector<Island> smallIslands(const MapRoom& room, const CellPieces& others, double resolution,
                                 double widest) {
    std::vector<bool> is_occupied(others.size());
    others.forEachRun([&](const RowRun& run, std::size_t piece) {
        const auto row = room.occupied.row(run.row);
        if (std::find(row.begin() + run.first, row.begin() + run.last + 1, 1) !=
            row.begin() + run.last + 1)
            is_occupied[piece] = true;
    });
    std::vector<Island> islands;
    for (std::size_t i = 0; i < others.size(); ++i)
        if (others[i].border == 0 && others[i].extent() * resolution < widest * 1.001)
            islands.push_back({i, others[i].cells, is_occupied[i]});
    return islands;
}

/// Returns the largest number of cells that chance joins to one speck, if single cells of noise are
/// as frequent as in this room: the expected number of larger ones is below a half.
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

void fillSpecks(MapRoom& room, double resolution, double widest, Cleaning& done) {
    const CellPieces others(complement(room.floor), CellPieces::Joined::ByCorners);
    const std::vector<Island> islands = smallIslands(room, others, resolution, widest);
    if (islands.empty()) return;
    const std::size_t largest = largestSpeckByChance(islands, room.floor.count());
    std::vector<bool> is_speck(others.size());
    for (const Island& island : islands) {
        if (island.cells > (island.is_occupied ? largest : std::max(largest, kMaxPinhole)))
            continue;
        is_speck[island.piece] = true;
        ++done.specks;
        done.speck_cells += island.cells;
    }
    others.forEachRun([&](const RowRun& run, std::size_t piece) {
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

Cleaning cleanRoom(MapRoom& room, double resolution, double width,
                   const std::vector<CellIndex>& keep) {
    Cleaning done;
    if (resolution >= kCoarse * width) return done;
    fillSpecks(room, resolution, width, done);
    removeSpikes(room, resolution, width, keep, done);
    done.slit_cells = SlitFilling(room).run();
    fillSpecks(room, resolution, width, done);  // specks that were in strips, and rests of slits
    flattenWalls(room.floor);
    done.edges = countEdges(room.floor);
    return done;
}

}  // namespace ispace
