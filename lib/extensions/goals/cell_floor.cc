// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/cell_floor.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "env/level.h"
#include "env/zone.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace::goals {

namespace {

/// A move by columns and rows.
struct Move {
    int right = 0, up = 0;
};
/// Each half of eight: four moves and then the way back of each.
constexpr Move kMoves[] = {{1, 0}, {1, 1}, {0, 1},  {-1, 1}, {-1, 0},  {-1, -1}, {0, -1}, {1, -1},
                           {2, 1}, {1, 2}, {-1, 2}, {-2, 1}, {-2, -1}, {-1, -2}, {1, -2}, {2, -1}};
constexpr std::size_t backOf(std::size_t move) { return move ^ 4U; }

/// Returns the cells under a move, each of which holds an equal part of it: those of a knight's
/// move are the two ends and the two cells between them.
std::vector<Move> cellsUnder(Move move) {
    if (std::abs(move.right) == 2)
        return {{0, 0}, {move.right / 2, 0}, {move.right / 2, move.up}, move};
    if (std::abs(move.up) == 2) return {{0, 0}, {0, move.up / 2}, {move.right, move.up / 2}, move};
    return {{0, 0}, move};
}

CellStep stepOf(const Grid& grid, Move move) {
    const double width = grid.limits.width() / grid.columns;
    const double depth = grid.limits.depth() / grid.rows;
    const double length = std::hypot(move.right * width, move.up * depth);
    const std::vector<Move> under = cellsUnder(move);
    CellStep step{move.up * grid.columns + move.right, 0, {}};
    const auto part = static_cast<std::uint32_t>(
        std::lround(length / static_cast<double>(under.size()) / kPathUnit));
    for (const Move& cell : under)
        step.pieces.push_back(
            {static_cast<std::uint32_t>(cell.up * grid.columns + cell.right), part});
    step.length = part * static_cast<std::uint32_t>(under.size());
    return step;
}

/// The lines that no way crosses.
class Barriers {
  public:
    Barriers(const Environment& environment, double height)
        : lines_(linesOf(*environment.level(height))), grid_(lines_, 0) {}

    [[nodiscard]] bool cross(const Segment2& way) const {
        const Box2 box = bounds(way);
        bool crosses = false;
        grid_.searchAlong(way, [&](std::span<const std::uint32_t> lines) {
            for (std::size_t i = 0; i < lines.size() && !crosses; ++i) {
                const Segment2& line = lines_[lines[i]];
                crosses = box.meets(bounds(line)) && intersects(line, way);
            }
        });
        return crosses;
    }

  private:
    static std::vector<Segment2> linesOf(const Level& level) {
        std::vector<Segment2> lines = level.slice().sheets;
        for (const Region& region : level.freeFloor())
            region.forEachEdge([&lines](const Segment2& edge) { lines.push_back(edge); });
        return lines;
    }

    std::vector<Segment2> lines_;
    SegmentGrid grid_;
};

/// Moves cells of a room to where they begin among all.
CellSet movedTo(std::size_t first, std::size_t all, const CellSet& cells) {
    CellSet moved(all);
    cells.forEach([&](std::size_t cell) { moved.set(first + cell); });
    return moved;
}

}  // namespace

CellSet freeCellsOf(const Environment& environment, const Target& target, const std::string& zone,
                    std::size_t first, std::size_t all) {
    const Polygon outline = readZone(zone, environment).outline;
    CellSet cells = cellsWithin(target.grid, {&outline, 1});
    cells &= target.free;
    if (cells.empty())
        throw UsageError("zone " + printable(zone) +
                         " has no free cell: no way begins or ends there (--cell M makes them "
                         "smaller)");
    return movedTo(first, all, cells);
}

CellSet landingCellsOf(const Environment& environment, const Target& target, const Box2& landing,
                       std::size_t first, std::size_t all) {
    const Grid& grid = target.grid;
    const Point2 middle = landing.center();
    const double far =
        2 * std::hypot(grid.limits.width() / grid.columns, grid.limits.depth() / grid.rows);
    const Barriers barriers(environment, target.height);
    CellSet cells(all);
    double least = far;
    std::optional<std::size_t> nearest;
    target.free.forEach([&](std::size_t cell) {
        const Point2 center = grid.center(cell);
        if (landing.contains(center)) cells.set(first + cell);
        const double apart = distance(center, middle);
        if (!(apart < least) || barriers.cross({middle, center})) return;
        least = apart;
        nearest = cell;
    });
    if (cells.empty() && nearest) cells.set(first + *nearest);
    return cells;
}

std::size_t addFloor(const Environment& environment, const Target& target, CellPaths& ways) {
    const Grid& grid = target.grid;
    const std::size_t first = ways.open.size();
    CellFloor& floor = ways.floors.emplace_back();
    floor.first = static_cast<std::uint32_t>(first);
    for (const Move& move : kMoves) floor.steps.push_back(stepOf(grid, move));
    ways.open.resize(first + grid.size());
    const Barriers barriers(environment, target.height);
    const auto is_free = [&](int column, int row) {
        return column >= 0 && row >= 0 && column < grid.columns && row < grid.rows &&
               target.free.test(grid.cell(column, row));
    };
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            if (!is_free(column, row)) continue;
            const std::size_t cell = grid.cell(column, row);
            for (std::size_t k = 0; k < std::size(kMoves); ++k) {
                if (backOf(k) < k) continue;  // steps back are as open as steps there
                const Move& move = kMoves[k];
                bool is_open = true;
                for (const Move& under : cellsUnder(move))
                    is_open = is_open && is_free(column + under.right, row + under.up);
                if (!is_open) continue;
                const std::size_t next = grid.cell(column + move.right, row + move.up);
                if (barriers.cross({grid.center(cell), grid.center(next)})) continue;
                ways.open[first + cell] |= std::uint32_t{1} << k;
                ways.open[first + next] |= std::uint32_t{1} << backOf(k);
            }
        }
    return first;
}

}  // namespace ispace::goals
