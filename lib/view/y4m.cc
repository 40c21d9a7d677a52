// SPDX-License-Identifier: GPL-3.0-or-later
#include <cassert>
#include <cmath>
#include <cstdint>

#include "view/run_picture.h"

namespace ispace {

// The format: https://wiki.multimedia.cx/index.php/YUV4MPEG2
std::string y4mHeader(int width, int height, double fps) {
    constexpr double kParts = 1000;
    return "YUV4MPEG2 W" + std::to_string(width) + " H" + std::to_string(height) + " F" +
           std::to_string(std::lround(fps * kParts)) + ":1000 Ip A1:1 C420jpeg\n";
}

namespace {

/// ITU-R BT.601 in video range, times 256.
struct Luma {
    int red, green, blue, offset;

    [[nodiscard]] char of(int r, int g, int b) const {
        constexpr int kHalf = 128;
        return static_cast<char>(
            static_cast<std::uint8_t>(((red * r + green * g + blue * b + kHalf) >> 8) + offset));
    }
};
constexpr Luma kY{66, 129, 25, 16}, kCb{-38, -74, 112, 128}, kCr{112, -94, -18, 128};

struct Rgb {
    int red = 0, green = 0, blue = 0;
};

Rgb rgbOf(std::uint32_t pixel) {
    return {static_cast<int>(pixel >> 16U & 255U), static_cast<int>(pixel >> 8U & 255U),
            static_cast<int>(pixel & 255U)};
}

/// The mean of a square of four pixels.
Rgb meanOf(const Image& image, int x, int y) {
    Rgb sum;
    for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
            const Rgb pixel = rgbOf(image.at(x + dx, y + dy));
            sum.red += pixel.red;
            sum.green += pixel.green;
            sum.blue += pixel.blue;
        }
    return {(sum.red + 2) / 4, (sum.green + 2) / 4, (sum.blue + 2) / 4};
}

}  // namespace

std::string y4mFrame(const Image& image) {
    assert(image.width % 2 == 0 && image.height % 2 == 0);
    std::string bytes = "FRAME\n";
    bytes.reserve(bytes.size() + image.pixels.size() * 3 / 2);
    for (const std::uint32_t pixel : image.pixels) {
        const auto [red, green, blue] = rgbOf(pixel);
        bytes += kY.of(red, green, blue);
    }
    for (const Luma& plane : {kCb, kCr})
        for (int y = 0; y < image.height; y += 2)
            for (int x = 0; x < image.width; x += 2) {
                const auto [red, green, blue] = meanOf(image, x, y);
                bytes += plane.of(red, green, blue);
            }
    return bytes;
}

}  // namespace ispace
