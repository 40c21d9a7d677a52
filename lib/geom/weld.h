// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ispace {

/// A place as mesh files hold it.
using FloatPlace = std::array<float, 3>;

/// For each place the index of the first one that is equal to it (0 and -0 are). A place with a NaN
/// equals none and is its own. Linear time whatever the places are: those who choose them cannot
/// know how they are hashed. \pre fewer than 2^32 - 1 places
std::vector<std::uint32_t> firstAtPlace(std::span<const FloatPlace> places);

}  // namespace ispace
