// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/point.h"

#include <cmath>

namespace ispace {

CosSin cosSin(Angle angle) {
    // Reduced to within 45 degrees of a multiple of 90, where the remainder is exact and 0 gives
    // exactly (1, 0). Adding 0 drops the sign of minus zero.
    int quadrant = 0;
    const double rest = std::remquo(angle.degrees(), 90.0, &quadrant) * (std::numbers::pi / 180);
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
    const double rest = std::remainder(angle.degrees(), 360.0);  // in [-180, 180]
    return Angle::degrees(rest <= -180 ? 180 : rest);
}

Angle directionOf(double x, double y) {
    if (x == 0 && y == 0) return {};
    return wrapped(Angle::radians(std::atan2(y, x)));
}

}  // namespace ispace
