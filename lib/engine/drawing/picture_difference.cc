// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/picture_difference.h"

#include <cstdint>
#include <cstdlib>

#include "drawing/drawing.h"

namespace ispace {

std::string pictureDifference(const std::string& expected_png, const std::string& actual_png,
                              double share) {
    const Image expected = decodePng(expected_png);
    const Image actual = decodePng(actual_png);
    if (expected.width != actual.width || expected.height != actual.height)
        return std::to_string(actual.width) + " x " + std::to_string(actual.height) +
               " pixels, expected " + std::to_string(expected.width) + " x " +
               std::to_string(expected.height);
    constexpr int kShade = 48;
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        bool is_other = false;
        for (const int shift : {0, 8, 16}) {
            const auto channel = [shift](std::uint32_t rgb) {
                return static_cast<int>((rgb >> shift) & 0xFFU);
            };
            is_other = is_other ||
                       std::abs(channel(expected.pixels[i]) - channel(actual.pixels[i])) > kShade;
        }
        if (is_other && count++ == 0) first = i;
    }
    if (static_cast<double>(count) <= share * static_cast<double>(expected.pixels.size()))
        return "";
    const auto width = static_cast<std::size_t>(expected.width);
    return std::to_string(count) + " pixels, the first at " + std::to_string(first % width) + ", " +
           std::to_string(first / width);
}

}  // namespace ispace
