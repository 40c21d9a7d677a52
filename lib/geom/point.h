// SPDX-License-Identifier: GPL-3.0-or-later
// lib/geom: points, poses, angles, polygons, predicates, regions. Uses base, Eigen, CGAL (inside).
#pragma once

#include <cmath>

#include "geom/angle.h"

namespace ispace {

/// A displacement on the floor, in metres.
struct Vec2 {
    double x = 0, y = 0;
    friend bool operator==(const Vec2&, const Vec2&) = default;
};

/// A place on the floor, in metres; x-y is the floor, right-handed.
struct Point2 {
    double x = 0, y = 0;
    friend bool operator==(const Point2&, const Point2&) = default;
};

/// A displacement in space, in metres; z is up.
struct Vec3 {
    double x = 0, y = 0, z = 0;
    friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// A place in space, in metres; the floor lies at z = 0.
struct Point3 {
    double x = 0, y = 0, z = 0;
    [[nodiscard]] Point2 onFloor() const { return {x, y}; }
    friend bool operator==(const Point3&, const Point3&) = default;
};

// There is no Point + Point: the sum of two places is not a place.
inline Vec2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
inline Point2 operator+(Point2 p, Vec2 v) { return {p.x + v.x, p.y + v.y}; }
inline Point2 operator-(Point2 p, Vec2 v) { return {p.x - v.x, p.y - v.y}; }
inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator-(Vec2 v) { return {-v.x, -v.y}; }
inline Vec2 operator*(double s, Vec2 v) { return {s * v.x, s * v.y}; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// z component of the cross product: positive if b lies to the left of a. Rounds; decisions go
/// through orientation() in predicates.h.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline double length(Vec2 v) { return std::hypot(v.x, v.y); }
/// An order of places without meaning but that it is one: by x, then by y.
inline bool lexLess(Point2 a, Point2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }
inline double distance(Point2 a, Point2 b) { return length(b - a); }
/// v turned left by a quarter turn.
inline Vec2 perpendicular(Vec2 v) { return {-v.y, v.x}; }
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

}  // namespace ispace
