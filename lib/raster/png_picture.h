// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "raster/picture.h"

namespace ispace {

/// Larger PNG pictures are refused before anything is allocated: they compress a thousandfold.
constexpr std::int64_t kMaxPngPixels = 100'000'000;

bool isPng(std::string_view bytes);

/// Reads a PNG picture of any kind; colours with 16 bits are rounded to eight. What the file says
/// of its colour space (gAMA, iCCP, …) does not count: maps store values, not colours.
/// The result's max_value is 765 = 3 * 255.
/// \throws FormatError: no PNG, damaged, too large
Picture parsePng(std::string_view bytes, const std::string& name);

}  // namespace ispace
