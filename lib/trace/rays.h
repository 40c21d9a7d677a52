// SPDX-License-Identifier: GPL-3.0-or-later
// Rays as all of lib/trace takes them.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "geom/point.h"

namespace ispace {

/// The range of a ray that meets nothing.
constexpr float kNoReturn = std::numeric_limits<float>::infinity();

/// Slack for rounding at the far end of a ray, or about a body, relative to the distance.
constexpr double kFarSlack = 1e-6;

/// Unit vectors, one array per component.
struct Directions {
    /// Level rays at equal steps: number k points along bearing first + k * step, in the world.
    struct Arc {
        Angle first, step;
        friend bool operator==(const Arc&, const Arc&) = default;
    };

    std::vector<double> x, y, z;
    /// Set if they form an arc of at most a full turn, which a slice is traced by faster; z is 0
    /// then.
    std::optional<Arc> arc = {};

    [[nodiscard]] std::size_t size() const { return x.size(); }
    void resize(std::size_t count) {
        x.resize(count);
        y.resize(count);
        z.resize(count);
    }
    void set(std::size_t i, Vec3 direction) {
        x[i] = direction.x;
        y[i] = direction.y;
        z[i] = direction.z;
    }
    [[nodiscard]] Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

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
