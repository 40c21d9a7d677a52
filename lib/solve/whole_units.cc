// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/whole_units.h"

#include <algorithm>
#include <cmath>

namespace ispace {

namespace {

constexpr double kMostUnits = 4e9;

/// Each is a whole number of units, and more than none if it is more than 0.
bool areWhole(const std::vector<double>& worth, double scale, double slack) {
    return std::all_of(worth.begin(), worth.end(), [scale, slack](double w) {
        const double units = std::round(w * scale);
        return std::abs(w * scale - units) < slack * scale && (units > 0 || w == 0);
    });
}

double scaleOf(const std::vector<double>& worth) {
    constexpr double kDecimals = 1e6, kDigits = 1e5;
    constexpr double kMostScale = 1e300;  // of weights that are hardly numbers
    double sum = 0, largest = 0;
    for (const double w : worth) {
        sum += w;
        largest = std::max(largest, w);
    }
    if (largest == 0) return 1;
    if (sum > kMostUnits) return kMostUnits / sum;
    const double slack = 1e-9 * std::min(1.0, largest);
    double scale = 1;
    while ((scale < kDecimals || largest * scale < kDigits) && scale < kMostScale &&
           sum * scale * 10 < kMostUnits && !areWhole(worth, scale, slack))
        scale *= 10;
    return scale;
}

}  // namespace

std::vector<std::uint32_t> wholeUnits(const std::vector<double>& worth) {
    const double scale = scaleOf(worth);
    std::vector<std::uint32_t> units;
    units.reserve(worth.size());
    for (const double w : worth)
        units.push_back(
            w == 0 ? 0U : static_cast<std::uint32_t>(std::max(1LL, std::llround(w * scale))));
    return units;
}

}  // namespace ispace
