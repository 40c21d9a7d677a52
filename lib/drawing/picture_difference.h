// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace ispace {

/// What two PNGs differ in: size, or more than one pixel in five hundred that is another colour by
/// more than another release of a library shades its rims; "" if nothing.
std::string pictureDifference(const std::string& expected_png, const std::string& actual_png);

}  // namespace ispace
