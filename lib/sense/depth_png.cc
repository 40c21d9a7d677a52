// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_picture.h"

#include <png.h>
#include <zlib.h>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstdint>
#include <initializer_list>
#include <new>
#include <stdexcept>
#include <vector>

#include "base/json_writer.h"
#include "base/number.h"
#include "sense/float_text.h"

namespace ispace {

namespace {

/// Samples as a PNG has them: big-endian. \pre the machine is little-endian
std::vector<std::uint16_t> scaled(const std::vector<float>& depths, double per_metre) {
    static_assert(std::endian::native == std::endian::little);
    constexpr double kEnd = 1U << 16U;
    std::vector<std::uint16_t> samples(depths.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double units = static_cast<double>(depths[i]) * per_metre + 0.5;
        const bool fits = units >= 0 && units < kEnd;  // no return does not
        const auto sample = static_cast<std::uint32_t>(static_cast<std::int32_t>(fits ? units : 0));
        samples[i] = static_cast<std::uint16_t>(sample << 8U | sample >> 8U);
    }
    return samples;
}

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

/// Nothing here has a destructor: libpng leaves by longjmp. False if something failed.
bool writeGrey16(png_structp png, png_infop info, png_uint_32 width, png_uint_32 height,
                 const std::uint16_t* samples) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, info, width, height, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // Noisy depths have runs to find but no repetitions: three times as fast as zlib's own way, and
    // Paeth's prediction makes up for the size.
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
    png_set_compression_level(png, 1);
    png_set_compression_strategy(png, Z_RLE);
    png_write_info(png, info);
    for (std::size_t row = 0; row < height; ++row)
        png_write_row(png, reinterpret_cast<png_const_bytep>(samples + row * width));
    png_write_end(png, nullptr);
    return true;
}

}  // namespace

std::string depthPng(const Ranger& ranger, const DepthFrame& frame, double per_metre) {
    const std::vector<std::uint16_t> samples = scaled(frame.depths, per_metre);
    std::string bytes;
    const Writer writer;
    if (writer.info == nullptr) throw std::bad_alloc();
    png_set_write_fn(writer.png, &bytes, appendBytes, flushNothing);
    if (!writeGrey16(writer.png, writer.info, static_cast<png_uint_32>(ranger.columns),
                     static_cast<png_uint_32>(ranger.rows), samples.data()))
        throw std::runtime_error("a depth picture cannot be written as PNG");
    return bytes;
}

namespace {

void appendMatrix(std::string& out, std::string_view key, int rows, int columns,
                  std::initializer_list<double> data) {
    out.append(key).append(":\n  rows: ").append(std::to_string(rows));
    out.append("\n  cols: ").append(std::to_string(columns)).append("\n  data: [");
    bool comma = false;
    for (const double value : data) {
        if (comma) out += ", ";
        comma = true;
        // Readers that guess types by the look take 0 for a whole number.
        const std::string text = formatDouble(value);
        out += text;
        if (text.find_first_of(".e") == std::string::npos) out += ".0";
    }
    out += "]\n";
}

}  // namespace

std::string cameraInfoYaml(const Ranger& ranger, std::string_view name) {
    const double fx = nineDecimals(ranger.fx()), fy = nineDecimals(ranger.fy());
    const double cx = ranger.cx(), cy = ranger.cy();
    std::string out =
        "# Pixel centres are whole numbers: the middle of the picture is (columns - 1) / 2.\n";
    out.append("image_width: ").append(std::to_string(ranger.columns));
    out.append("\nimage_height: ").append(std::to_string(ranger.rows));
    // A string of JSON is one of YAML.
    out.append("\ncamera_name: ").append(JsonWriter().value(name).text()).append("\n");
    appendMatrix(out, "camera_matrix", 3, 3, {fx, 0, cx, 0, fy, cy, 0, 0, 1});
    out += "distortion_model: plumb_bob\n";
    appendMatrix(out, "distortion_coefficients", 1, 5, {0, 0, 0, 0, 0});
    appendMatrix(out, "rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    appendMatrix(out, "projection_matrix", 3, 4, {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0});
    return out;
}

}  // namespace ispace
