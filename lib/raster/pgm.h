// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "raster/picture.h"

namespace ispace {

/// Pictures with more pixels are refused before anything is allocated.
constexpr std::int64_t kMaxPgmPixels = 400'000'000;

/// Reads a PGM picture: P2 (text) or P5 (one byte a sample, or two, big-endian, where the maximum
/// is above 255), with comments in the header, and nothing behind the last sample.
/// \param name the picture's file, for messages
/// \throws FormatError
Picture parsePgm(std::string_view bytes, const std::string& name);

}  // namespace ispace
