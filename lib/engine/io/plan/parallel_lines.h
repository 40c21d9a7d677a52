// SPDX-License-Identifier: GPL-3.0-or-later
// Walls drawn as two lines: the sides of a wall run parallel, 0.08 m to 0.5 m apart, and face each
// other.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "base/budget.h"
#include "geom/point.h"
#include "geom/spatial_index.h"

namespace ispace {

/// Lines by direction, to find those that face each other as the sides of a wall do: a tree of
/// boxes for each direction, in the frame of that direction, so that boxes are thin. O(n log n) to
/// build
class ParallelLines {
  public:
    /// \param lines outlive this object
    explicit ParallelLines(std::span<const Segment2> lines);

    /// Returns the distance, in the lines' unit, of the nearest line that faces this one as the
    /// other side of a wall does. Lines below 0.4 m are no sides.
    /// \param line one of them, or any other \param scale metres a unit
    /// \throws FormatError (without file and line) if the work is used up
    std::optional<double> otherSide(const Segment2& line, double scale, Budget& work);

  private:
    struct Path {
        Vec2 along;
        BoxTree tree;
        std::vector<std::size_t> lines;
    };

    std::span<const Segment2> lines_;
    std::map<std::size_t, Path> ways_;  // by direction
    std::size_t unpaid_ = 0;            // lines found, less than a unit of work
};

/// Returns the share of a polygon's length along which it is the side of a wall. O(n log n)
double shareOfWalls(const Polygon& outline, std::span<const Segment2> lines, Budget& work);

}  // namespace ispace
