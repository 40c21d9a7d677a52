// SPDX-License-Identifier: GPL-3.0-or-later
// Palettes: series by Okabe and Ito (Color universal design, 2008), told apart by all kinds of
// colour vision; turbo (A. Mikhailov, Google, 2019) by the polynomials of R. Du. Lightness weighs
// the components as Rec. 709 does, without their gamma.
#include "drawing/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace ispace {

Color mixed(Color a, Color b, double share) {
    const auto mix = [share](double from, double to) { return from + share * (to - from); };
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue), a.alpha};
}

std::string cssColor(Color color) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string out = "#";
    const auto add = [&](double part) {
        const auto value = static_cast<std::size_t>(std::lround(std::clamp(part, 0.0, 1.0) * 255));
        out += kDigits[value / 16];
        out += kDigits[value % 16];
    };
    for (const double part : {color.red, color.green, color.blue}) add(part);
    if (color.alpha < 1) add(color.alpha);
    return out;
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

Color rampColor(std::span<const std::uint32_t> stops, double share) {
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    return mixed(Color::rgb(stops[below]), Color::rgb(stops[below + 1]),
                 place - static_cast<double>(below));
}

Color turboColor(double share) {
    const auto channel = [share](double c0, double c1, double c2, double c3, double c4, double c5) {
        const double value =
            c0 + share * (c1 + share * (c2 + share * (c3 + share * (c4 + share * c5))));
        return std::clamp(value, 0.0, 1.0);
    };
    return {channel(0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943),
            channel(0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604),
            channel(0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973),
            1};
}

Color sequentialColor(int level, int levels) {
    constexpr std::array<std::uint32_t, 5> kStops = {0xBFD8EC, 0x94C1DF, 0x62A3CF, 0x347FBA,
                                                     0x174F8C};
    // Schemes of few levels stay in the light half, on which lines and labels are readable.
    const double top = std::min(1.0, 0.25 * levels);
    const double share =
        levels <= 1 ? 0.25 : top * (std::clamp(level, 1, levels) - 1) / (levels - 1);
    return rampColor(kStops, share);
}

}  // namespace ispace
