// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "base/confined.h"
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "raster/codec.h"
#include "raster/module/decoded_picture.h"

namespace ispace {

namespace {

/// Debian's package of the library that decodes and writes JPEG, of the release of this build.
constexpr const char* kCodecs = ISPACE_OPENCV_PACKAGE;

/// Width and height from a header.
using Size = std::pair<std::int64_t, std::int64_t>;

/// Reads the numbers of a header; empty beyond the end of the file.
class Bytes {
  public:
    Bytes(std::string_view bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

    [[nodiscard]] std::optional<std::int64_t> number(std::size_t at, std::size_t count) const {
        if (at > bytes_.size() || bytes_.size() - at < count) return std::nullopt;
        std::int64_t value = 0;
        for (std::size_t i = 0; i < count; ++i)
            value = value * 256 +
                    static_cast<unsigned char>(bytes_[at + (big_endian_ ? i : count - 1 - i)]);
        return value;
    }
    [[nodiscard]] std::optional<Size> size(std::size_t width_at, std::size_t height_at,
                                           std::size_t count) const {
        const auto width = number(width_at, count), height = number(height_at, count);
        if (!width || !height) return std::nullopt;
        return Size(*width, *height);
    }

  private:
    std::string_view bytes_;
    bool big_endian_;
};

std::optional<Size> sizeOfBmp(std::string_view bytes) {
    const Bytes header(bytes, false);
    if (header.number(14, 4) == 12) return header.size(18, 20, 2);
    auto size = header.size(18, 22, 4);
    // Rows from the top down have a negative height.
    if (size && size->second > INT32_MAX) size->second = (std::int64_t{1} << 32) - size->second;
    return size;
}

/// Skips segments to the one that begins a frame.
std::optional<Size> sizeOfJpeg(std::string_view bytes) {
    const Bytes header(bytes, true);
    for (std::size_t at = 2;;) {
        const auto mark = header.number(at, 2), length = header.number(at + 2, 2);
        if (!mark || !length || *mark < 0xff01) return std::nullopt;
        const std::int64_t kind = *mark & 0xff;
        if (kind == 0xff) {  // padding
            ++at;
            continue;
        }
        const bool is_frame =
            kind >= 0xc0 && kind <= 0xcf && kind != 0xc4 && kind != 0xc8 && kind != 0xcc;
        if (is_frame) return header.size(at + 7, at + 5, 2);
        at += 2 + static_cast<std::size_t>(*length);
    }
}

/// Returns false for a truncated JPEG, which libjpeg would fill with grey. The mark of the end
/// cannot occur in the picture's data, and an embedded small picture precedes them.
bool isWholeJpeg(std::string_view bytes) {
    const std::size_t data = bytes.rfind("\xff\xda");
    return data != std::string_view::npos && bytes.find("\xff\xd9", data) != std::string_view::npos;
}

/// Returns the size of the first picture in the file.
std::optional<Size> sizeOfTiff(std::string_view bytes) {
    const Bytes file(bytes, bytes.starts_with("MM"));
    const auto directory = file.number(4, 4);
    if (!directory) return std::nullopt;
    const auto first = static_cast<std::size_t>(*directory);
    const auto entries = file.number(first, 2);
    Size size;
    for (std::size_t i = 0; entries && i < static_cast<std::size_t>(*entries); ++i) {
        constexpr std::int64_t kWidth = 256, kHeight = 257, kShort = 3;
        const std::size_t at = first + 2 + 12 * i;
        const std::int64_t tag = file.number(at, 2).value_or(0);
        if (tag != kWidth && tag != kHeight) continue;
        const auto type = file.number(at + 2, 2);
        const auto value = file.number(at + 8, type == kShort ? 2 : 4);
        (tag == kWidth ? size.first : size.second) = value.value_or(0);
    }
    return size;
}

std::optional<Size> sizeOfWebP(std::string_view bytes) {
    const Bytes header(bytes, false);
    const std::string_view kind = bytes.substr(std::min<std::size_t>(12, bytes.size()), 4);
    if (kind == "VP8X") {
        const auto size = header.size(24, 27, 3);
        return size ? std::optional(Size(size->first + 1, size->second + 1)) : std::nullopt;
    }
    if (kind == "VP8L") {
        const auto bits = header.number(21, 4);
        if (!bits) return std::nullopt;
        return Size((*bits & 0x3fff) + 1, (*bits >> 14 & 0x3fff) + 1);
    }
    const auto size = header.size(26, 28, 2);
    return size ? std::optional(Size(size->first & 0x3fff, size->second & 0x3fff)) : std::nullopt;
}

/// Reads the first two numbers behind the magic, past comments.
std::optional<Size> sizeOfPnm(std::string_view bytes) {
    constexpr std::string_view kBlanks = " \t\r\n\v\f";
    std::array<std::int64_t, 2> numbers{};
    std::size_t at = 2;
    for (std::int64_t& number : numbers) {
        while ((at = bytes.find_first_not_of(kBlanks, at)) != std::string_view::npos &&
               bytes[at] == '#')
            at = bytes.find('\n', at);
        if (at == std::string_view::npos) return std::nullopt;
        const std::size_t end = std::min(bytes.find_first_of(kBlanks, at), bytes.size());
        const auto value = parseInteger(bytes.substr(at, end - at));
        if (!value || *value < 1) return std::nullopt;
        number = *value;
        at = end;
    }
    return Size(numbers[0], numbers[1]);
}

bool isBmp(std::string_view bytes) {
    // Text may begin with BM; in a header, zeros and its length follow.
    constexpr std::array<std::int64_t, 7> kLengths{12, 40, 52, 56, 64, 108, 124};
    const Bytes header(bytes, false);
    return bytes.starts_with("BM") && header.number(6, 4) == 0 &&
           std::find(kLengths.begin(), kLengths.end(), header.number(14, 4)) != kLengths.end();
}

bool isTiff(std::string_view bytes) {
    return bytes.starts_with(std::string_view("II*\0", 4)) ||
           bytes.starts_with(std::string_view("MM\0*", 4));
}

bool isPnm(std::string_view bytes) {
    constexpr std::string_view kKinds = "1346";  // 2 and 5 are PGM
    return bytes.size() > 2 && bytes[0] == 'P' && kKinds.find(bytes[1]) != kKinds.npos &&
           (bytes[2] == ' ' || bytes[2] == '\n' || bytes[2] == '\r' || bytes[2] == '\t');
}

struct PictureFormat {
    const char* name;
    bool (*holds)(std::string_view);
    std::optional<Size> (*size)(std::string_view);
};

constexpr PictureFormat kFormats[] = {
    {"JPEG", [](std::string_view bytes) { return bytes.starts_with("\xff\xd8\xff"); }, sizeOfJpeg},
    {"BMP", isBmp, sizeOfBmp},
    {"TIFF", isTiff, sizeOfTiff},
    {"WebP",
     [](std::string_view bytes) {
         return bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP");
     },
     sizeOfWebP},
    {"PNM", isPnm, sizeOfPnm},
};

const PictureFormat* formatOf(std::string_view bytes) {
    const auto* const found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                           [bytes](const auto& f) { return f.holds(bytes); });
    return found == std::end(kFormats) ? nullptr : found;
}

/// Decodes by lib/ispace/read-picture.
/// \throws FormatError
DecodedPicture decodedApart(std::string_view bytes, const std::string& name,
                            const std::string& format, std::size_t pixels, ConfinedReader& reader) {
    const OpenFile file = fileInMemory(bytes);
    const std::string answer =
        reader.read({.name = name,
                     .program = "read-picture",
                     .file = file.fd(),
                     .bytes = bytes.size(),
                     .limits = [pixels](std::size_t /*bytes*/) { return pictureLimits(pixels); },
                     .kind = format + " picture",
                     .reader = "OpenCV",
                     .subject = format + " pictures are",
                     .hint = "; OpenCV is needed (Debian: " + std::string(kCodecs) +
                             "), or convert it, for example with `convert FILE map.png`",
                     .problem = "bad " + format + " picture: "});
    PackedHead head{};
    if (answer.size() >= sizeof head) std::memcpy(head.data(), answer.data(), sizeof head);
    const auto [width, height, channels] = head;
    const bool is_whole = width > 0 && height > 0 &&
                          (channels == 1 || channels == 3 || channels == 4) &&
                          (answer.size() - sizeof head) / static_cast<std::size_t>(width) /
                                  static_cast<std::size_t>(channels) ==
                              static_cast<std::size_t>(height);
    if (!is_whole)
        throw FormatError(Diagnostic{displayName(name), 0, 0,
                                     "bad " + format + " picture: its reader is broken"});
    return {width, height, channels, {answer.begin() + sizeof head, answer.end()}};
}

GreyPicture pictureOf(const DecodedPicture& decoded) {
    GreyPicture picture;
    picture.width = decoded.width;
    picture.height = decoded.height;
    picture.max_value = 3 * 255;
    const auto channels = static_cast<std::size_t>(decoded.channels);
    const std::vector<std::uint8_t>& samples = decoded.samples;
    picture.samples.reserve(samples.size() / channels);
    if (channels == 4) picture.opacity.reserve(samples.size() / channels);
    for (std::size_t i = 0; i + channels <= samples.size(); i += channels) {
        const int sum =
            channels == 1 ? 3 * samples[i] : samples[i] + samples[i + 1] + samples[i + 2];
        picture.samples.push_back(static_cast<std::uint16_t>(sum));
        if (channels == 4) picture.opacity.push_back(samples[i + 3]);
    }
    return picture;
}

}  // namespace

std::string foreignPicture(std::string_view bytes) {
    const PictureFormat* const format = formatOf(bytes);
    return format == nullptr ? "" : format->name;
}

namespace {

/// Blue first.
DecodedPicture decodeForeign(std::string_view bytes, const std::string& name, std::int64_t most,
                             ConfinedReader& reader) {
    const auto fail = [&name](const std::string& message) {
        throw FormatError(Diagnostic{displayName(name), 0, 0, message});
    };
    const PictureFormat* const format = formatOf(bytes);
    if (format == nullptr) fail("no picture that OpenCV reads");
    const std::string kind = format->name;
    const auto size = format->size(bytes);
    if (!size || size->first < 1 || size->second < 1)
        fail("bad " + kind + " picture: its header says no size; is the file whole?");
    const auto [width, height] = *size;
    const std::string extent = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width > most || height > most || width * height > most)
        fail(extent + ", wanted at most " + std::to_string(most));
    if (kind == "JPEG" && !isWholeJpeg(bytes)) fail("truncated JPEG picture");
    DecodedPicture decoded =
        decodedApart(bytes, name, kind, static_cast<std::size_t>(width * height), reader);
    if (decoded.width != width || decoded.height != height)
        fail("bad " + kind + " picture: its header says " + extent + ", it holds " +
             std::to_string(decoded.width) + " x " + std::to_string(decoded.height));
    return decoded;
}

}  // namespace

GreyPicture decodePicture(std::string_view bytes, const std::string& name) {
    ConfinedReader reader;
    return pictureOf(decodeForeign(bytes, name, kMaxDecodedPixels, reader));
}

std::string jpegOfRgb(int columns, int rows, std::span<const std::uint8_t> samples, int quality) {
    JpegPicture picture{columns, rows, quality, samples.data(), {}, {}};
    std::string error;
    // Opened anew each time: the loader counts references.
    void* const encode = moduleSymbol("pictures.so", kJpegEncoder, error);
    if (encode == nullptr)
        throw FormatError(
            Diagnostic{"", 0, 0,
                       "a JPEG picture needs OpenCV (Debian: " + std::string(kCodecs) +
                           "): " + printable(error) + "; PNG needs nothing else"});
    (*reinterpret_cast<JpegEncoder*>(encode))(picture);
    if (!picture.error.empty()) throw FormatError(Diagnostic{"", 0, 0, picture.error});
    return {picture.bytes.begin(), picture.bytes.end()};
}

bool isPicture(std::string_view bytes) {
    const bool is_pgm = (bytes.starts_with("P2") || bytes.starts_with("P5")) && bytes.size() > 2 &&
                        std::string_view(" \t\r\n#").find(bytes[2]) != std::string_view::npos;
    return is_pgm || isPng(bytes) || !foreignPicture(bytes).empty();
}

GreyPicture parsePicture(std::string_view bytes, const std::string& name) {
    if (isPng(bytes)) return parsePng(bytes, name);
    if (!foreignPicture(bytes).empty()) return decodePicture(bytes, name);
    if (bytes.starts_with("GIF8"))
        throw FormatError(
            Diagnostic{displayName(name), 0, 0,
                       "a GIF picture: convert it, for example with `convert FILE map.png`"});
    return parsePgm(bytes, name);
}

namespace {

ColorPicture coloured(const DecodedPicture& decoded, bool blue_first) {
    ColorPicture picture{decoded.width, decoded.height, {}};
    const auto channels = static_cast<std::size_t>(decoded.channels);
    const std::vector<std::uint8_t>& samples = decoded.samples;
    picture.rgba.reserve(samples.size() / channels * 4);
    for (std::size_t i = 0; i + channels <= samples.size(); i += channels) {
        const std::size_t green = channels == 1 ? i : i + 1, last = channels == 1 ? i : i + 2;
        const std::uint8_t pixel[] = {samples[blue_first ? last : i], samples[green],
                                      samples[blue_first ? i : last],
                                      channels == 4 ? samples[i + 3] : std::uint8_t{255}};
        picture.rgba.insert(picture.rgba.end(), std::begin(pixel), std::end(pixel));
    }
    return picture;
}

ColorPicture coloured(const GreyPicture& grey) {
    ColorPicture picture{grey.width, grey.height, {}};
    picture.rgba.reserve(grey.samples.size() * 4);
    for (const std::uint16_t sample : grey.samples) {
        const auto value = static_cast<std::uint8_t>(std::lround(255.0 * sample / grey.max_value));
        const std::uint8_t pixel[] = {value, value, value, 255};
        picture.rgba.insert(picture.rgba.end(), std::begin(pixel), std::end(pixel));
    }
    return picture;
}

}  // namespace

ColorPicture parseColorPicture(std::string_view bytes, const std::string& name,
                               ConfinedReader& reader) {
    if (isPng(bytes)) return coloured(decodePng(bytes, name, kMaxColorPixels), false);
    if (!foreignPicture(bytes).empty())
        return coloured(decodeForeign(bytes, name, kMaxColorPixels, reader), true);
    if (!isPicture(bytes)) throw FormatError(Diagnostic{displayName(name), 0, 0, "not a picture"});
    return coloured(parsePgm(bytes, name));
}

Cell classify(int sample, int max_value, const OccupancyRule& rule) {
    if (rule.mode == OccupancyRule::Mode::Raw) {
        const long value = std::lround(255.0 * sample / max_value);
        return value == 0 ? Cell::Free : value == 100 ? Cell::Occupied : Cell::Unknown;
    }
    // One division, correctly rounded, so that a threshold of 0.2 meets 51 of 255 exactly.
    const double darkness = static_cast<double>(rule.negate ? sample : max_value - sample) /
                            static_cast<double>(max_value);
    if (darkness > rule.occupied_thresh) return Cell::Occupied;
    if (darkness < rule.free_thresh) return Cell::Free;
    if (rule.mode == OccupancyRule::Mode::Scale) {
        // Hundredths of the distance between the thresholds, both ends possible.
        const double way = rule.occupied_thresh - rule.free_thresh;
        const double value = std::rint((darkness - rule.free_thresh) / way * 100);
        if (value == 0) return Cell::Free;
        if (value == 100) return Cell::Occupied;
    }
    return Cell::Unknown;
}

namespace {

/// Returns the sample that map_server writes for unknown; empty in modes without this meaning.
std::optional<int> unknownSample(const GreyPicture& image, const OccupancyRule& rule) {
    constexpr int kUnknown = 205;
    if (image.max_value % 255 != 0 || rule.negate || rule.mode == OccupancyRule::Mode::Raw)
        return std::nullopt;
    return kUnknown * (image.max_value / 255);
}

MapCells cellsThatAre(Cell kind, const GreyPicture& image, const OccupancyRule& rule) {
    using Mode = OccupancyRule::Mode;
    const bool averaged = rule.mode == Mode::Trinary && !image.opacity.empty();
    const bool wants_opaque = rule.mode == Mode::Scale && !image.opacity.empty();
    const int opaque = averaged ? 255 : 0;
    const int white = image.max_value + opaque;
    std::vector<std::uint8_t> is_meant(static_cast<std::size_t>(white) + 1);
    for (int sample = 0; sample <= white; ++sample)
        is_meant[static_cast<std::size_t>(sample)] = classify(sample, white, rule) == kind ? 1 : 0;
    if (const auto unknown = unknownSample(image, rule)) {
        const int shade = *unknown + opaque;
        is_meant[static_cast<std::size_t>(shade)] =
            (rule.unknown_is_free ? Cell::Free : Cell::Unknown) == kind ? 1 : 0;
    }
    MapCells cells(image.width, image.height);
    std::size_t i = 0;
    for (int y = image.height - 1; y >= 0; --y)
        for (int x = 0; x < image.width; ++x, ++i) {
            if (wants_opaque && image.opacity[i] != 255) continue;
            const std::size_t opacity = averaged ? image.opacity[i] : 0;
            if (is_meant[image.samples[i] + opacity] != 0) cells.insert(x, y);
        }
    return cells;
}

}  // namespace

MapCells freeCells(const GreyPicture& image, const OccupancyRule& rule) {
    return cellsThatAre(Cell::Free, image, rule);
}

MapCells occupiedCells(const GreyPicture& image, const OccupancyRule& rule) {
    return cellsThatAre(Cell::Occupied, image, rule);
}

std::size_t unknownCountedFree(const GreyPicture& image, const OccupancyRule& rule) {
    const auto unknown = unknownSample(image, rule);
    if (!unknown || classify(*unknown, image.max_value, rule) != Cell::Free) return 0;
    return static_cast<std::size_t>(
        std::count(image.samples.begin(), image.samples.end(), *unknown));
}

}  // namespace ispace
