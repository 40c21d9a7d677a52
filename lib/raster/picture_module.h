// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "raster/picture.h"

namespace ispace {

/// Pictures with more pixels are refused before they are decoded.
constexpr std::int64_t kMaxDecodedPixels = 100'000'000;

/// What a picture is that OpenCV reads and neither parsePng nor parsePgm does ("JPEG", "BMP", …);
/// "" for others.
std::string foreignPicture(std::string_view bytes);

/// Reads such a picture through the module `lib/ispace/pictures.so` beside the program, which is
/// opened for that alone: it brings OpenCV's imgcodecs, and 140 libraries, along. Grey becomes
/// three equal colours, 16 bits become 8.
/// \throws FormatError: damaged, too large, or the module cannot be opened (with what to install)
Picture decodePicture(std::string_view bytes, const std::string& name);

}  // namespace ispace
