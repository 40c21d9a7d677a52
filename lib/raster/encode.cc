// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/encode.h"

#include <png.h>
#include <zlib.h>

#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstddef>
#include <new>
#include <stdexcept>
#include <vector>

namespace ispace {

namespace {

void appendBytes(png_structp png, png_bytep bytes, std::size_t size) {
    bool full = false;
    try {
        static_cast<std::string*>(png_get_io_ptr(png))
            ->append(reinterpret_cast<const char*>(bytes), size);
    } catch (const std::bad_alloc&) {
        full = true;
    }
    if (full) png_error(png, "out of memory");
}

void flushNothing(png_structp) {}

/// libpng's writer of one picture.
struct Writer {
    png_structp png = nullptr;
    png_infop info = nullptr;

    Writer() {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
        if (png != nullptr) info = png_create_info_struct(png);
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { png_destroy_write_struct(&png, &info); }
};

/// What makes a picture small quickly.
struct Compression {
    int filter, level, strategy;
};

/// Noise has runs to find once neighbours are told from each other, but no repetitions: several
/// times as fast as zlib's own way, and smaller.
constexpr Compression kOfShades{PNG_FILTER_PAETH, 1, Z_RLE};
/// Levels below 4 take the first repetition they find, which makes maps a quarter larger.
constexpr Compression kOfDrawings{PNG_FILTER_NONE, 4, Z_DEFAULT_STRATEGY};

/// What is written: rows as the file has them, or pixels of 4 bytes, blue first.
struct Samples {
    png_uint_32 columns = 0, rows = 0;
    int depth = 8, color = PNG_COLOR_TYPE_RGB;
    bool are_pixels = false;
    Compression compression = kOfShades;
    std::size_t row_bytes = 0;
    const std::uint8_t* bytes = nullptr;
};

/// Nothing here has a destructor: libpng leaves by longjmp. False if something failed.
bool writeRows(png_structp png, png_infop info, const Samples& samples) {
    constexpr std::size_t kPiece = std::size_t{1} << 16U;
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, info, samples.columns, samples.rows, samples.depth, samples.color,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, samples.compression.filter);
    png_set_compression_level(png, samples.compression.level);
    png_set_compression_strategy(png, samples.compression.strategy);
    png_set_compression_buffer_size(png, kPiece);
    png_write_info(png, info);
    if (samples.are_pixels) {
        png_set_filler(png, 0, PNG_FILLER_AFTER);
        png_set_bgr(png);
    }
    for (std::size_t row = 0; row < samples.rows; ++row)
        png_write_row(png, samples.bytes + row * samples.row_bytes);
    png_write_end(png, nullptr);
    return true;
}

std::string encode(const Samples& samples) {
    std::string bytes;
    const Writer writer;
    if (writer.info == nullptr) throw std::bad_alloc();
    png_set_write_fn(writer.png, &bytes, appendBytes, flushNothing);
    if (!writeRows(writer.png, writer.info, samples))
        throw std::runtime_error("a picture cannot be written as PNG");
    return bytes;
}

}  // namespace

namespace {

std::string encodePixels(int columns, int rows, std::span<const std::uint32_t> pixels,
                         std::size_t stride, const Compression& compression) {
    static_assert(std::endian::native == std::endian::little);
    assert(rows == 0 || pixels.size() >= stride * (static_cast<std::size_t>(rows) - 1) +
                                             static_cast<std::size_t>(columns));
    return encode({.columns = static_cast<png_uint_32>(columns),
                   .rows = static_cast<png_uint_32>(rows),
                   .are_pixels = true,
                   .compression = compression,
                   .row_bytes = stride * sizeof(std::uint32_t),
                   .bytes = reinterpret_cast<const std::uint8_t*>(pixels.data())});
}

}  // namespace

std::string pngOfRgb(int columns, int rows, std::span<const std::uint8_t> samples) {
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(columns);
    assert(samples.size() == row_bytes * static_cast<std::size_t>(rows));
    return encode({.columns = static_cast<png_uint_32>(columns),
                   .rows = static_cast<png_uint_32>(rows),
                   .row_bytes = row_bytes,
                   .bytes = samples.data()});
}

std::string pngOfShades(int columns, int rows, std::span<const std::uint32_t> pixels) {
    return encodePixels(columns, rows, pixels, static_cast<std::size_t>(columns), kOfShades);
}

std::string pngOfDrawing(int columns, int rows, std::span<const std::uint32_t> pixels,
                         std::size_t stride) {
    return encodePixels(columns, rows, pixels, stride, kOfDrawings);
}

std::string pngOfGrey16(int columns, int rows, std::span<const std::uint16_t> samples) {
    static_assert(std::endian::native == std::endian::little);
    std::vector<std::uint16_t> swapped;
    swapped.reserve(samples.size());
    for (const std::uint16_t sample : samples)
        swapped.push_back(static_cast<std::uint16_t>(sample << 8U | sample >> 8U));
    return encode({.columns = static_cast<png_uint_32>(columns),
                   .rows = static_cast<png_uint_32>(rows),
                   .depth = 16,
                   .color = PNG_COLOR_TYPE_GRAY,
                   .row_bytes = 2 * static_cast<std::size_t>(columns),
                   .bytes = reinterpret_cast<const std::uint8_t*>(swapped.data())});
}

}  // namespace ispace
