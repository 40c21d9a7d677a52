// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of the floor.
#ifndef SOCIAL_PLANE_H
#define SOCIAL_PLANE_H

#include <cmath>

namespace social {

constexpr double kPi = 3.14159265358979323846;

struct Vec {
    double x = 0, y = 0;
    Vec() = default;
    Vec(double to_x, double to_y) : x(to_x), y(to_y) {}
};
inline Vec operator+(Vec a, Vec b) { return Vec(a.x + b.x, a.y + b.y); }
inline Vec operator-(Vec a, Vec b) { return Vec(a.x - b.x, a.y - b.y); }
inline Vec operator*(double s, Vec a) { return Vec(s * a.x, s * a.y); }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
inline double cross(Vec a, Vec b) { return a.x * b.y - a.y * b.x; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec direction(double angle) { return Vec(std::cos(angle), std::sin(angle)); }
inline double angleOf(Vec a) { return std::atan2(a.y, a.x); }
/// Within [-pi, pi].
inline double wrapped(double angle) { return std::remainder(angle, 2 * kPi); }

/// Rounds to a millionth: results of the mathematical library may differ in their last digit from
/// one processor to another, and choices between equals must not.
inline double rounded(double value) { return std::round(value * 1e6) / 1e6; }

}  // namespace social

#endif  // SOCIAL_PLANE_H
