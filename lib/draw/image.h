// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// The pixels of a picture, opaque, from the upper left corner row by row.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;  ///< 0xRRGGBB

    /// \pre the place lies in the picture
    [[nodiscard]] std::uint32_t at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// Reads a PNG back, e.g. to look at what was drawn; transparency counts as black.
/// \throws FormatError if the bytes are no whole PNG
Image decodePng(std::string_view bytes);
std::string encodePng(const Image& image);

}  // namespace ispace
