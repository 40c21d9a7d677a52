// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/geom: angles, points, poses, polygons, regions, exact predicates, overlays,
// visibility. Uses base and Eigen; CGAL in sources alone.
//
// Angles, points and vectors of the plane and of space. Frames are right-handed: x-y is the floor,
// z is up, angles count counter-clockwise seen from above. Metres everywhere. Types carry roles:
// the difference of two points is a vector, a sum of two points does not compile. All types are
// plain values, all functions pure; coordinates may be infinite (Box2) but NaN is not handled:
// readers reject it. Results round as doubles do unless a comment says exact.
//
//     const Point2 corner{4, 3};
//     const Vec2 way = corner - Point2{0, 0};
//     const double range = length(way);                               // 5 m
//     const Angle bearing = directionOf(way.x, way.y);                // 36.87 degrees
//     const Point2 back = corner - range * unitVector(bearing);       // (0, 0), but for rounding
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <numbers>

namespace ispace {

/// A plane angle; the unit is named where one is made or read. Counter-clockwise is positive.
///
/// Stored in degrees, the unit of files and options, so that 90 is exactly a quarter turn: cosine
/// and sine are exact at multiples of 90 degrees and rectangular walls stay rectangular. Not
/// reduced: 370 degrees and 10 degrees differ until wrapped(). Converting radians rounds twice, so
/// radians(degrees(a)) may differ from a by an ulp.
class Angle {
  public:
    constexpr Angle() = default;
    static constexpr Angle degrees(double value) { return Angle(value); }
    static constexpr Angle radians(double value) { return Angle(value * (180 / std::numbers::pi)); }
    [[nodiscard]] constexpr double degrees() const { return degrees_; }
    [[nodiscard]] constexpr double radians() const { return degrees_ * (std::numbers::pi / 180); }

    friend constexpr Angle operator+(Angle a, Angle b) { return Angle(a.degrees_ + b.degrees_); }
    friend constexpr Angle operator-(Angle a, Angle b) { return Angle(a.degrees_ - b.degrees_); }
    friend constexpr Angle operator-(Angle a) { return Angle(-a.degrees_); }
    friend constexpr Angle operator*(double s, Angle a) { return Angle(s * a.degrees_); }
    friend constexpr auto operator<=>(Angle a, Angle b) = default;

  private:
    explicit constexpr Angle(double degrees) : degrees_(degrees) {}
    double degrees_ = 0;
};

/// Cosine and sine of one angle.
struct CosSin {
    double cos, sin;
};
/// Computes both at once; exact at multiples of 90 degrees, where zeros are positive.
///
/// The angle is reduced in degrees, where the remainder modulo 90 is exact for any size; cosine and
/// sine of the rest, within 45 degrees, are those of the standard library. So 1e9 * 360 + 30
/// degrees has the sine of 30 degrees.
CosSin cosSin(Angle angle);
double cos(Angle angle);
double sin(Angle angle);
/// Infinite at odd multiples of 90 degrees.
double tan(Angle angle);

/// The same direction within (-180, 180] degrees; exact, by whole turns.
Angle wrapped(Angle angle);

/// Direction of the vector (x, y), in (-180, 180]; 0 for the null vector.
Angle directionOf(double x, double y);

/// A displacement on the floor, in metres.
struct Vec2 {
    double x = 0, y = 0;
    friend bool operator==(const Vec2&, const Vec2&) = default;
};

/// A point on the floor, in metres; x-y is the floor, right-handed.
struct Point2 {
    double x = 0, y = 0;
    friend bool operator==(const Point2&, const Point2&) = default;
};

/// A displacement in space, in metres; z is up.
struct Vec3 {
    double x = 0, y = 0, z = 0;
    friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// A point in space, in metres; the floor lies at z = 0.
struct Point3 {
    double x = 0, y = 0, z = 0;
    [[nodiscard]] Point2 onFloor() const { return {x, y}; }
    friend bool operator==(const Point3&, const Point3&) = default;
};

// There is no Point + Point: the sum of two points is not a point.
inline Vec2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
inline Point2 operator+(Point2 p, Vec2 v) { return {p.x + v.x, p.y + v.y}; }
inline Point2 operator-(Point2 p, Vec2 v) { return {p.x - v.x, p.y - v.y}; }
inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator-(Vec2 v) { return {-v.x, -v.y}; }
inline Vec2 operator*(double s, Vec2 v) { return {s * v.x, s * v.y}; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// z component of the cross product: positive if b lies to the left of a. Rounds, by 2^-52 of the
/// sum of its two products at most; decisions go through orientation() in predicates.h.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
/// Euclidean length; neither overflows nor underflows within (std::hypot).
inline double length(Vec2 v) { return std::hypot(v.x, v.y); }
/// Lexicographic order: by x, then by y.
inline bool lexLess(Point2 a, Point2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }
inline double distance(Point2 a, Point2 b) { return length(b - a); }
/// v turned left by a quarter turn.
inline Vec2 perpendicular(Vec2 v) { return {-v.y, v.x}; }
/// Exact at multiples of 90 degrees.
inline Vec2 unitVector(Angle heading) {
    const auto [c, s] = cosSin(heading);
    return {c, s};
}

inline Vec3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 operator+(Point3 p, Vec3 v) { return {p.x + v.x, p.y + v.y, p.z + v.z}; }
inline Vec3 operator*(double s, Vec3 v) { return {s * v.x, s * v.y, s * v.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 v) { return std::hypot(v.x, v.y, v.z); }

/// Axis-parallel closed rectangle on the floor; empty until a point is added. A point or a line is
/// a box without area, not an empty one.
struct Box2 {
    Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Point2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

    [[nodiscard]] bool empty() const { return low.x > high.x || low.y > high.y; }
    /// Extent in x, metres; negative infinity if empty.
    [[nodiscard]] double width() const { return high.x - low.x; }
    [[nodiscard]] double depth() const { return high.y - low.y; }
    /// Halves before it adds, so that the largest boxes do not overflow. \pre not empty
    [[nodiscard]] Point2 center() const {
        return {low.x + (high.x - low.x) / 2, low.y + (high.y - low.y) / 2};
    }
    /// Grows to contain p.
    void add(Point2 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    /// Includes the boundary.
    [[nodiscard]] bool contains(Point2 p) const {
        return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
    }
    /// True for an empty box, and for the box itself.
    [[nodiscard]] bool contains(const Box2& other) const {
        return other.empty() || (contains(other.low) && contains(other.high));
    }
    /// True if the closed boxes share a point; an empty box shares none.
    [[nodiscard]] bool meets(const Box2& other) const {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
               other.low.y <= high.y;
    }
    /// True if the interiors share a point.
    [[nodiscard]] bool overlaps(const Box2& other) const {
        return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y &&
               other.low.y < high.y;
    }
    /// Returns the box with each side moved outwards by `margin`.
    [[nodiscard]] Box2 expanded(double margin) const { return expanded(margin, margin); }
    [[nodiscard]] Box2 expanded(double x, double y) const {
        return {{low.x - x, low.y - y}, {high.x + x, high.y + y}};
    }
    friend bool operator==(const Box2&, const Box2&) = default;
};

}  // namespace ispace
