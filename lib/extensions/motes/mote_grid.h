// SPDX-License-Identifier: GPL-3.0-or-later
// Motes by their places, for radios that hear the nearest ones: a search visits few of thousands.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/point.h"

namespace ispace::motes {

struct MoteRadio;

/// Motes of a room, by number, to find those near a point first: the ones that stand by the cells
/// of a grid, about one for each, and the ones that movers carry. Memory and time to build: O(n).
class MoteGrid {
  public:
    MoteGrid() = default;
    explicit MoteGrid(std::span<const MoteRadio> motes);

    [[nodiscard]] const std::vector<std::uint32_t>& carried() const { return carried_; }
    /// Calls visit(numbers, next) for rings of cells about a point, each with its motes and a lower
    /// bound of the distance across the floor to all motes of later rings, until it returns false.
    template <typename Visit>
    void forEachRing(Point2 at, Visit visit) const;

    friend bool operator==(const MoteGrid&, const MoteGrid&) = default;

  private:
    [[nodiscard]] std::ptrdiff_t columnOf(double x) const { return cellOf(x - low_.x, columns_); }
    [[nodiscard]] std::ptrdiff_t rowOf(double y) const { return cellOf(y - low_.y, rows_); }
    [[nodiscard]] std::ptrdiff_t cellOf(double offset, std::ptrdiff_t count) const {
        return static_cast<std::ptrdiff_t>(
            std::clamp(offset / side_, 0.0, static_cast<double>(count - 1)));
    }
    void append(std::ptrdiff_t row, std::ptrdiff_t from, std::ptrdiff_t to,
                std::vector<std::uint32_t>& numbers) const;

    Point2 low_;
    double side_ = 1;
    std::ptrdiff_t columns_ = 0, rows_ = 0;
    std::vector<std::uint32_t> first_, numbers_;  // by cell, row by row
    std::vector<std::uint32_t> carried_;
};

template <typename Visit>
void MoteGrid::forEachRing(Point2 at, Visit visit) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (columns_ == 0) return;
    const std::ptrdiff_t column = columnOf(at.x), row = rowOf(at.y);
    std::vector<std::uint32_t> numbers;
    double next = 0;
    for (std::ptrdiff_t r = 0; next < kNone; ++r) {
        numbers.clear();
        const std::ptrdiff_t left = column - r, right = column + r;
        for (std::ptrdiff_t y = std::max<std::ptrdiff_t>(row - r, 0);
             y <= std::min(row + r, rows_ - 1); ++y) {
            if (y == row - r || y == row + r) {
                append(y, left, right, numbers);
            } else {
                append(y, left, left, numbers);
                append(y, right, right, numbers);
            }
        }
        // Cells beyond the ring lie beyond one of the sides of its square.
        next = kNone;
        const auto beyond = [&](bool is_there, double distance) {
            if (is_there) next = std::min(next, std::max(0.0, distance));
        };
        const double x = at.x - low_.x, y = at.y - low_.y;
        beyond(left > 0, x - static_cast<double>(left) * side_);
        beyond(right + 1 < columns_, static_cast<double>(right + 1) * side_ - x);
        beyond(row - r > 0, y - static_cast<double>(row - r) * side_);
        beyond(row + r + 1 < rows_, static_cast<double>(row + r + 1) * side_ - y);
        if (!visit(std::span<const std::uint32_t>(numbers), next)) return;
    }
}

}  // namespace ispace::motes
