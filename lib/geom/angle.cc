// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/angle.h"

#include <cmath>

namespace ispace {

namespace {

/// Cosine and sine of `degrees` reduced to within 45 degrees of a multiple of 90, where the
/// remainder is exact and 0 gives exactly (1, 0).
struct CosSin {
    double cos, sin;
};

CosSin cosSin(double degrees) {
    int quadrant = 0;
    const double rest = std::remquo(degrees, 90.0, &quadrant) * (std::numbers::pi / 180);
    const double c = std::cos(rest), s = std::sin(rest);
    switch (static_cast<unsigned>(quadrant) & 3U) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

}  // namespace

double cos(Angle angle) { return cosSin(angle.degrees()).cos + 0.0; }

double sin(Angle angle) { return cosSin(angle.degrees()).sin + 0.0; }

double tan(Angle angle) {
    const auto [c, s] = cosSin(angle.degrees());
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
