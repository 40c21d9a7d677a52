// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/contour.h"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "geom/spatial_index.h"

namespace ispace {

namespace {

/// The edges between cells of the set and others, directed with the set on the left, kept as one
/// bit per direction (east, north, west, south) at the lattice point where each starts.
class EdgeLattice {
  public:
    EdgeLattice(const Grid& grid, const CellSet& cells)
        : grid_(grid), across_(grid.columns + 1), starts_(lattice(grid.columns, grid.rows) + 1) {
        const auto has = [&](int column, int row) {
            return column >= 0 && row >= 0 && column < grid.columns && row < grid.rows &&
                   cells.test(grid.cell(column, row));
        };
        cells.forEach([&](std::size_t cell) {
            const auto columns = static_cast<std::size_t>(grid.columns);
            const int column = static_cast<int>(cell % columns);
            const int row = static_cast<int>(cell / columns);
            if (!has(column, row - 1)) start(column, row, 0);
            if (!has(column + 1, row)) start(column + 1, row, 1);
            if (!has(column, row + 1)) start(column + 1, row + 1, 2);
            if (!has(column - 1, row)) start(column, row + 1, 3);
        });
    }

    std::vector<Polygon> trace() {
        std::vector<Polygon> curves;
        for (int row = 0; row <= grid_.rows; ++row)
            for (int column = 0; column <= grid_.columns; ++column)
                while (starts_[lattice(column, row)] != 0) curves.push_back(follow(column, row));
        return curves;
    }

  private:
    [[nodiscard]] std::size_t lattice(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
               static_cast<std::size_t>(column);
    }
    void start(int column, int row, unsigned direction) {
        starts_[lattice(column, row)] |= static_cast<std::uint8_t>(1U << direction);
    }
    [[nodiscard]] Point2 place(int column, int row) const {
        const Box2& limits = grid_.limits;
        return {limits.low.x + limits.width() * (static_cast<double>(column) / grid_.columns),
                limits.low.y + limits.depth() * (static_cast<double>(row) / grid_.rows)};
    }

    [[nodiscard]] bool starts(int column, int row, unsigned direction) const {
        return (starts_[lattice(column, row)] >> direction & 1U) != 0;
    }
    void take(int column, int row, unsigned direction) {
        starts_[lattice(column, row)] &= static_cast<std::uint8_t>(~(1U << direction));
    }

    /// Takes one closed curve out of the lattice; its first edge goes last, to be met again.
    Polygon follow(const int first_column, const int first_row) {
        constexpr std::array<int, 4> kEast = {1, 0, -1, 0}, kNorth = {0, 1, 0, -1};
        int column = first_column, row = first_row;
        const auto first_direction =
            static_cast<unsigned>(std::countr_zero(starts_[lattice(column, row)]));
        unsigned direction = first_direction;
        Polygon curve;
        while (true) {
            column += kEast[direction];
            row += kNorth[direction];
            // Left first: where two cells touch at a corner, stay with this one.
            unsigned next = (direction + 1) % 4;
            if (!starts(column, row, next)) next = direction;
            if (!starts(column, row, next)) next = (direction + 3) % 4;
            if (next != direction) curve.push_back(place(column, row));
            direction = next;
            const bool closed =
                column == first_column && row == first_row && direction == first_direction;
            take(column, row, direction);
            if (closed) return curve;
        }
    }

    const Grid& grid_;
    int across_;
    std::vector<std::uint8_t> starts_;
};

}  // namespace

std::vector<Polygon> contours(const Grid& grid, const CellSet& cells) {
    return EdgeLattice(grid, cells).trace();
}

std::vector<Region> cellRegions(const Grid& grid, const CellSet& cells) {
    std::vector<Region> pieces;
    std::vector<Polygon> holes;
    std::vector<Box2> boxes;
    for (Polygon& curve : contours(grid, cells)) {
        if (signedArea(curve) < 0) {
            holes.push_back(std::move(curve));
            continue;
        }
        boxes.push_back(bounds(curve));
        pieces.push_back({std::move(curve), {}});
    }
    const BoxTree tree(boxes);
    for (Polygon& hole : holes) {
        // Of the outlines about the cell on the left of its first edge the innermost.
        const Vec2 way = hole[1] - hole[0], ahead = 1 / length(way) * way;
        const Vec2 left = perpendicular(ahead);
        const Point2 cell = hole[0] + Vec2{(ahead.x + left.x) * grid.limits.width() / grid.columns,
                                           (ahead.y + left.y) * grid.limits.depth() / grid.rows};
        const Point2 middle = hole[0] + 0.5 * (cell - hole[0]);
        std::optional<std::size_t> owner;
        tree.search({middle, middle}, [&](std::size_t i) {
            const bool is_within = !owner || boxes[i].width() < boxes[*owner].width();
            if (is_within && locate(pieces[i].outline, middle) == Side::Inside) owner = i;
        });
        if (owner) pieces[*owner].holes.push_back(std::move(hole));
    }
    return pieces;
}

}  // namespace ispace
