// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of drawings, and how they lie in the plan.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// An affine map between frames; circles may become ellipses.
struct Affine {
    Vec2 x{1, 0}, y{0, 1};
    Vec2 origin;

    [[nodiscard]] Vec2 operator*(Vec2 v) const { return v.x * x + v.y * y; }
    [[nodiscard]] Point2 operator*(Point2 p) const {
        const Vec2 v = *this * Vec2{p.x, p.y} + origin;
        return {v.x, v.y};
    }
    [[nodiscard]] Affine operator*(const Affine& inner) const {
        return {*this * inner.x, *this * inner.y, *this * inner.origin + origin};
    }
    /// No length grows by more.
    [[nodiscard]] double largestScale() const { return std::hypot(length(x), length(y)); }
};

/// How far straight pieces may be off their curve, in metres.
constexpr double kCurveSagitta = 0.001;

/// Number of straight pieces of an arc of `sweep` radians: within kCurveSagitta for radii to
/// 10 km, none longer than an eighth of the circle.
int arcPieces(double sweep, double radius);

/// A cubic Bézier curve in metres.
using CubicCurve = std::array<Point2, 4>;

/// Appends points after the first that follow the curve within kCurveSagitta; the last is the
/// curve's end.
void appendCubic(const CubicCurve& curve, Polygon& points);

/// A B-spline in metres, rational where weights differ.
struct SplineCurve {
    int degree = 3;
    std::vector<double> knots;  ///< controls.size() + degree + 1, none below the one before
    std::vector<Point2> controls;
    std::vector<double> weights;  ///< one a control, above 0; empty: all the same
};

/// What is wrong with the numbers of a spline, or "".
std::string splineFault(const SplineCurve& spline);

/// Points along the spline whose straight pieces are within kCurveSagitta of it; stops after
/// `most`. \pre splineFault() is ""
Polygon splinePoints(const SplineCurve& spline, std::size_t most);

/// The centre if the curve is practically an arc of a circle, as drawing programs write them.
std::optional<Point2> arcCenter(const CubicCurve& curve);

}  // namespace ispace
