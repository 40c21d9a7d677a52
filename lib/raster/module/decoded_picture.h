// SPDX-License-Identifier: GPL-3.0-or-later
// What lib/io and the module that links OpenCV say to each other.
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

}  // namespace ispace
