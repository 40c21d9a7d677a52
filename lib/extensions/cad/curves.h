// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of drawings, and their straight pieces in the plan.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "geom/polygon.h"

namespace ispace::cad {

inline constexpr double kFullTurn = 2 * std::numbers::pi;

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
    /// Returns an upper bound of the factor by which lengths grow.
    [[nodiscard]] double largestScale() const { return std::hypot(length(x), length(y)); }
};

/// Maximum distance of straight pieces from their curve, in metres.
constexpr double kCurveSagitta = 0.001;

/// Returns the number of straight pieces for an arc of `sweep` radians: within kCurveSagitta for
/// radii to 10 km, each at most an eighth of the circle.
int arcPieces(double sweep, double radius);

/// A cubic Bézier curve in metres.
using CubicCurve = std::array<Point2, 4>;

/// Appends points after the first that follow the curve within kCurveSagitta; the last is the
/// curve's end.
void appendCubic(const CubicCurve& curve, Polygon& points);

/// A B-spline in metres, rational where weights differ.
struct SplineCurve {
    int degree = 3;
    std::vector<double> knots;  ///< controls.size() + degree + 1, non-decreasing
    std::vector<Point2> controls;
    std::vector<double> weights;  ///< one a control, above 0; empty: all equal
};

/// Returns the error in the numbers of a spline, or "".
std::string splineFault(const SplineCurve& spline);

/// Returns points along the spline; their straight pieces are within kCurveSagitta of it. Stops
/// after `most`. \pre splineFault() is ""
Polygon splinePoints(const SplineCurve& spline, std::size_t most);

/// Finds the centre if the curve approximates an arc of a circle, as drawing programs write them.
std::optional<Point2> arcCenter(const CubicCurve& curve);

}  // namespace ispace::cad
