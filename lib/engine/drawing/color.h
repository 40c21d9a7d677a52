// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of pictures: chosen so that people with any colour vision, and readers of a grey print,
// tell classes apart. Maps of categories use Okabe and Ito's palette (Color universal design,
// 2008), maps of order fall in lightness with each step. Pure functions.
//
//     const std::string stroke = cssColor(seriesColor(2));
//     const std::string fill = cssColor(seriesColor(2).faded(0.3));
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ispace {

/// An sRGB colour with opacity, each 0..1.
struct Color {
    double red = 0, green = 0, blue = 0, alpha = 1;

    /// Converts 0xRRGGBB.
    static constexpr Color rgb(std::uint32_t hex) {
        const auto part = [hex](unsigned shift) {
            return static_cast<double>((hex >> shift) & 0xFFU) / 255;
        };
        return {part(16), part(8), part(0), 1};
    }
    /// Returns the same colour with another opacity.
    [[nodiscard]] constexpr Color faded(double opacity) const {
        return {red, green, blue, opacity};
    }
    friend bool operator==(const Color&, const Color&) = default;
};

/// Formats the colour for CSS: "#1f2328", with two more digits if it is translucent.
std::string cssColor(Color color);

/// Number of distinct colours of seriesColor().
constexpr std::size_t kSeriesColors = 7;

/// Returns the i-th colour of a series: the palette of Okabe and Ito, which people with any colour
/// vision can distinguish, without its yellow, too pale on white; it repeats after kSeriesColors.
Color seriesColor(std::size_t index);

/// Mixes two colours in sRGB: `share` of `b`, 0..1; opacity of `a`.
Color mixed(Color a, Color b, double share);

/// Returns `share` of the colour mixed with white.
Color tint(Color color, double share);

/// Computes the lightness of a colour in grey, 0..1 (luma of BT.709).
double lightness(Color color);

/// Interpolates between colours (0xRRGGBB) at equal distances: 0 is the first, 1 the last. \pre two
/// stops or more
Color rampColor(std::span<const std::uint32_t> stops, double share);

/// Computes the Turbo colour map (A. Mikhailov, Google 2019) by R. Du's polynomials: 0 is dark
/// blue, 1 dark red.
Color turboColor(double share);

/// Returns step `level` (1..levels) of a scheme from light to dark blue: lightness falls with each
/// level, which stays readable in grey; the first is well below white.
Color sequentialColor(int level, int levels);

/// Colours of all pictures except of data and materials. Unseen floor is the lightest, so that seen
/// floor is distinct in grey, too.
namespace palette {
constexpr Color kInk = Color::rgb(0x1F2328);
constexpr Color kFaintInk = Color::rgb(0x57606A);
constexpr Color kWhite = Color::rgb(0xFFFFFF);
constexpr Color kGrid = Color::rgb(0x7A8794);

constexpr Color kFloor = Color::rgb(0xFBF5E9);
constexpr Color kOutside = Color::rgb(0xE4E4E4);
constexpr Color kOutsideHatch = Color::rgb(0xB4B4B4);
constexpr Color kWall = Color::rgb(0x24292F);
constexpr Color kLowWall = Color::rgb(0xB9BDC1);
constexpr Color kGlass = Color::rgb(0x2F7EA8);
constexpr Color kDoor = Color::rgb(0x7A5230);

constexpr Color kSensor = Color::rgb(0xB3261E);
constexpr Color kRobot = Color::rgb(0x8E2C2C);
constexpr Color kPerson = Color::rgb(0x33507A);
constexpr Color kMat = Color::rgb(0x2F6B45);

// Below an overlay, which is coloured.
constexpr Color kOpening = Color::rgb(0xA39B90);
constexpr Color kSolid = Color::rgb(0x7D746B);
constexpr Color kSolidEdge = Color::rgb(0x4A443E);
constexpr Color kObject = Color::rgb(0xE2D9CD);
constexpr Color kObjectEdge = Color::rgb(0x9A9085);
constexpr Color kZone = Color::rgb(0x6E3A8E);

/// Floor that several sensors see, below the stripes in their colours.
constexpr Color kShared = Color::rgb(0xD4D4D4);
constexpr Color kSharedHatch = Color::rgb(0x6B6B6B);
/// Colours of comparisons: blue and orange, distinct for any colour vision; in grey the hatch
/// identifies them.
constexpr Color kBoth = Color::rgb(0xC3CDD8);
constexpr Color kGained = Color::rgb(0x4A96C9);
constexpr Color kLost = Color::rgb(0xF3B562);
constexpr Color kLostHatch = Color::rgb(0x9C4A00);
constexpr Color kOtherSensor = Color::rgb(0x6E7781);
}  // namespace palette

}  // namespace ispace
