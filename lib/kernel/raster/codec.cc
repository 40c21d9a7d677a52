// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/codec.h"

#include <dlfcn.h>
#include <libdeflate.h>
#include <png.h>
#include <zlib.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "raster/module/decoded_picture.h"
#include "raster/picture.h"

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

/// Compression settings: small files, fast.
struct Compression {
    int filter, level, strategy;
};

/// Noise has runs once neighbours are subtracted, but no repetitions: several times as fast as
/// zlib's default strategy, and smaller.
constexpr Compression kOfShades{PNG_FILTER_PAETH, 1, Z_RLE};
/// Levels below 4 take the first repetition they find, which makes maps a quarter larger.
constexpr Compression kOfDrawings{PNG_FILTER_NONE, 4, Z_DEFAULT_STRATEGY};

/// Samples to write: rows as in the file, or pixels of 4 bytes, blue first.
struct Samples {
    png_uint_32 columns = 0, rows = 0;
    int depth = 8, color = PNG_COLOR_TYPE_RGB;
    bool are_pixels = false;
    Compression compression = kOfShades;
    std::size_t row_bytes = 0;
    const std::uint8_t* bytes = nullptr;
};

/// Writes the rows; returns false on failure. No object here has a destructor: libpng leaves by
/// longjmp.
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

/// Returns the beginning of the file up to its header.
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

/// Writes rows in PNG layout, each after its filter number: 0, no filter.
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

/// Compresses by libdeflate, which requires all bytes at once: smaller than zlib at level 4 for
/// drawings, in two thirds of the time.
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
    constexpr double kMaxBytes = 64e6;  // of a picture that is copied as a whole in memory
    if (columns > 0 && rows > 0 && 3.0 * columns * rows <= kMaxBytes)
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

void* moduleSymbol(const char* module, const char* symbol, std::string& error) {
    const std::string path =
        (std::filesystem::path(programPrefix()) / "lib" / "ispace" / module).string();
    void* const opened = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    void* const found = opened == nullptr ? nullptr : ::dlsym(opened, symbol);
    if (found != nullptr) return found;
    const char* const reason = ::dlerror();
    error = reason == nullptr ? path : reason;
    return nullptr;
}

namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kChunkFrame = 12;  // length, type and check sum about a chunk's content
constexpr std::size_t kHeaderLength = 13;

/// Deflate expands a byte to at most 1032.
constexpr std::int64_t kMaxInflation = 1040;

[[noreturn]] void fail(const std::string& name, const std::string& message) {
    throw FormatError(Diagnostic{displayName(name), 0, 0, message});
}

std::int64_t bigEndian(std::string_view bytes) {
    std::int64_t value = 0;
    for (const char c : bytes.substr(0, 4)) value = value * 256 + static_cast<unsigned char>(c);
    return value;
}

/// The chunks of a PNG file that describe its samples.
struct Chunks {
    std::string bytes;      // signature and chunks
    std::string header;     // content of IHDR
    std::int64_t data = 0;  // bytes of IDAT
};

/// Removes chunks of colour spaces and comments.
Chunks plainChunks(std::string_view bytes, const std::string& name) {
    constexpr std::array<std::string_view, 4> kKept{"PLTE", "tRNS", "IDAT", "IEND"};
    Chunks chunks;
    chunks.bytes = kSignature;
    bytes.remove_prefix(kSignature.size());
    for (std::string_view type; type != "IEND";) {
        if (bytes.size() < kChunkFrame) fail(name, "truncated PNG picture");
        const auto length = static_cast<std::size_t>(bigEndian(bytes));
        if (bytes.size() - kChunkFrame < length) fail(name, "truncated PNG picture");
        type = bytes.substr(4, 4);
        const std::string_view content = bytes.substr(8, length);
        const bool is_header = type == "IHDR" && chunks.header.empty();
        if (chunks.header.empty() && (!is_header || length != kHeaderLength))
            fail(name, "bad PNG picture: it does not begin with its header");
        if (is_header) chunks.header = content;
        if (type == "IDAT") chunks.data += static_cast<std::int64_t>(length);
        if (is_header || std::find(kKept.begin(), kKept.end(), type) != kKept.end())
            chunks.bytes += bytes.substr(0, kChunkFrame + length);
        bytes.remove_prefix(kChunkFrame + length);
    }
    return chunks;
}

/// Rejects a picture that is too large, or larger than the file can encode.
void checkSize(const Chunks& chunks, const std::string& name, std::int64_t most) {
    const std::string_view header = chunks.header;
    const std::int64_t width = bigEndian(header), height = bigEndian(header.substr(4));
    const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width > most || height > most || width * height > most)
        fail(name, size + ", wanted at most " + std::to_string(most));
    constexpr std::array<std::int64_t, 7> kChannels{1, 1, 3, 1, 2, 1, 4};  // by colour type
    const auto color = static_cast<std::size_t>(static_cast<unsigned char>(header[9]));
    const std::int64_t channels = color < kChannels.size() ? kChannels[color] : 1;
    const std::int64_t bits = static_cast<unsigned char>(header[8]) * channels * width;
    if (bits / 8 * height > kMaxInflation * chunks.data)
        fail(name, "truncated PNG picture: " + std::to_string(chunks.data) +
                       " bytes of data do not hold " + size);
}

/// Frees the memory that libpng holds beside a picture, also on an exception.
class PngImage {
  public:
    PngImage() { image_.version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(&image_); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;

    png_image* operator->() { return &image_; }
    png_image* get() { return &image_; }

  private:
    png_image image_{};
};

}  // namespace

bool isPng(std::string_view bytes) { return bytes.starts_with(kSignature); }

DecodedPicture decodePng(std::string_view bytes, const std::string& name, std::int64_t most) {
    if (!isPng(bytes)) fail(name, "not a PNG picture");
    const Chunks chunks = plainChunks(bytes, name);
    checkSize(chunks, name, most);

    PngImage image;
    const auto bad = [&] { fail(name, "bad PNG picture: " + printable(image->message)); };
    if (png_image_begin_read_from_memory(image.get(), chunks.bytes.data(), chunks.bytes.size()) ==
        0)
        bad();
    const bool has_alpha = (image->format & PNG_FORMAT_FLAG_ALPHA) != 0;
    image->format = has_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    // Without it libpng treats 16-bit samples as linear light and applies a gamma curve.
    image->flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    DecodedPicture picture;
    picture.channels = has_alpha ? 4 : 3;
    picture.samples.resize(PNG_IMAGE_SIZE(*image.get()));
    if (png_image_finish_read(image.get(), nullptr, picture.samples.data(), 0, nullptr) == 0) bad();
    picture.width = static_cast<int>(image->width);
    picture.height = static_cast<int>(image->height);
    return picture;
}

GreyPicture parsePng(std::string_view bytes, const std::string& name) {
    const DecodedPicture decoded = decodePng(bytes, name);
    const std::vector<std::uint8_t>& pixels = decoded.samples;
    const auto channels = static_cast<std::size_t>(decoded.channels);
    GreyPicture picture;
    picture.width = decoded.width;
    picture.height = decoded.height;
    picture.max_value = 3 * 255;
    picture.samples.reserve(pixels.size() / channels);
    if (channels == 4) picture.opacity.reserve(pixels.size() / channels);
    for (std::size_t i = 0; i < pixels.size(); i += channels) {
        picture.samples.push_back(
            static_cast<std::uint16_t>(pixels[i] + pixels[i + 1] + pixels[i + 2]));
        if (channels == 4) picture.opacity.push_back(pixels[i + 3]);
    }
    return picture;
}

}  // namespace ispace
