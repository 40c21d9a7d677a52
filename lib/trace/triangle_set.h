// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "env/body.h"
#include "env/mesh.h"
#include "geom/curve.h"
#include "geom/point.h"

namespace ispace {

/// An upright round body with closed ends.
struct RoundBody {
    Ellipse curve;
    double bottom = 0, top = 0;

    /// True only if p lies outside by more than `distance`, along the floor or upright: a quick
    /// bound, which may be false for points slightly farther. `unit`: p in the frame where the
    /// curve is the unit disc.
    [[nodiscard]] bool isFarOutside(Vec2 unit, double z, double distance) const {
        if (z - top > distance || bottom - z > distance) return true;
        // Ellipse::heightOf() is at least half_width (|u| - 1), where |u| <= 1 + (|u|^2 - 1) / 2.
        const double over = dot(unit, unit) - 1;
        const double narrow =
            curve.half_width < curve.half_length ? curve.half_width : curve.half_length;
        constexpr double kSlack = 1.001;
        return over > 0 && over * narrow > kSlack * distance * (2 + over / 2);
    }
};

/// Triangles in any order, with or without shared vertices.
struct TriangleSoup {
    static constexpr std::uint32_t kFlat = ~0U;

    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<RoundBody> rounds = {};
    /// For each triangle, the round body it represents, or kFlat; triangles beyond the end of this
    /// list are flat, too. The triangles of a round body enclose it.
    std::vector<std::uint32_t> round_of = {};

    /// \return the vertex' index
    std::uint32_t add(Point3 corner) {
        vertices.push_back(corner);
        return static_cast<std::uint32_t>(vertices.size() - 1);
    }
};

/// A ray up to `reach` times its direction.
struct Ray {
    Point3 origin;
    Vec3 direction;
    double reach = 0;
};

/// The plane dot(normal, p) = offset.
struct alignas(32) Plane {
    Vec3 normal;  ///< unit length
    double offset = 0;

    /// Signed distance from p to the plane, along the normal.
    [[nodiscard]] double heightOver(Point3 p) const {
        return offset - (normal.x * p.x + normal.y * p.y + normal.z * p.z);
    }
};

/// Intersection of a ray with a surface.
struct RayHit {
    double multiple = std::numeric_limits<double>::infinity();  ///< multiple of the ray's direction
    double slope = 0;                                           ///< |normal times direction|

    [[nodiscard]] bool isNone() const {
        return multiple == std::numeric_limits<double>::infinity();
    }
};

/// Triangles in doubles. Embree finds the triangle of a ray in float32. It stores them enlarged by
/// tolerance() on each side, which exceeds its error, so that a ray that touches a surface or
/// passes between two touching ones has a hit. The distance is computed here, in doubles.
class TriangleSet {
  public:
    /// Skips triangles thinner than a nanometre.
    explicit TriangleSet(const TriangleSoup& soup);

    [[nodiscard]] std::size_t size() const { return corners_.size(); }
    [[nodiscard]] const std::array<Point3, 3>& corners(std::size_t triangle) const {
        return corners_[triangle];
    }
    /// Returns the triangle's index in the soup.
    [[nodiscard]] std::size_t source(std::size_t triangle) const { return sources_[triangle]; }
    [[nodiscard]] std::span<const Plane> planes() const { return planes_; }
    /// Upper bound of Embree's error, in metres: 2^-21 of the scene's diagonal.
    [[nodiscard]] double tolerance() const { return tolerance_; }
    /// A hit whose smallest barycentric coordinate times the cosine of ray and normal exceeds this
    /// lies in the original triangle. Infinite for round bodies.
    [[nodiscard]] std::span<const double> margins() const { return margins_; }
    using FloatTriangle = std::array<std::array<float, 3>, 3>;
    /// Computes the corners of the enlarged triangles, in float32. \pre out.size() == size()
    void enlarge(std::span<FloatTriangle> out) const;

    /// Intersects a ray through the enlarged triangle with its plane, clamped to the triangle's
    /// extent along the ray; or with the round body that the triangle represents. From inside a
    /// round body, or going in from within `ray_epsilon` of its surface, returns the exit; going
    /// out from there the ray misses.
    [[nodiscard]] RayHit meet(std::size_t triangle, const Ray& ray, double ray_epsilon) const;
    [[nodiscard]] bool isRound(std::size_t triangle) const {
        return round_of_[triangle] != TriangleSoup::kFlat;
    }
    /// Returns the round body that the triangle represents; null for a flat triangle.
    [[nodiscard]] const RoundBody* roundOf(std::size_t triangle) const {
        return isRound(triangle) ? &rounds_[round_of_[triangle]] : nullptr;
    }
    /// Computes the distance from p to the closed triangle.
    [[nodiscard]] double distance(std::size_t triangle, Point3 p) const;

  private:
    [[nodiscard]] RayHit meetFlat(std::size_t triangle, const Ray& ray) const;
    [[nodiscard]] RayHit meetRound(std::size_t triangle, const Ray& ray, double ray_epsilon) const;

    std::vector<std::array<Point3, 3>> corners_;
    std::vector<Plane> planes_;
    std::vector<double> margins_;
    std::vector<RoundBody> rounds_;
    std::vector<std::uint32_t> round_of_, sources_;
    double tolerance_ = 0;
};

/// Builds a mesh that closely encloses a round prism, see TriangleSoup::round_of.
Mesh meshAround(Prism round);

/// Eight triangles, one array per component for vector units.
struct TriangleLanes {
    static constexpr std::size_t kSize = 8;

    struct Vectors {
        alignas(64) double x[kSize], y[kSize], z[kSize];
    };
    std::array<Vectors, 3> corners;

    void set(std::size_t lane, std::size_t corner, Point3 p) {
        corners[corner].x[lane] = p.x;
        corners[corner].y[lane] = p.y;
        corners[corner].z[lane] = p.z;
    }
};

/// Planes of eight triangles, as stored in a TriangleSet.
struct TriangleLanePlanes {
    TriangleLanes::Vectors normals;
    alignas(64) double offsets[TriangleLanes::kSize];
    /// Height over the longest side; NaN or 0 for unused lanes.
    alignas(64) double thin[TriangleLanes::kSize];
};
void findPlanes(const TriangleLanes& triangles, TriangleLanePlanes& planes);

/// Moves the corners outwards by `tolerance` from the adjacent sides; sharp corners by at most 16
/// times that.
void enlarge(TriangleLanes& triangles, double tolerance);

}  // namespace ispace
