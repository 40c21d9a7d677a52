// SPDX-License-Identifier: GPL-3.0-or-later
// Data exchanged between lib/kernel/raster and the code that links OpenCV: a program that decodes,
// and a module that encodes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/confined.h"

namespace ispace {

/// A picture as OpenCV decodes it.
struct DecodedPicture {
    int width = 0, height = 0;
    int channels = 0;                   ///< 1 grey, 3 colours, 4 colours and opacity
    std::vector<std::uint8_t> samples;  ///< row by row from the top
};

/// Head of the answer of lib/ispace/read-picture: width, height and channels; the samples follow.
using PackedHead = std::array<std::int32_t, 3>;

/// Returns the limits of that program for pictures of so many pixels, of 16 bits a sample at most:
/// OpenCV and its libraries take some 600 MB of addresses.
inline ConfinedLimits pictureLimits(std::size_t pixels) {
    constexpr std::size_t kBase = std::size_t{2} << 30U, kBytes = 40, kPixelsASecond = 2'000'000;
    return {kBase + kBytes * pixels, 20 + pixels / kPixelsASecond};
}

/// Input and output of the JPEG encoder, three bytes per pixel.
struct JpegPicture {
    int width = 0, height = 0, quality = 95;
    const std::uint8_t* samples = nullptr;  ///< red, green, blue, row by row
    std::vector<std::uint8_t> bytes;        ///< of the file
    std::string error;                      ///< "" on success
};

/// The function of the module; never throws, never prints.
using JpegEncoder = void(JpegPicture& picture);
constexpr const char* kJpegEncoder = "ispaceEncodeJpeg";

}  // namespace ispace
