// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ispace {

// Pictures as files, row by row from the top. The same samples give the same bytes, and nothing but
// the picture is in them: no time, no program. Every PNG of ours is written here, by libpng or
// libdeflate, in a way that suits what is on it: quick, and about as small as libpng's own choice
// of filters makes it in several times the time.

/// An 8-bit PNG of what a camera sees: shades and noise, so that neighbours are alike and nothing
/// repeats. Red, green and blue bytes. \pre 3 columns * rows samples
std::string pngOfRgb(int columns, int rows, std::span<const std::uint8_t> samples);

/// The same of pixels 0xRRGGBB; the highest byte does not count. \pre columns * rows pixels
std::string pngOfShades(int columns, int rows, std::span<const std::uint32_t> pixels);

/// An 8-bit PNG of a drawing: lines, text and areas of one colour, which repeat. Pixels 0xRRGGBB as
/// above, each row `stride` pixels behind the one before. \pre stride * (rows - 1) + columns pixels
std::string pngOfDrawing(int columns, int rows, std::span<const std::uint32_t> pixels,
                         std::size_t stride);

/// A 16-bit grey PNG. \pre columns * rows samples
std::string pngOfGrey16(int columns, int rows, std::span<const std::uint16_t> samples);

/// A JPEG of red, green and blue bytes, by the module `lib/ispace/pictures.so` beside the program,
/// opened on demand because OpenCV's imgcodecs loads 140 more libraries. \param quality 1 to 100
/// \throws FormatError if that cannot be opened (with what to install), or the picture is wider or
/// higher than 65500 pixels
std::string jpegOfRgb(int columns, int rows, std::span<const std::uint8_t> samples,
                      int quality = 95);

/// What has this name in a module, a shared object in lib/ispace beside the program, which is
/// opened here and stays open: what few runs need would cost each of them its start. Null where it
/// cannot be opened; then `error` says why.
void* moduleSymbol(const char* module, const char* symbol, std::string& error);

}  // namespace ispace
