// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/film.h"

#include <tbb/global_control.h>
#include <tbb/task_group.h>

#include <gif_lib.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/error.h"

namespace ispace {

struct EncodeAhead::Job {
    std::string file;
    Image image;
    std::string bytes;
    tbb::task_group task;
};

struct EncodeAhead::Queue {
    static constexpr std::size_t kMaxPixels = 64'000'000;

    Encode encode;
    Write write;
    std::deque<std::unique_ptr<Job>> jobs = {};
    std::size_t pixels = 0;  // sum over all jobs

    void writeFirst() {
        const std::unique_ptr<Job> job = std::move(jobs.front());
        jobs.pop_front();
        pixels -= job->image.pixels.size();
        job->task.wait();
        write(job->file, job->bytes);
    }
};

EncodeAhead::EncodeAhead(Encode encode, Write write)
    : queue_(std::make_unique<Queue>(Queue{std::move(encode), std::move(write)})) {}

EncodeAhead::~EncodeAhead() {
    while (!queue_->jobs.empty()) {
        try {
            queue_->writeFirst();
        } catch (...) {  // an earlier error is being reported
        }
    }
}

void EncodeAhead::add(std::string file, Image image) {
    Queue& queue = *queue_;
    queue.pixels += image.pixels.size();
    Job& job = *queue.jobs.emplace_back(std::make_unique<Job>());
    job.file = std::move(file);
    job.image = std::move(image);
    job.task.run([&job, &queue] { job.bytes = queue.encode(job.image); });
    const std::size_t cores =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    while (queue.jobs.size() > cores || queue.pixels > Queue::kMaxPixels) {
        queue.writeFirst();
        if (queue.jobs.empty()) return;
    }
}

void EncodeAhead::finish() {
    while (!queue_->jobs.empty()) queue_->writeFirst();
}

namespace {

constexpr std::size_t kMaxColors = 256;
constexpr int kMaxSize = 65535;

/// A rectangle of a picture: columns and rows from a first one to before a last.
struct Patch {
    int left = 0, top = 0, right = 0, bottom = 0;

    [[nodiscard]] int width() const { return right - left; }
    [[nodiscard]] int height() const { return bottom - top; }
};

/// Returns the bounds of changed pixels; one pixel if no pixel changed, since GIF requires a
/// picture.
Patch changeOf(const Image& before, const Image& image) {
    Patch part{image.width, image.height, 0, 0};
    for (int y = 0; y < image.height; ++y) {
        const auto row = static_cast<std::ptrdiff_t>(y) * image.width;
        const auto begin = image.pixels.begin() + row, end = begin + image.width;
        const auto first = std::mismatch(begin, end, before.pixels.begin() + row).first;
        if (first == end) continue;
        int last = image.width - 1;
        while (image.at(last, y) == before.at(last, y)) --last;
        part.left = std::min(part.left, static_cast<int>(first - begin));
        part.right = std::max(part.right, last + 1);
        part.top = std::min(part.top, y);
        part.bottom = y + 1;
    }
    return part.right == 0 ? Patch{0, 0, 1, 1} : part;
}

int distanceOf(std::uint32_t a, std::uint32_t b) {
    constexpr std::uint32_t kByte = 255;
    int sum = 0;
    for (const std::uint32_t shift : {0U, 8U, 16U}) {
        const int d = static_cast<int>(a >> shift & kByte) - static_cast<int>(b >> shift & kByte);
        sum += d * d;
    }
    return sum;
}

/// The colours of a rectangle of a picture, and the colour index of each pixel.
class Palette {
  public:
    Palette(const Image& image, const Patch& part) {
        std::unordered_map<std::uint32_t, int> counts;
        for (int y = part.top; y < part.bottom; ++y)
            for (int x = part.left; x < part.right; ++x) ++counts[image.at(x, y)];
        std::vector<Shade> shades;
        shades.reserve(counts.size());
        for (const auto& [color, count] : counts) shades.push_back({color, count});
        std::sort(shades.begin(), shades.end(), [](const Shade& a, const Shade& b) {
            return a.count != b.count ? a.count > b.count : a.color < b.color;
        });
        while (colors_.size() < std::min(kMaxColors, shades.size())) choose(shades);
        for (const Shade& shade : shades) index_.emplace(shade.color, shade.nearest);
    }
    [[nodiscard]] GifPixelType of(std::uint32_t color) const { return index_.at(color); }
    /// Returns the colour table; its size is a power of two.
    [[nodiscard]] std::vector<GifColorType> table() const {
        std::vector<GifColorType> table(std::max(std::bit_ceil(colors_.size()), std::size_t{2}));
        for (std::size_t i = 0; i < colors_.size(); ++i)
            table[i] = {static_cast<GifByteType>(colors_[i] >> 16U),
                        static_cast<GifByteType>(colors_[i] >> 8U),
                        static_cast<GifByteType>(colors_[i])};
        return table;
    }

  private:
    struct Shade {
        std::uint32_t color = 0;
        int count = 0;
        int distance = std::numeric_limits<int>::max();  // to the nearest chosen shade
        GifPixelType nearest = 0;
    };

    /// Adds colours: half are the most frequent ones, the others those farthest from all chosen
    /// before, which bounds the error of each shade. \pre shades are sorted by frequency
    void choose(std::vector<Shade>& shades) {
        const std::size_t index = colors_.size();
        const std::uint32_t color =
            index < kMaxColors / 2
                ? shades[index].color
                : std::max_element(shades.begin(), shades.end(), [](const auto& a, const auto& b) {
                      return a.distance < b.distance;
                  })->color;
        colors_.push_back(color);
        for (Shade& shade : shades) {
            const int distance = distanceOf(shade.color, color);
            if (distance >= shade.distance) continue;
            shade.distance = distance;
            shade.nearest = static_cast<GifPixelType>(index);
        }
    }

    std::vector<std::uint32_t> colors_;
    std::unordered_map<std::uint32_t, GifPixelType> index_;
};

}  // namespace

struct GifFilm::Data {
    explicit Data(double the_fps) : fps(the_fps) {}
    ~Data() { close(); }
    Data(const Data&) = delete;
    Data& operator=(const Data&) = delete;

    void begin(const Image& image);
    void write(const Image& image, const Patch& part);
    void close() {
        int ignored = 0;
        if (file != nullptr) EGifCloseFile(std::exchange(file, nullptr), &ignored);
    }
    /// Checks the library's result: it writes to memory, so an error is bad_alloc.
    static void check(int answer) {
        if (answer == GIF_ERROR) throw std::bad_alloc();
    }

    double fps;
    std::string bytes;  // not yet returned
    GifFileType* file = nullptr;
    Image before;
    int count = 0;
};

void GifFilm::Data::begin(const Image& image) {
    if (image.width > kMaxSize || image.height > kMaxSize)
        throw FormatError({"", 0, 0,
                           "a GIF has at most 65535 x 65535 pixels, this film " +
                               std::to_string(image.width) + " x " + std::to_string(image.height)});
    const auto append = [](GifFileType* gif, const GifByteType* data, int size) {
        static_cast<std::string*>(gif->UserData)
            ->append(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
        return size;
    };
    int error = 0;
    file = EGifOpen(&bytes, append, &error);
    if (file == nullptr) throw std::bad_alloc();
    EGifSetGifVersion(file, true);
    constexpr int kBits = 8;
    check(EGifPutScreenDesc(file, image.width, image.height, kBits, 0, nullptr));
    // Loops for ever, by Netscape's extension.
    constexpr std::array<GifByteType, 3> kForEver{1, 0, 0};
    check(EGifPutExtensionLeader(file, APPLICATION_EXT_FUNC_CODE));
    check(EGifPutExtensionBlock(file, 11, "NETSCAPE2.0"));
    check(EGifPutExtensionBlock(file, kForEver.size(), kForEver.data()));
    check(EGifPutExtensionTrailer(file));
}

void GifFilm::Data::write(const Image& image, const Patch& part) {
    constexpr double kHundredths = 100;
    const auto time_of = [this](int picture) {
        return static_cast<int>(std::lround(picture * kHundredths / fps));
    };
    // Duration from this picture's time to the next one's, so that rounding errors do not add up.
    const GraphicsControlBlock control{DISPOSE_DO_NOT, false, time_of(count + 1) - time_of(count),
                                       NO_TRANSPARENT_COLOR};
    std::array<GifByteType, 4> block{};
    EGifGCBToExtension(&control, block.data());
    check(EGifPutExtension(file, GRAPHICS_EXT_FUNC_CODE, block.size(), block.data()));
    const Palette palette(image, part);
    const std::vector<GifColorType> table = palette.table();
    const std::unique_ptr<ColorMapObject, decltype(&GifFreeMapObject)> map(
        GifMakeMapObject(static_cast<int>(table.size()), table.data()), &GifFreeMapObject);
    if (!map) throw std::bad_alloc();
    check(
        EGifPutImageDesc(file, part.left, part.top, part.width(), part.height(), false, map.get()));
    std::vector<GifPixelType> row(static_cast<std::size_t>(part.width()));
    for (int y = part.top; y < part.bottom; ++y) {
        for (int x = part.left; x < part.right; ++x)
            row[static_cast<std::size_t>(x - part.left)] = palette.of(image.at(x, y));
        check(EGifPutLine(file, row.data(), part.width()));
    }
}

GifFilm::GifFilm(double fps) : data_(std::make_unique<Data>(fps)) {
    assert(fps >= kSlowest && fps <= kFastest);
}

GifFilm::~GifFilm() = default;

std::string GifFilm::add(const Image& image) {
    const bool is_first = data_->count == 0;
    if (is_first) data_->begin(image);
    data_->write(
        image, is_first ? Patch{0, 0, image.width, image.height} : changeOf(data_->before, image));
    data_->before = image;
    ++data_->count;
    return std::exchange(data_->bytes, {});
}

std::string GifFilm::end() {
    assert(data_->count > 0);
    data_->close();
    return std::exchange(data_->bytes, {});
}

// The format: https://wiki.multimedia.cx/index.php/YUV4MPEG2
std::string y4mHeader(int width, int height, double fps) {
    constexpr double kParts = 1000;
    return "YUV4MPEG2 W" + std::to_string(width) + " H" + std::to_string(height) + " F" +
           std::to_string(std::lround(fps * kParts)) + ":1000 Ip A1:1 C420jpeg\n";
}

namespace {

/// Luma of ITU-R BT.601 in video range, times 256.
struct Luma {
    int red, green, blue, offset;

    [[nodiscard]] char of(int r, int g, int b) const {
        constexpr int kHalf = 128;
        return static_cast<char>(
            static_cast<std::uint8_t>(((red * r + green * g + blue * b + kHalf) >> 8) + offset));
    }
};
constexpr Luma kY{66, 129, 25, 16}, kCb{-38, -74, 112, 128}, kCr{112, -94, -18, 128};

struct PixelColor {
    int red = 0, green = 0, blue = 0;
};

PixelColor rgbOf(std::uint32_t pixel) {
    return {static_cast<int>(pixel >> 16U & 255U), static_cast<int>(pixel >> 8U & 255U),
            static_cast<int>(pixel & 255U)};
}

/// Returns the mean of a square of four pixels.
PixelColor meanOf(const Image& image, int x, int y) {
    PixelColor sum;
    for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
            const PixelColor pixel = rgbOf(image.at(x + dx, y + dy));
            sum.red += pixel.red;
            sum.green += pixel.green;
            sum.blue += pixel.blue;
        }
    return {(sum.red + 2) / 4, (sum.green + 2) / 4, (sum.blue + 2) / 4};
}

}  // namespace

std::string y4mFrame(const Image& image) {
    assert(image.width % 2 == 0 && image.height % 2 == 0);
    std::string bytes = "FRAME\n";
    bytes.reserve(bytes.size() + image.pixels.size() * 3 / 2);
    for (const std::uint32_t pixel : image.pixels) {
        const auto [red, green, blue] = rgbOf(pixel);
        bytes += kY.of(red, green, blue);
    }
    for (const Luma& plane : {kCb, kCr})
        for (int y = 0; y < image.height; y += 2)
            for (int x = 0; x < image.width; x += 2) {
                const auto [red, green, blue] = meanOf(image, x, y);
                bytes += plane.of(red, green, blue);
            }
    return bytes;
}

}  // namespace ispace
