// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/encode.h"

#include <libdeflate.h>
#include <png.h>
#include <zlib.h>

#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>
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

/// Appends a chunk of a PNG file. \pre content of less than 2^31 bytes
void appendChunk(std::string_view type, std::string_view content, std::string& file) {
    const auto append_number = [&file](std::uint32_t number) {
        for (unsigned shift = 32; shift > 0; shift -= 8)
            file.push_back(static_cast<char>(number >> (shift - 8) & 0xFFU));
    };
    append_number(static_cast<std::uint32_t>(content.size()));
    const std::size_t begin = file.size();
    file.append(type).append(content);
    append_number(libdeflate_crc32(0, file.data() + begin, file.size() - begin));
}

/// The beginning of the file up to its header.
std::string pngBegin(int columns, int rows) {
    std::string header;
    for (const int extent : {columns, rows})
        for (int shift = 24; shift >= 0; shift -= 8)
            header.push_back(static_cast<char>(extent >> shift & 0xFF));
    header += {8, PNG_COLOR_TYPE_RGB, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT,
               PNG_INTERLACE_NONE};
    std::string file("\x89PNG\r\n\x1a\n", 8);
    appendChunk("IHDR", header, file);
    return file;
}

/// Rows as a PNG file has them, each after the number of its filter: none.
void writeRows(std::size_t columns, std::size_t rows, std::span<const std::uint32_t> pixels,
               std::size_t stride, std::uint8_t* to) {
    for (std::size_t row = 0; row < rows; ++row) {
        *to++ = PNG_FILTER_VALUE_NONE;
        for (const std::uint32_t pixel : pixels.subspan(row * stride, columns)) {
            *to++ = static_cast<std::uint8_t>(pixel >> 16U);
            *to++ = static_cast<std::uint8_t>(pixel >> 8U);
            *to++ = static_cast<std::uint8_t>(pixel);
        }
    }
}

/// By libdeflate, which wants all bytes at once: smaller than zlib makes drawings at level 4, in
/// two thirds of the time.
std::string encodeWhole(int columns, int rows, std::span<const std::uint32_t> pixels,
                        std::size_t stride) {
    constexpr int kLevel = 5;
    const auto across = static_cast<std::size_t>(columns), down = static_cast<std::size_t>(rows);
    const std::size_t all = down * (1 + 3 * across);
    const auto bytes = std::make_unique_for_overwrite<std::uint8_t[]>(all);
    writeRows(across, down, pixels, stride, bytes.get());
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    const std::size_t most = libdeflate_zlib_compress_bound(compressor.get(), all);
    const auto packed = std::make_unique_for_overwrite<char[]>(most);
    const std::size_t size =
        libdeflate_zlib_compress(compressor.get(), bytes.get(), all, packed.get(), most);
    std::string file = pngBegin(columns, rows);
    appendChunk("IDAT", {packed.get(), size}, file);
    appendChunk("IEND", {}, file);
    return file;
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
    constexpr double kMostBytes = 64e6;  // of a picture that is held as a whole once more
    if (columns > 0 && rows > 0 && 3.0 * columns * rows <= kMostBytes)
        return encodeWhole(columns, rows, pixels, stride);
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
