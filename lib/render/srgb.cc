// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "render/render.h"

namespace ispace {

namespace {

/// sRGB of a value from 0 to 1.
std::uint8_t srgb(float linear) {
    const float x = std::clamp(linear, 0.0F, 1.0F);
    const float y = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255 * y));
}

}  // namespace

std::array<std::uint8_t, 3> toSrgb8(const Rgb& color) {
    return {srgb(color[0]), srgb(color[1]), srgb(color[2])};
}

std::vector<std::uint8_t> toSrgb8(const Rendering& picture, double exposure) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * picture.radiance.size());
    // Straight up to the knee, then towards white.
    const auto roll = [](float x) {
        constexpr float kKnee = 0.8F;
        return x <= kKnee ? x : 1 - (1 - kKnee) * std::exp(-(x - kKnee) / (1 - kKnee));
    };
    for (const Rgb& color : picture.radiance)
        for (const float value : color)
            bytes.push_back(srgb(roll(static_cast<float>(exposure) * value)));
    return bytes;
}

}  // namespace ispace
