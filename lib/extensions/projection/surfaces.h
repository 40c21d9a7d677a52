// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces of a room, flattened for pictures: each face with a frame and a grid of cells.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "env/environment.h"
#include "geom/point.h"
#include "geom/pose.h"

namespace ispace::projection {

/// A flat part of a surface, as seen from its front, and square cells over its bounds.
///
/// `frame` has its origin at the lower left corner of the bounds, `forward` along the normal,
/// `left` to the left as seen from the front, and `up` in the plane: upwards on walls, along +y on
/// floors and ceilings.
struct FlatFace {
    Frame3 frame;
    double width = 0, height = 0;  ///< of the bounds
    double area = 0;               ///< m2
    std::size_t columns = 0, rows = 0;
    std::vector<std::size_t> cells = {};  ///< those with their centre in the facet, row by row

    [[nodiscard]] double cellWidth() const { return width / static_cast<double>(columns); }
    [[nodiscard]] double cellHeight() const { return height / static_cast<double>(rows); }
    /// Returns the area that a cell stands for, so that all sum up to `area`.
    [[nodiscard]] double cellArea() const {
        return cells.empty() ? 0 : area / static_cast<double>(cells.size());
    }
    /// Returns a point by its way to the right and upwards from the lower left corner.
    [[nodiscard]] Point3 at(double right, double up) const {
        return frame.origin + (-right) * frame.left + up * frame.up;
    }
    [[nodiscard]] Point3 middleOf(std::size_t cell) const {
        const double column = static_cast<double>(cell % columns);
        const double row = static_cast<double>(cell / columns);
        return at((column + 0.5) * cellWidth(), (row + 0.5) * cellHeight());
    }
};

/// A surface on which pictures may fall.
struct ProjectionSurface {
    std::string element;  ///< id, "floor" for the floor of the room
    std::string name;     ///< "wall w1, facing 90", "table t1, top", "pillar p1, narrow faces"
    std::vector<FlatFace> facets;

    [[nodiscard]] double area() const;
    /// Returns true if it is flat, so that a picture on it is a quadrilateral.
    [[nodiscard]] bool isFlat() const { return facets.size() == 1; }
};

/// Returns the surfaces of an environment that stop light: the floor, then each element's faces by
/// their planes, both sides of sheets, in a fixed order. The pieces of a wall beside its openings
/// are one surface. Faces narrower than 0.2 m, as of round things, are one surface of their
/// element. \param cell size of cells, metres: the least that divides the bounds evenly and is not
/// above it \throws UsageError if a surface has more than kMostProjectionCells O(n log n) for n
/// triangles, and the cells.
std::vector<ProjectionSurface> projectionSurfaces(const Environment& environment, double cell);

constexpr double kMostProjectionCells = 1e8;

}  // namespace ispace::projection
