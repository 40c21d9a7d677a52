// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures as inputs: maps of robots and textures. Files are untrusted: sizes are checked before
// memory is allocated, and formats that only OpenCV reads are decoded by a process without rights
// (base/confined.h). PNG and PGM give the same samples on every machine; those of JPEG and other
// lossy formats depend on the installed OpenCV.
//
//     const GreyPicture picture = parsePicture(readAll("map.pgm"), "map.pgm");
//     const MapCells walls = occupiedCells(picture, OccupancyRule());
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "raster/cells.h"

namespace ispace {

/// A picture in shades of grey; row 0 is the top row, as in the file.
struct GreyPicture {
    int width = 0, height = 0;
    int max_value = 255;                 ///< white; 1 .. 65535
    std::vector<std::uint16_t> samples;  ///< width * height, row by row, at most max_value.
                                         ///< Of coloured pictures the sum of red, green and blue
    std::vector<std::uint8_t> opacity;   ///< 0 .. 255 for each sample; empty: all opaque
};

/// Returns true if the bytes start like a picture that parsePicture() reads.
bool isPicture(std::string_view bytes);

/// Reads a picture, detecting the format by content: PNG, PGM, and through OpenCV JPEG, BMP, TIFF,
/// WebP, PBM and PPM.
/// \param name the picture's file, for messages
/// \throws FormatError
GreyPicture parsePicture(std::string_view bytes, const std::string& name);

class ConfinedReader;

/// A coloured picture, row 0 on top: red, green, blue and opacity of each pixel.
struct ColorPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Larger coloured pictures are rejected before they are decoded.
constexpr std::int64_t kMaxColorPixels = 40'000'000;

/// Reads the same formats with their colours. \param reader decodes all pictures that OpenCV reads
/// \throws FormatError
ColorPicture parseColorPicture(std::string_view bytes, const std::string& name,
                               ConfinedReader& reader);

/// Pictures with more pixels are rejected before any allocation.
constexpr std::int64_t kMaxPgmPixels = 400'000'000;

/// Reads a PGM picture: P2 (text) or P5 (one byte per sample, or two, big-endian, if the maximum is
/// above 255), with comments in the header, and no bytes after the last sample.
/// \param name the picture's file, for messages
/// \throws FormatError
GreyPicture parsePgm(std::string_view bytes, const std::string& name);

/// Larger PNG pictures are rejected before any allocation: they compress a thousandfold.
constexpr std::int64_t kMaxPngPixels = 100'000'000;

bool isPng(std::string_view bytes);

struct DecodedPicture;
/// Reads the samples of a PNG picture, red first.
/// \throws FormatError
DecodedPicture decodePng(std::string_view bytes, const std::string& name,
                         std::int64_t most = kMaxPngPixels);

/// Reads a PNG picture of any kind; colours with 16 bits are rounded to eight. Colour space
/// information (gAMA, iCCP, …) is ignored: maps store values, not colours. The result's max_value
/// is 765 = 3 * 255.
/// \throws FormatError: no PNG, damaged, too large
GreyPicture parsePng(std::string_view bytes, const std::string& name);

/// Pictures with more pixels are rejected before they are decoded.
constexpr std::int64_t kMaxDecodedPixels = 100'000'000;

/// Returns the format of a picture that only OpenCV reads ("JPEG", "BMP", …); "" for any other.
std::string foreignPicture(std::string_view bytes);

/// Decodes such a picture with OpenCV, in the separate program `lib/ispace/read-picture`, which
/// runs without rights and with limits on memory and time: a picture that makes it crash, grow or
/// hang is reported as a bad file. Grey is converted to three equal colours, 16 bits to 8.
/// \throws FormatError: damaged, too large, or the program cannot be started (with the package to
///         install)
GreyPicture decodePicture(std::string_view bytes, const std::string& name);

/// Mapping of pixels to cells: the keys of map_server's YAML.
struct OccupancyRule {
    enum class Mode {
        Trinary,  ///< by the two thresholds
        Scale,    ///< from 0 to 100 between the thresholds: 0 is free, 100 occupied, others unknown
        Raw,      ///< the pixel (of 255) is the value: 0 free, 100 occupied
    };
    Mode mode = Mode::Trinary;
    bool negate = false;            ///< white is occupied
    double occupied_thresh = 0.65;  ///< occupied if the darkness is above
    double free_thresh = 0.196;     ///< free if the darkness is below
    bool unknown_is_free = false;   ///< of the shade that map_server writes for unknown, 205 of 255
};

enum class Cell : std::uint8_t { Free, Occupied, Unknown };

/// Classifies a sample out of 0 .. max_value. Both comparisons are strict, occupied comes first.
Cell classify(int sample, int max_value, const OccupancyRule& rule);

/// Returns the free or the occupied cells of a map; the picture's top row becomes the highest row.
/// Opacity is treated as map_server does: Trinary averages it with the colours; with Scale, pixels
/// that are not opaque are unknown. Unlike there, opaque pixels of shade 205 are unknown at any
/// thresholds, or free with OccupancyRule::unknown_is_free; not so for Raw and `negate`.
MapCells freeCells(const GreyPicture& image, const OccupancyRule& rule);
MapCells occupiedCells(const GreyPicture& image, const OccupancyRule& rule);

/// Counts the samples of that shade (a darkness of 0.196) that the thresholds alone would classify
/// as free: Nav2 writes a free_thresh of 0.25.
std::size_t unknownCountedFree(const GreyPicture& image, const OccupancyRule& rule);

}  // namespace ispace
