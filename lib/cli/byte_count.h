// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes of memory and files as options take them.
#pragma once

#include <cstdint>
#include <string>

namespace ispace {

/// `500M`, `2G`, `1.5GB`: powers of 1024, any case. \throws UsageError
std::uint64_t byteCount(const std::string& text);

/// `16G`, `512M`, or the number of bytes: the largest unit that leaves a whole number.
std::string byteCountText(std::uint64_t bytes);

}  // namespace ispace
