// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of rays and their conventions, for all of lib/kernel/trace. A ray holds both its ends.
// Ranges are multiples of the vectors given: metres for unit vectors. Vectors are in the frame of
// the world.
//
//     Directions beams;
//     beams.resize(180);
//     for (int i = 0; i < 180; ++i) {
//         const Vec2 way = unitVector(Angle::degrees(i));
//         beams.set(static_cast<std::size_t>(i), {way.x, way.y, 0});
//     }
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "geom/point.h"
#include "geom/tolerance.h"

namespace ispace {

/// Range of a ray without return: never 0 or the maximum range.
constexpr float kNoReturn = std::numeric_limits<float>::infinity();

/// A ray up to `reach` times its direction, both ends included.
struct Ray {
    Point3 origin;
    Vec3 direction;
    double reach = 0;
};

/// Intersection of a ray with a surface, flat or round, standing or moving.
struct RayHit {
    double multiple = std::numeric_limits<double>::infinity();  ///< multiple of the ray's direction
    /// |normal times direction|: the cosine if the direction is a unit vector.
    double slope = 0;

    [[nodiscard]] bool isNone() const {
        return multiple == std::numeric_limits<double>::infinity();
    }
};

/// Unit vectors, one array per component, so that loops over rays are vectorised. Unit up to
/// rounding: ranges are multiples of the vectors given. Fastest if neighbours point in similar
/// directions.
///
/// \pre x, y and z have one size
struct Directions {
    /// Level rays at equal steps: number k points along bearing first + k * step, in the world.
    struct Arc {
        Angle first, step;
        friend bool operator==(const Arc&, const Arc&) = default;
    };

    std::vector<double> x, y, z;
    /// Set if the directions form an arc of at most a full turn, for which slices are faster; then
    /// z is 0.
    std::optional<Arc> arc = {};

    [[nodiscard]] std::size_t size() const { return x.size(); }
    /// New elements are null vectors, to be set.
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

/// The rays of a picture through one origin: pixel (column, row) has direction corner + column *
/// right + row * down, not necessarily of unit length. Results are row by row, and depths multiples
/// of these directions: with corner, right and down on the plane one metre ahead they are depths
/// along the axis.
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
