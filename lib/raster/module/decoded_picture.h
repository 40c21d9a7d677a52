// SPDX-License-Identifier: GPL-3.0-or-later
// What lib/raster and the module that links OpenCV say to each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ispace {

/// A picture as OpenCV decodes it.
struct DecodedPicture {
    int width = 0, height = 0;
    int channels = 0;                   ///< 1 grey, 3 colours, 4 with opacity behind them
    std::vector<std::uint8_t> samples;  ///< row by row from the top
    std::string error;                  ///< why there is none; "": there is one
};

/// The function of the module; never throws, never prints.
using PictureDecoder = void(const std::uint8_t* bytes, std::size_t size, DecodedPicture& out);
constexpr const char* kPictureDecoder = "ispaceDecodePicture";

/// Three bytes a pixel as JPEG.
struct JpegPicture {
    int width = 0, height = 0, quality = 95;
    const std::uint8_t* samples = nullptr;  ///< red, green, blue, row by row
    std::vector<std::uint8_t> bytes;        ///< of the file
    std::string error;                      ///< why there are none; "": there are
};

/// The other function of the module; likewise.
using JpegEncoder = void(JpegPicture& picture);
constexpr const char* kJpegEncoder = "ispaceEncodeJpeg";

}  // namespace ispace
