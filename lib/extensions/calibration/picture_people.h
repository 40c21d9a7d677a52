// SPDX-License-Identifier: GPL-3.0-or-later
// People in the pictures of a fixed camera.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "raster/picture.h"

namespace ispace::calibration {

/// What differs from the picture without people, as one body: rows and columns of pixel centres.
struct PictureBody {
    double left = 0, right = 0, top = 0, bottom = 0;  ///< of the outermost pixels
    double head = 0;  ///< mean column of its upper eighth, if it is upright
    std::size_t pixels = 0;
    bool meets_edge = false;  ///< of the picture, so that its outline is not whole
    /// Higher than wide: the head is on top.
    [[nodiscard]] bool isUpright() const { return bottom - top > 1.5 * (right - left); }
};

/// The bodies in each picture, the largest first.
///
/// The background is the median of up to kBackgrounds pictures over the whole time, of fewer if
/// they are larger than 3 megapixels. A pixel is of a
/// body if its colour differs from the background by brightness or chromaticity; one that is darker
/// alone is in shadow (Horprasert, Harwood and Davis, A statistical approach for real-time robust
/// background subtraction and shadow detection, 1999): shadows belong to no body. Neither do bodies
/// of less than a few dozen pixels. People at rest in half of the pictures are background.
///
/// O(pixels) a picture; 256 MB of pictures in memory, but nine at least.
/// \param picture returns a picture by its number; called twice for some
/// \throws FormatError for pictures of different sizes, and what `picture` throws
std::vector<std::vector<PictureBody>> bodiesInPictures(
    std::size_t pictures, const std::function<ColorPicture(std::size_t)>& picture);

constexpr std::size_t kBackgrounds = 31;

}  // namespace ispace::calibration
