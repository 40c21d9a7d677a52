// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geom/point.h"

namespace ispace {

/// Unit vectors, a component an array, as kernels want them.
struct Directions {
    /// Level rays at equal steps: number k points along bearing first + k * step, in the world.
    struct Arc {
        Angle first, step;
        friend bool operator==(const Arc&, const Arc&) = default;
    };

    std::vector<double> x, y, z;
    /// Given if they are those of an arc that spans at most a full turn; lets a slice be walked by
    /// angle. z is 0 then.
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

}  // namespace ispace
