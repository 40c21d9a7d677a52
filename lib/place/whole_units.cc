// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/whole_units.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace ispace {

std::vector<std::uint32_t> wholeUnits(const std::vector<double>& worth) {
    constexpr double kMostUnits = 4e9;
    double sum = 0;
    for (const double w : worth) sum += w;
    if (sum > kMostUnits) throw UsageError("--weight: the weights are too large");
    const auto is_whole = [&worth](double scale) {
        return std::all_of(worth.begin(), worth.end(), [scale](double w) {
            return std::abs(w * scale - std::round(w * scale)) < 1e-9 * scale;
        });
    };
    double scale = 1;
    while (scale < 1e6 && !is_whole(scale) && sum * scale * 10 < kMostUnits) scale *= 10;
    std::vector<std::uint32_t> units;
    units.reserve(worth.size());
    for (const double w : worth)
        units.push_back(static_cast<std::uint32_t>(std::llround(w * scale)));
    return units;
}

}  // namespace ispace
