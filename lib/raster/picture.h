// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// A picture in shades of grey; row 0 is the top row, as in the file.
struct Picture {
    int width = 0, height = 0;
    int max_value = 255;                 ///< white; 1 .. 65535
    std::vector<std::uint16_t> samples;  ///< width * height, row by row, none above max_value.
                                         ///< Of coloured pictures the sum of red, green and blue
    std::vector<std::uint8_t> opacity;   ///< 0 .. 255 for each sample; empty: all opaque
};

/// True if the bytes begin like a picture that parsePicture reads.
bool isPicture(std::string_view bytes);

/// Reads a picture, told apart by content: PNG, PGM, and through OpenCV JPEG, BMP, TIFF, WebP, PBM
/// and PPM.
/// \param name the picture's file, for messages
/// \throws FormatError
Picture parsePicture(std::string_view bytes, const std::string& name);

}  // namespace ispace
