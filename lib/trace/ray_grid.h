// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "geom/point.h"

namespace ispace {

/// The rays of a picture through one origin: that of pixel (column, row) points along
/// corner + column * right + row * down, which need not be of unit length.
struct RayGrid {
    Vec3 corner, right, down;
    int columns = 0, rows = 0;

    [[nodiscard]] std::size_t size() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    [[nodiscard]] Vec3 ray(int column, int row) const {
        const double i = column, j = row;
        return {corner.x + i * right.x + j * down.x, corner.y + i * right.y + j * down.y,
                corner.z + i * right.z + j * down.z};
    }
};

}  // namespace ispace
