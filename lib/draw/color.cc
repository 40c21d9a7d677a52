// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ispace {

Color mixed(Color a, Color b, double share) {
    const auto mix = [share](double from, double to) { return from + share * (to - from); };
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue), a.alpha};
}

Color seriesColor(std::size_t index) {
    constexpr std::array<std::uint32_t, kSeriesColors> kOkabeIto = {
        0xD55E00,  // vermilion
        0x009E73,  // bluish green
        0xCC79A7,  // reddish purple
        0x0072B2,  // blue
        0xE69F00,  // orange
        0x000000,  // black
        0x56B4E9,  // sky blue
    };
    return Color::rgb(kOkabeIto[index % kSeriesColors]);
}

Color tint(Color color, double share) { return mixed(Color::rgb(0xFFFFFF), color, share); }

double lightness(Color color) {
    return 0.2126 * color.red + 0.7152 * color.green + 0.0722 * color.blue;
}

Color sequentialColor(int level, int levels) {
    constexpr std::array<std::uint32_t, 5> kStops = {0xBFD8EC, 0x94C1DF, 0x62A3CF, 0x347FBA,
                                                     0x174F8C};
    // Few levels keep to the light half, where lines and labels on top stay readable.
    const double top = std::min(1.0, 0.25 * levels);
    const double share =
        levels <= 1 ? 0.25 : top * (std::clamp(level, 1, levels) - 1) / (levels - 1);
    const double place = share * (kStops.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
    return mixed(Color::rgb(kStops[below]), Color::rgb(kStops[below + 1]),
                 place - static_cast<double>(below));
}

}  // namespace ispace
