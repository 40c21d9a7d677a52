// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/simd.h"
#include "geom/curve.h"
#include "geom/point.h"

namespace ispace {

/// An upright round body: closed, as are its ends.
struct RoundBody {
    Ellipse curve;
    double bottom = 0, top = 0;
};

/// Triangles as they come: vertices may be shared or not.
struct TriangleSoup {
    static constexpr std::uint32_t kFlat = ~0U;

    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<RoundBody> rounds = {};
    /// Of each triangle, the round body that it stands for, or kFlat; triangles beyond are flat,
    /// too. Those of one body hold it.
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

/// A plane: where dot(normal, p) = offset, counted from the coordinates' origin.
struct alignas(32) Plane {
    Vec3 normal;  ///< unit length
    double offset = 0;

    /// Over a point, along the normal.
    [[nodiscard]] double heightOver(Point3 p) const {
        return offset - (normal.x * p.x + normal.y * p.y + normal.z * p.z);
    }
};

/// A ball that holds a scene, with room to spare, or the origins of rays.
struct Ball {
    Point3 middle;
    double radius = 0;

    [[nodiscard]] bool contains(const Ball& other) const {
        return length(other.middle - middle) + other.radius <= radius;
    }
    /// How many times its direction a ray may be moved ahead, so that it begins by the ball and
    /// misses nothing in it; 0 from inside.
    [[nodiscard]] ISPACE_INLINE double ahead(Point3 origin, Vec3 direction) const {
        const Vec3 way = middle - origin;
        const double squared = dot(direction, direction);
        const double multiple = (dot(way, direction) - radius * std::sqrt(squared)) / squared;
        return multiple > 0 ? multiple : 0;
    }
};

/// Where a ray meets a round body.
struct RoundMeeting {
    double multiple;  ///< of its direction; +infinity if it does not within its reach
    double slope;     ///< |normal times direction|
};

/// Triangles in doubles, and all that decides exactly which of them a ray meets.
///
/// A ray tracer that works in float32 finds the candidates. It is given triangles that are larger
/// by slack() on each side, and rays that begin within ball(), moved there if need be; the slack
/// then is more than its errors: no triangle that a ray meets is lost to it, unless the ray grazes
/// its rim. A hit whose least barycentric coordinate times the cosine of ray and normal is over
/// margin() lies in the triangle for certain; others are decided here. Those of round bodies are no
/// more than candidates: the body itself decides.
class TriangleSet {
  public:
    /// Triangles thinner than a nanometre are left out; vertices at one place become one. Splinters
    /// come twice, behind all others: an enlarged one takes two triangles, as its tips would reach
    /// far.
    explicit TriangleSet(TriangleSoup soup);

    [[nodiscard]] std::size_t size() const { return triangles_.size(); }
    [[nodiscard]] Point3 corner(std::size_t triangle, std::size_t i) const {
        return vertices_[triangles_[triangle][i]];
    }
    [[nodiscard]] std::span<const Plane> planes() const { return planes_; }
    [[nodiscard]] std::span<const double> margins() const { return margins_; }
    [[nodiscard]] double slack() const { return slack_; }
    [[nodiscard]] const Ball& ball() const { return ball_; }
    /// The triangle's corners moved outwards, in float32; half of a rectangle about a splinter.
    [[nodiscard]] std::array<std::array<float, 3>, 3> enlarged(std::size_t triangle) const;

    /// How many times its direction the ray goes to where it meets the closed triangle, within a
    /// nanometre aside; +infinity if it does not within its reach.
    [[nodiscard]] double meet(std::size_t triangle, const Ray& ray) const;
    /// Where the ray meets the round body that the triangle stands for; from inside where it
    /// leaves, as where it goes in from within `contact` of its surface. Going out from there it
    /// meets nothing.
    [[nodiscard]] RoundMeeting meetRound(std::size_t triangle, const Ray& ray,
                                         double contact) const;
    [[nodiscard]] bool isRound(std::size_t triangle) const {
        return round_of_[triangle] != TriangleSoup::kFlat;
    }
    /// Of a point from the closed triangle.
    [[nodiscard]] double distance(std::size_t triangle, Point3 p) const;

    /// Calls visit(index) for all triangles with a corner in common with this one's corner i.
    template <typename Visit>
    void forEachAtCorner(std::size_t triangle, std::size_t i, Visit visit) const {
        const std::uint32_t vertex = triangles_[triangle][i];
        for (std::uint32_t k = first_[vertex]; k < first_[vertex + 1]; ++k)
            visit(std::size_t{around_[k]});
    }
    /// The same for the side between this one's corners i and k.
    template <typename Visit>
    void forEachAtSide(std::size_t triangle, std::size_t i, std::size_t k, Visit visit) const {
        const std::uint32_t other = triangles_[triangle][k];
        forEachAtCorner(triangle, i, [&](std::size_t index) {
            const auto& [a, b, c] = triangles_[index];
            if (a == other || b == other || c == other) visit(index);
        });
    }

  private:
    using Corners = std::array<std::uint32_t, 3>;
    void merge(std::vector<Point3> vertices);
    void enclose();
    void measure();
    void add(const Corners& corners, const Plane& plane, double margin, std::uint32_t round);
    [[nodiscard]] std::array<Point3, 3> halfRectangle(std::size_t splinter) const;
    void listCorners();

    std::vector<Point3> vertices_;
    std::vector<Corners> triangles_;
    std::vector<Plane> planes_;
    std::vector<double> margins_;
    std::vector<RoundBody> rounds_;
    std::vector<std::uint32_t> round_of_;
    std::size_t splinters_ = 0;                  // the first of them
    std::vector<std::uint32_t> first_, around_;  // triangles about each vertex
    Ball ball_;
    double slack_ = 0;
};

}  // namespace ispace
