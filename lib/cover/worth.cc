// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/worth.h"

namespace ispace {

namespace {

CellSet cellsOf(const Grid& grid, const NamedZone& zone) {
    return cellsWithin(grid, {&zone.outline, 1});
}

}  // namespace

std::vector<double> worthOfCells(const Target& target, const Worth& worth) {
    CellSet counted = target.indoor;
    if (!worth.targets.empty()) {
        CellSet wanted(target.grid.size());
        for (const NamedZone& zone : worth.targets) wanted |= cellsOf(target.grid, zone);
        counted &= wanted;
    }
    std::vector<double> worths(target.grid.size());
    counted.forEach([&worths](std::size_t cell) { worths[cell] = 1; });
    for (const auto& [zone, weight] : worth.weights) {
        CellSet cells = cellsOf(target.grid, zone);
        cells &= counted;
        cells.forEach([&worths, value = weight](std::size_t cell) { worths[cell] = value; });
    }
    return worths;
}

}  // namespace ispace
