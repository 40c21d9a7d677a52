// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/grid.h"

#include <algorithm>
#include <cassert>

#include "base/number.h"
#include "cover/scanline.h"

namespace ispace {

double Grid::columnCenter(int column) const {
    return limits.low.x + limits.width() * ((column + 0.5) / columns);
}

double Grid::rowCenter(int row) const {
    return limits.low.y + limits.depth() * ((row + 0.5) / rows);
}

Point2 Grid::center(std::size_t cell) const {
    const auto across = static_cast<std::size_t>(columns);
    return {columnCenter(static_cast<int>(cell % across)),
            rowCenter(static_cast<int>(cell / across))};
}

double Grid::cellArea() const {
    return limits.width() * limits.depth() / static_cast<double>(size());
}

std::string cellsText(const Grid& grid) {
    constexpr int kDigits = 3;
    const std::string x = formatDouble(tidy(grid.limits.width() / grid.columns, kDigits));
    const std::string y = formatDouble(tidy(grid.limits.depth() / grid.rows, kDigits));
    return std::to_string(grid.columns) + " x " + std::to_string(grid.rows) + " cells of " + x +
           " m" + (x == y ? "" : " x " + y + " m");
}

std::size_t CellSet::count() const {
    std::size_t sum = 0;
    for (const std::uint64_t word : words_) sum += static_cast<std::size_t>(std::popcount(word));
    return sum;
}

void CellSet::addBits(std::size_t first, std::uint64_t bits) {
    if (bits == 0) return;
    words_[first / 64] |= bits << (first % 64);
    if (first % 64 == 0) return;
    if (const std::uint64_t rest = bits >> (64 - first % 64); rest != 0)
        words_[first / 64 + 1] |= rest;
}

bool CellSet::empty() const {
    return std::all_of(words_.begin(), words_.end(), [](std::uint64_t word) { return word == 0; });
}

CellSet& CellSet::operator|=(const CellSet& other) {
    assert(cells_ == other.cells_);
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
}

CellSet& CellSet::operator&=(const CellSet& other) {
    assert(cells_ == other.cells_);
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= other.words_[i];
    return *this;
}

CellSet& CellSet::operator-=(const CellSet& other) {
    assert(cells_ == other.cells_);
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
    return *this;
}

std::size_t countCommon(const CellSet& a, const CellSet& b) {
    assert(a.cells_ == b.cells_);
    std::size_t sum = 0;
    for (std::size_t i = 0; i < a.words_.size(); ++i)
        sum += static_cast<std::size_t>(std::popcount(a.words_[i] & b.words_[i]));
    return sum;
}

CellSet cellsIn(const Grid& grid, const Regions& regions) {
    CellSet inside(grid.size());
    for (const Region& part : regions.parts) {
        Scanline scan(grid, bounds(part.outline));
        part.forEachEdge([&scan](const Segment2& edge) { scan.add(edge); });
        scan.addInside(inside);
    }
    return inside;
}

CellSet cellsWithin(const Grid& grid, std::span<const Polygon> curves) {
    Box2 box;
    for (const Polygon& curve : curves)
        for (const Point2 p : curve) box.add(p);
    Scanline scan(grid, box);
    for (const Polygon& curve : curves)
        forEachEdge(curve, [&scan](const Segment2& edge) { scan.add(edge); });
    CellSet inside(grid.size());
    scan.addInside(inside);
    return inside;
}

CellSet cellsBlocked(const Grid& grid, const Slice& slice) {
    CellSet blocked(grid.size());
    for (const Polygon& solid : slice.solids) {
        Scanline scan(grid, bounds(solid));
        forEachEdge(solid, [&scan](const Segment2& edge) { scan.add(edge); });
        scan.addClosed(blocked);
    }
    return blocked;
}

}  // namespace ispace
