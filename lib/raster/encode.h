// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace ispace {

// Pictures as files, row by row from the top. The same samples give the same bytes, and nothing but
// the picture is in them: no time, no program.

/// An 8-bit PNG of red, green and blue bytes. \pre 3 columns * rows samples
std::string pngOfRgb(int columns, int rows, std::span<const std::uint8_t> samples);

/// A 16-bit grey PNG. \pre columns * rows samples
std::string pngOfGrey16(int columns, int rows, std::span<const std::uint16_t> samples);

/// A JPEG of red, green and blue bytes, by OpenCV's imgcodecs, which is opened on demand as
/// decodePicture() does. \param quality 1 to 100 \throws FormatError if that
/// cannot be opened (with what to install), or the picture is wider or higher than 65500 pixels
std::string jpegOfRgb(int columns, int rows, std::span<const std::uint8_t> samples,
                      int quality = 95);

}  // namespace ispace
