// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// A grey picture; row 0 is the top row, as in the file.
struct Pgm {
    int width = 0, height = 0;
    int max_value = 255;                 ///< white; 1 .. 65535
    std::vector<std::uint16_t> samples;  ///< width * height, row by row, none above max_value
};

/// Pictures with more pixels are refused before anything is allocated.
constexpr std::int64_t kMaxPgmPixels = 1'000'000'000;

/// Reads a PGM picture: P2 (text) or P5 (one byte a sample, or two, big-endian, where the maximum
/// is above 255), with comments in the header, and nothing behind the last sample.
/// \param name the picture's file, for messages
/// \throws FormatError
Pgm parsePgm(std::string_view bytes, const std::string& name);

}  // namespace ispace
