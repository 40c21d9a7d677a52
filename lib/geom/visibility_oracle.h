// SPDX-License-Identifier: GPL-3.0-or-later
// What tests and benchmarks compare visibility with: CGAL's triangular expansion, in exact numbers.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "geom/polygon.h"

namespace ispace::test {

/// Of lines and a box around them, 10 m away. Its code is in visibility_oracle_cgal_test.cc.
class VisibilityOracle {
  public:
    explicit VisibilityOracle(std::span<const Segment2> lines);
    ~VisibilityOracle();
    VisibilityOracle(const VisibilityOracle&) = delete;
    VisibilityOracle& operator=(const VisibilityOracle&) = delete;

    /// Seen from a point, on both sides of all lines on which it lies.
    [[nodiscard]] double areaFrom(Point2 p) const;
    /// The same from the place at `eighths` of a line, exactly on it; `rounded` is set to it.
    [[nodiscard]] double areaFrom(const Segment2& line, int eighths, Point2& rounded) const;

    /// Number of the face that a point lies strictly in.
    [[nodiscard]] std::optional<std::size_t> faceOf(Point2 p);
    /// What is seen from a point in a face, its corners as doubles; their sum.
    [[nodiscard]] Vec2 query(Point2 p, std::size_t face) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace::test
