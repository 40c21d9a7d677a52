// SPDX-License-Identifier: GPL-3.0-or-later
// Encodes pictures as files, row by row from the top. The same samples give the same bytes: files
// contain no time and no program name. Every PNG of ispace is written here, by libpng or
// libdeflate, with settings for its content: fast, and about as small as with libpng's own choice
// of filters, which takes several times as long. Functions are thread-safe, and single-threaded.
//
//     writeAll("view.png", pngOfRgb(640, 480, toSrgb8(picture)));
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ispace {

/// Creates an 8-bit PNG of a camera picture: shades and noise, in which neighbours are similar and
/// patterns do not repeat. Red, green and blue bytes.
/// \pre 3 columns * rows samples
std::string pngOfRgb(int columns, int rows, std::span<const std::uint8_t> samples);

/// Creates the same from pixels 0xRRGGBB; the highest byte is ignored.
/// \pre columns * rows pixels
std::string pngOfShades(int columns, int rows, std::span<const std::uint32_t> pixels);

/// Creates an 8-bit PNG of a drawing: lines, text and areas of one colour, which repeat. Pixels
/// 0xRRGGBB as above, each row `stride` pixels behind the one before.
/// \pre stride * (rows - 1) + columns pixels
std::string pngOfDrawing(int columns, int rows, std::span<const std::uint32_t> pixels,
                         std::size_t stride);

/// Creates a 16-bit grey PNG.
/// \pre columns * rows samples
std::string pngOfGrey16(int columns, int rows, std::span<const std::uint16_t> samples);

/// Creates a JPEG of red, green and blue bytes, by the module `lib/ispace/pictures.so` beside the
/// program, opened on demand because OpenCV's imgcodecs loads 140 more libraries.
/// \param quality 1 to 100
/// \throws FormatError if the module cannot be opened (with the package to install), or the picture
///         is wider or higher than 65500 pixels
std::string jpegOfRgb(int columns, int rows, std::span<const std::uint8_t> samples,
                      int quality = 95);

/// Finds a symbol in a module, a shared object in lib/ispace beside the program, which is opened
/// here and stays open: as a link dependency it would slow down the start of every run, though few
/// require it. Returns null if it cannot be opened, with the reason in `error`.
void* moduleSymbol(const char* module, const char* symbol, std::string& error);

}  // namespace ispace
