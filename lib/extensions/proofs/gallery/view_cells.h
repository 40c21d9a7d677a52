// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/gallery: an index of views by position.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "extensions/proofs/gallery/star_view.h"

namespace ispace::proofs::gallery {

/// Finds the views that may hold a point: square cells over the floor, each with the views that
/// come within kClearance of it.
class ViewCells {
  public:
    explicit ViewCells(const Floor& floor);

    /// Adds a view under the next number, from 0.
    void add(const StarView& view);
    /// Calls visit(number) for the views that may come within `margin` of a point of the floor, in
    /// ascending order: for larger margins than kClearance, all of them.
    template <typename Visit>
    void forEachNear(Point2 p, double margin, Visit visit) const {
        if (margin > kClearance) {
            for (std::uint32_t i = 0; i < count_; ++i) visit(i);
        } else {
            for (const std::uint32_t i : cells_[indexOf(column(p.x), row(p.y))]) visit(i);
        }
    }

  private:
    /// Adds the view being added to the cells of a convex hull; segments hold its boundary.
    void mark(std::span<const Segment2> segments);
    [[nodiscard]] std::size_t cellOf(double offset) const;
    [[nodiscard]] std::size_t column(double x) const { return cellOf(x - box_.low.x); }
    [[nodiscard]] std::size_t row(double y) const { return cellOf(y - box_.low.y); }
    [[nodiscard]] std::size_t indexOf(std::size_t column, std::size_t row) const {
        return column * side_ + row;
    }

    Box2 box_;
    std::size_t side_;  // cells in a row and in a column
    double step_;
    std::uint32_t count_ = 0;
    std::vector<std::vector<std::uint32_t>> cells_;  // by column, ascending
};

}  // namespace ispace::proofs::gallery
