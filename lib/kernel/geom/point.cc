// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/point.h"

#include <cmath>

namespace ispace {

namespace {

/// Computes remquo(degrees, 90), faster for a few turns, for which the subtraction is exact.
double quarterRest(double degrees, int& quadrant) {
    constexpr double kFew = 1e6;
    if (!(std::fabs(degrees) < kFew)) return std::remquo(degrees, 90.0, &quadrant);
    quadrant = static_cast<int>(degrees / 90 + (degrees < 0 ? -0.5 : 0.5));
    const double rest = degrees - 90.0 * quadrant;
    // The quotient is rounded, and of two at the same distance the even one counts.
    const bool odd = (static_cast<unsigned>(quadrant) & 1U) != 0;
    if (rest > 45 || (odd && rest == 45)) {
        ++quadrant;
        return rest - 90;
    }
    if (rest < -45 || (odd && rest == -45)) {
        --quadrant;
        return rest + 90;
    }
    return rest;
}

}  // namespace

CosSin cosSin(Angle angle) {
    // Reduced to within 45 degrees of a multiple of 90, where the remainder is exact and 0 gives
    // exactly (1, 0). Adding 0 drops the sign of minus zero.
    int quadrant = 0;
    const double rest = quarterRest(angle.degrees(), quadrant) * (std::numbers::pi / 180);
    const double c = std::cos(rest) + 0.0, s = std::sin(rest) + 0.0;
    switch (static_cast<unsigned>(quadrant) & 3U) {
        case 0:
            return {c, s};
        case 1:
            return {0.0 - s, c};
        case 2:
            return {0.0 - c, 0.0 - s};
        default:
            return {s, 0.0 - c};
    }
}

double cos(Angle angle) { return cosSin(angle).cos; }

double sin(Angle angle) { return cosSin(angle).sin; }

double tan(Angle angle) {
    const auto [c, s] = cosSin(angle);
    return s / c;
}

Angle wrapped(Angle angle) {
    // Computes remainder(), faster for less than two turns: the differences are exact.
    const double degrees = angle.degrees();
    if (degrees > -180 && degrees <= 180) return angle;
    if (degrees > 180 && degrees <= 540) return Angle::degrees(degrees - 360);
    const double rest = std::remainder(degrees, 360.0);  // in [-180, 180]
    return Angle::degrees(rest <= -180 ? 180 : rest);
}

Angle directionOf(double x, double y) {
    if (x == 0 && y == 0) return {};
    return wrapped(Angle::radians(std::atan2(y, x)));
}

}  // namespace ispace
