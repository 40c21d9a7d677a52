// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ispace {

/// sRGB with opacity, each 0..1.
struct Color {
    double red = 0, green = 0, blue = 0, alpha = 1;

    /// From 0xRRGGBB.
    static constexpr Color rgb(std::uint32_t hex) {
        const auto part = [hex](unsigned shift) {
            return static_cast<double>((hex >> shift) & 0xFFU) / 255;
        };
        return {part(16), part(8), part(0), 1};
    }
    /// The same colour at another opacity.
    [[nodiscard]] constexpr Color faded(double opacity) const {
        return {red, green, blue, opacity};
    }
    friend bool operator==(const Color&, const Color&) = default;
};

/// Number of distinct colours of seriesColor().
constexpr std::size_t kSeriesColors = 7;

/// Colour of the i-th thing of a kind: the palette of Okabe and Ito, which people with any colour
/// vision tell apart, without its yellow, too pale on white; it repeats after kSeriesColors.
Color seriesColor(std::size_t index);

/// Of the two, mixed as they stand: `share` of `b`, 0..1; opacity of `a`.
Color mixed(Color a, Color b, double share);

/// `share` of the colour on white.
Color tint(Color color, double share);

/// How light a colour looks, 0..1: what is left of it in grey (luma of BT.709).
double lightness(Color color);

/// Between colours (0xRRGGBB) at equal distances: 0 is the first, 1 the last. \pre two stops or
/// more
Color rampColor(std::span<const std::uint32_t> stops, double share);

/// The Turbo colour map (A. Mikhailov, Google 2019) in R. Du's polynomials: 0 is dark blue, 1 dark
/// red.
Color turboColor(double share);

/// Step `level` (1..levels) of a scheme from light to dark blue: lightness falls with each level,
/// so that it reads in grey as well; the first is well below white.
Color sequentialColor(int level, int levels);

}  // namespace ispace
