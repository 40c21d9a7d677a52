// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cleaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace ispace {

namespace {

constexpr int kMaxBump = 3;  ///< cells
constexpr int kFlank = 6;    ///< cells

/// Fills slits of unknown between rays: from their tips, as long as a cell has floor on three
/// sides and what else is around it hangs together. So no line that parts floor opens.
class SlitFilling {
  public:
    explicit SlitFilling(MapRoom& room) : room_(room) {}

    /// \return how many cells became floor
    std::size_t run() {
        for (int y = 1; y + 1 < room_.floor.height(); ++y)
            for (int x = 1; x + 1 < room_.floor.width(); ++x) follow({x, y});
        return filled_;
    }

  private:
    static constexpr std::array<CellPlace, 8> kAround{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

    void follow(CellPlace at) {
        while (isTip(at)) {
            room_.floor.insert(at.x, at.y);
            ++filled_;
            // At most one group of cells is left around it: the slit goes on there.
            for (const CellPlace step : kAround) {
                const CellPlace next{at.x + step.x, at.y + step.y};
                if (!isTip(next)) continue;
                at = next;
                break;
            }
        }
    }

    [[nodiscard]] bool isTip(CellPlace at) const {
        if (at.x < 1 || at.y < 1 || at.x + 1 >= room_.floor.width() ||
            at.y + 1 >= room_.floor.height() || room_.floor.contains(at.x, at.y) ||
            room_.occupied.contains(at.x, at.y))
            return false;
        std::array<bool, 8> is_floor{};
        for (std::size_t i = 0; i < 8; ++i)
            is_floor[i] = room_.floor.contains(at.x + kAround[i].x, at.y + kAround[i].y);
        int sides = 0, groups = 0;
        for (std::size_t i = 0; i < 8; ++i) {
            if (i % 2 == 0 && is_floor[i]) ++sides;
            if (!is_floor[i] && is_floor[(i + 7) % 8]) ++groups;
        }
        return sides >= 3 && groups == 1;
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
    void run(CellPlace along, CellPlace across) {
        for (int y = 0; y < floor_.height(); ++y)
            for (int x = 0; x < floor_.width(); ++x) {
                x = firstEdge(x, y, across);
                if (x == floor_.width()) break;
                const bool kind = floor_.contains(x, y);
                if (isKind(x - along.x, y - along.y, kind)) continue;  // no begin of a run
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

    /// From (x, y) on along the row, the first cell that is perhaps not of the kind of the one
    /// across.
    [[nodiscard]] int firstEdge(int x, int y, CellPlace across) const {
        constexpr int kAtOnce = 32;
        const bool in_grid = y + across.y >= 0 && y + across.y < floor_.height();
        if (x == 0 || !in_grid) return x;
        const std::uint8_t* const here = floor_.row(y).data();
        const std::uint8_t* const there = floor_.row(y + across.y).data() + across.x;
        while (x + kAtOnce < floor_.width() && std::memcmp(here + x, there + x, kAtOnce) == 0)
            x += kAtOnce;
        return x;
    }

    void flatten(CellPlace at, CellPlace along, CellPlace across, bool kind) {
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
constexpr double kCoarse = 0.3;         ///< of the width: one such cell is no noise

void flattenWalls(MapCells& floor) {
    Flattener flattener(floor);
    for (const CellPlace along : {CellPlace{1, 0}, CellPlace{0, 1}})
        for (const int side : {1, -1}) flattener.run(along, {side * along.y, side * along.x});
}

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
                   const std::vector<CellPlace>& keep) {
    Cleaning done;
    if (resolution >= kCoarse * width) return done;
    fillSpecks(room, resolution, width, done);
    removeSpikes(room, resolution, width, keep, done);
    done.slit_cells = SlitFilling(room).run();
    fillSpecks(room, resolution, width, done);  // that were in strips, and rests of slits
    flattenWalls(room.floor);
    done.edges = countEdges(room.floor);
    return done;
}

}  // namespace ispace
