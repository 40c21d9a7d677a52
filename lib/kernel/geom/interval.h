// SPDX-License-Identifier: GPL-3.0-or-later
// Interval arithmetic for branch and bound over boxes of poses (R. E. Moore, Interval Analysis,
// 1966). The functions are overloaded for double, so that one template states a formula, evaluates
// it at a point, and bounds it over a box:
//
//     template <typename T> T squaredRange(T x, T y) { return squareOf(x) + squareOf(y); }
//     const Interval over_box = squaredRange(Interval{1, 2}, Interval{-1, 3});  // {1, 13}
//
// Guarantee: the result contains the formula's value for every choice of arguments in the given
// intervals, up to rounding. Rounding is not directed outwards: a proof needs slack of some ulp of
// the largest term. An argument that occurs twice makes the result wider than the true range.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ispace {

/// The closed interval of numbers from low to high. \pre low <= high, both finite: 0 times infinity
/// is NaN
struct Interval {
    double low = 0, high = 0;

    friend Interval operator+(Interval a, Interval b) { return {a.low + b.low, a.high + b.high}; }
    friend Interval operator+(double a, Interval b) { return {a + b.low, a + b.high}; }
    friend Interval operator*(Interval a, Interval b) {
        const auto [low, high] =
            std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
        return {low, high};
    }
    friend Interval operator*(double a, Interval b) {
        return a < 0 ? Interval{a * b.high, a * b.low} : Interval{a * b.low, a * b.high};
    }
};

/// The square; an interval that holds 0 has the least square 0, unlike a * a.
inline double squareOf(double a) { return a * a; }
inline Interval squareOf(Interval a) {
    const double low = a.low * a.low, high = a.high * a.high;
    if (a.low <= 0 && a.high >= 0) return {0, std::max(low, high)};
    return {std::min(low, high), std::max(low, high)};
}

/// The square root. \pre not negative
inline double rootOf(double a) { return std::sqrt(a); }
inline Interval rootOf(Interval a) { return {std::sqrt(a.low), std::sqrt(a.high)}; }

/// The interval of the magnitudes.
inline Interval absolute(Interval a) {
    if (a.low <= 0 && a.high >= 0) return {0, std::max(-a.low, a.high)};
    return {std::min(std::fabs(a.low), std::fabs(a.high)),
            std::max(std::fabs(a.low), std::fabs(a.high))};
}

/// The interval of the lesser of two numbers.
inline Interval lesserOf(Interval a, Interval b) {
    return {std::min(a.low, b.low), std::min(a.high, b.high)};
}

/// The interval of cosines of angles in radians: exact extremes 1 and -1 where the interval holds a
/// multiple of pi. O(1) for any width
inline Interval cosineOf(Interval angle) {
    const double a = std::cos(angle.low), b = std::cos(angle.high);
    // The multiples of pi inside are the extremes.
    const double first = std::ceil(angle.low / std::numbers::pi);
    const double last = std::floor(angle.high / std::numbers::pi);
    Interval cosine{std::min(a, b), std::max(a, b)};
    for (double k = first; k <= std::min(last, first + 1); ++k)
        (std::fmod(k, 2) == 0 ? cosine.high : cosine.low) = std::fmod(k, 2) == 0 ? 1 : -1;
    return cosine;
}

}  // namespace ispace
