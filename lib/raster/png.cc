// SPDX-License-Identifier: GPL-3.0-or-later
#include <png.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/error.h"
#include "base/message.h"
#include "raster/module/decoded_picture.h"
#include "raster/picture.h"

namespace ispace {

namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kChunkFrame = 12;  // length, type and check sum about a chunk's content
constexpr std::size_t kHeaderLength = 13;

/// Deflate makes at most 1032 bytes of one.
constexpr std::int64_t kMaxInflation = 1040;

[[noreturn]] void fail(const std::string& name, const std::string& message) {
    throw FormatError(Diagnostic{displayName(name), 0, 0, message});
}

std::int64_t bigEndian(std::string_view bytes) {
    std::int64_t value = 0;
    for (const char c : bytes.substr(0, 4)) value = value * 256 + static_cast<unsigned char>(c);
    return value;
}

/// A PNG file's chunks that say what its samples are.
struct Chunks {
    std::string bytes;      // signature and chunks
    std::string header;     // content of IHDR
    std::int64_t data = 0;  // bytes of IDAT
};

/// Leaves out what is said about colour spaces, and comments.
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

/// Throws if the picture is too large, or so large that the file cannot hold it.
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

/// Frees what libpng keeps beside a picture, also when something throws.
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
    // Without it libpng takes 16-bit samples as linear light and bends them.
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
