// SPDX-License-Identifier: GPL-3.0-or-later
// For golden tests of pictures, which see other edges of letters on each release of Cairo.
#pragma once

#include <string>

namespace ispace {

/// Compares two PNGs and returns their difference: size, or more than this share of pixels with a
/// colour that differs by more than the antialiasing of another library release; "" if they agree.
std::string pictureDifference(const std::string& expected_png, const std::string& actual_png,
                              double share = 1.0 / 500);

}  // namespace ispace
