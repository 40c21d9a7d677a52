// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ispace {

/// An interval of numbers, for bounds of formulas over boxes. Rounding is not directed outwards.
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

inline double squareOf(double a) { return a * a; }
inline Interval squareOf(Interval a) {
    const double low = a.low * a.low, high = a.high * a.high;
    if (a.low <= 0 && a.high >= 0) return {0, std::max(low, high)};
    return {std::min(low, high), std::max(low, high)};
}

inline double rootOf(double a) { return std::sqrt(a); }
inline Interval rootOf(Interval a) { return {std::sqrt(a.low), std::sqrt(a.high)}; }

inline Interval absolute(Interval a) {
    if (a.low <= 0 && a.high >= 0) return {0, std::max(-a.low, a.high)};
    return {std::min(std::fabs(a.low), std::fabs(a.high)),
            std::max(std::fabs(a.low), std::fabs(a.high))};
}

inline Interval lesserOf(Interval a, Interval b) {
    return {std::min(a.low, b.low), std::min(a.high, b.high)};
}

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
