// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/target.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

Target targetOn(const Environment& environment, const Grid& grid, double height) {
    Target target;
    target.grid = grid;
    target.height = height;
    target.indoor = cellsIn(target.grid, environment.indoor());
    target.free = target.indoor;
    target.free -= cellsBlocked(target.grid, environment.slice(height));
    return target;
}

}  // namespace

Target makeTarget(const Environment& environment, int columns, int rows, double height) {
    if (columns < 1 || rows < 1 || columns > kMostCells / rows)
        throw UsageError("a grid of " + std::to_string(columns) + " x " + std::to_string(rows) +
                         " cells cannot be made, wanted at least 1 each way and at most " +
                         std::to_string(kMostCells) + " in all");
    return targetOn(environment, {environment.limits(), columns, rows}, height);
}

Target makeTarget(const Environment& environment, double cell, double height) {
    Box2 box = environment.limits();
    const double columns = std::max(1.0, std::ceil(box.width() / cell - 1e-9));
    const double rows = std::max(1.0, std::ceil(box.depth() / cell - 1e-9));
    if (!(columns * rows <= kMostCells))
        throw UsageError("cells of " + formatDouble(cell) + " m make more than " +
                         std::to_string(kMostCells) + " over the limits: use larger ones");
    box.high = {box.low.x + columns * cell, box.low.y + rows * cell};
    return targetOn(environment, {box, static_cast<int>(columns), static_cast<int>(rows)}, height);
}

}  // namespace ispace
