// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/trace: the surfaces of an Embree scene in doubles. Decides hits that
// Embree's float32 proposes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/point.h"
#include "trace/rays.h"
#include "trace/round_body.h"

namespace ispace {

/// Triangles in any order, with or without shared vertices, and round bodies, in metres. Both sides
/// of a triangle stop rays. Degenerate triangles are allowed: TriangleSet skips those without
/// height.
struct TriangleSoup {
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<RoundBody> rounds = {};

    /// \return the vertex' index
    std::uint32_t add(Point3 corner) {
        vertices.push_back(corner);
        return static_cast<std::uint32_t>(vertices.size() - 1);
    }
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

/// Surfaces in doubles, numbered: flat triangles, then those of round bodies. Embree finds the
/// triangle of a ray in float32. It stores them enlarged by tolerance() on each side, which exceeds
/// its error, so that a ray that touches a surface or passes between two touching ones has a hit.
/// The distance is computed here, in doubles.
///
/// A few round bodies are represented by triangles that closely enclose them, which Embree finds
/// in the tree of the others. Many bodies would be most of that tree: then each is a surface of its
/// own, in a tree of bodies.
///
/// Bound: corners, origins and directions in float32 and Embree's products err by less than 2^-21
/// of the scene's diagonal, for origins in the scene. Immutable once built, and thread-safe. O(n).
class TriangleSet {
  public:
    /// A round body and its number among the surfaces, if it is one.
    struct RoundSurface {
        RoundBody body;
        std::uint32_t surface = 0;
    };
    /// Maximum number of triangles that represent round bodies.
    static constexpr std::size_t kMaxOfRounds = 1 << 15;

    /// Skips triangles thinner than a nanometre.
    explicit TriangleSet(const TriangleSoup& soup);

    /// Number of surfaces.
    [[nodiscard]] std::size_t size() const { return planes_.size(); }
    /// Number of surfaces that are triangles.
    [[nodiscard]] std::size_t triangles() const { return corners_.size(); }
    /// Returns the round bodies that are surfaces.
    [[nodiscard]] std::span<const RoundSurface> rounds() const {
        return triangles() < size() ? std::span(rounds_) : std::span<const RoundSurface>();
    }
    [[nodiscard]] const std::array<Point3, 3>& corners(std::size_t triangle) const {
        return corners_[triangle];
    }
    /// Returns the index in the soup of a flat triangle, or of the round body of a surface.
    [[nodiscard]] std::size_t source(std::size_t surface) const { return sources_[surface]; }
    /// Planes of all surfaces; those of round bodies are not used.
    [[nodiscard]] std::span<const Plane> planes() const { return planes_; }
    /// Upper bound of Embree's error, in metres: 2^-21 of the scene's diagonal.
    [[nodiscard]] double tolerance() const { return tolerance_; }
    /// A hit whose smallest barycentric coordinate times the cosine of ray and normal exceeds this
    /// lies in the original triangle. Infinite for round bodies.
    [[nodiscard]] std::span<const double> margins() const { return margins_; }
    using FloatTriangle = std::array<std::array<float, 3>, 3>;
    /// Computes the corners of the enlarged triangles, in float32. \pre out.size() == triangles()
    void enlarge(std::span<FloatTriangle> out) const;

    /// Intersects a ray through the enlarged triangle with its plane, clamped to the triangle's
    /// extent along the ray; or with a round body, see meetRound().
    [[nodiscard]] RayHit meet(std::size_t surface, const Ray& ray, double ray_epsilon) const;
    /// Returns the round body that the surface represents; null for a flat triangle.
    [[nodiscard]] const RoundBody* roundOf(std::size_t surface) const {
        return surface < flats_ ? nullptr : &rounds_[sources_[surface]].body;
    }
    /// Appends the unit normals of a surface where it is within `distance` of p.
    void addTouched(std::size_t surface, Point3 p, double distance,
                    std::vector<Vec3>& normals) const;

  private:
    void addTriangles(const TriangleSoup& soup);
    [[nodiscard]] RayHit meetFlat(std::size_t triangle, const Ray& ray) const;
    [[nodiscard]] double distance(std::size_t triangle, Point3 p) const;

    std::vector<std::array<Point3, 3>> corners_;
    std::vector<Plane> planes_;
    std::vector<double> margins_;
    std::vector<RoundSurface> rounds_;
    std::vector<std::uint32_t> sources_;
    double tolerance_ = 0;
    std::size_t flats_ = 0;  // number of flat triangles
};

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
