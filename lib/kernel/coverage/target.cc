// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/target.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "env/level.h"

namespace ispace {

namespace {

/// Number of columns or rows of square cells.
double cellsAlong(double extent, double edge) {
    return std::max(1.0, std::ceil(extent / edge - 1e-9));
}

double squareCells(const Box2& limits, double edge) {
    return cellsAlong(limits.width(), edge) * cellsAlong(limits.depth(), edge);
}

/// An edge of two decimal digits: digits * 10^exponent metres.
struct CellEdge {
    int digits = 10, exponent = -2;

    [[nodiscard]] double metres() const {
        const double power = std::pow(10.0, std::abs(exponent));
        return exponent < 0 ? digits / power : digits * power;
    }
    [[nodiscard]] CellEdge longer() const {
        return digits < 99 ? CellEdge{digits + 1, exponent} : CellEdge{10, exponent + 1};
    }
    [[nodiscard]] CellEdge shorter() const {
        return digits > 10 ? CellEdge{digits - 1, exponent} : CellEdge{99, exponent - 1};
    }
};

double roomCell(const Box2& limits, int most) {
    constexpr double kMinCount = 10'000, kMinLength = 1e-4;
    CellEdge edge;
    if (squareCells(limits, edge.metres()) > most) {
        while (squareCells(limits, edge.metres()) > most) edge = edge.longer();
        return edge.metres();
    }
    while (squareCells(limits, edge.metres()) < kMinCount && edge.metres() > kMinLength &&
           squareCells(limits, edge.shorter().metres()) <= most)
        edge = edge.shorter();
    return edge.metres();
}

Grid gridOf(const Box2& limits, const CellCount& cells) {
    if (cells.columns < 1 || cells.rows < 1 || cells.columns > kMaxCells / cells.rows)
        throw UsageError("a grid of " + std::to_string(cells.columns) + " x " +
                         std::to_string(cells.rows) +
                         " cells cannot be made, wanted at least 1 each way and at most " +
                         std::to_string(kMaxCells) + " in all");
    return {limits, cells.columns, cells.rows};
}

/// \pre edge > 0
Grid gridOf(const Box2& limits, const CellSize& cells) {
    const double columns = cellsAlong(limits.width(), cells.edge);
    const double rows = cellsAlong(limits.depth(), cells.edge);
    if (!(columns * rows <= kMaxCells))
        throw UsageError("cells of " + formatDouble(cells.edge) + " m make more than " +
                         std::to_string(kMaxCells) + " over the limits: use larger ones");
    const Box2 box{limits.low,
                   {limits.low.x + columns * cells.edge, limits.low.y + rows * cells.edge}};
    return {box, static_cast<int>(columns), static_cast<int>(rows)};
}

Grid gridOf(const Box2& limits, const RoomCells& cells) {
    return gridOf(limits, CellSize{roomCell(limits, cells.most)});
}

}  // namespace

Grid gridOver(const Box2& limits, const CellChoice& cells) {
    return std::visit([&limits](const auto& choice) { return gridOf(limits, choice); }, cells);
}

Target makeTarget(const Environment& environment, const CellChoice& cells, double height) {
    Target target;
    target.grid = gridOver(environment.limits(), cells);
    target.height = height;
    target.indoor = cellsIn(target.grid, environment.indoor());
    target.free = target.indoor;
    target.free -= cellsBlocked(target.grid, environment.level(height)->slice().solids);
    return target;
}

namespace {

CellSet cellsOf(const Grid& grid, const NamedZone& zone) {
    return cellsWithin(grid, {&zone.outline, 1});
}

}  // namespace

std::vector<double> weightsOfCells(const Target& target, const FloorWeights& floor) {
    CellSet counted = target.indoor;
    if (!floor.targets.empty()) {
        CellSet wanted(target.grid.size());
        for (const NamedZone& zone : floor.targets) wanted |= cellsOf(target.grid, zone);
        counted &= wanted;
    }
    std::vector<double> weights(target.grid.size());
    counted.forEach([&weights](std::size_t cell) { weights[cell] = 1; });
    for (const auto& [zone, weight] : floor.weights) {
        CellSet cells = cellsOf(target.grid, zone);
        cells &= counted;
        cells.forEach([&weights, value = weight](std::size_t cell) { weights[cell] = value; });
    }
    return weights;
}

}  // namespace ispace
