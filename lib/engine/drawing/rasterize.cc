// SPDX-License-Identifier: GPL-3.0-or-later
// Pixels and pages of a Picture, filled by the module that links Cairo, and PNG. Large pictures are
// drawn in horizontal bands by up to four threads; each band draws only the shapes that reach it,
// with the same bytes as one pass.
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "drawing/drawing.h"
#include "drawing/module/painter.h"
#include "raster/codec.h"
#include "raster/module/decoded_picture.h"
#include "raster/picture.h"

namespace ispace {

namespace {

const Painting& painting() {
    static const Painting& opened = [&]() -> const Painting& {
        std::string error;
        if (const void* found = moduleSymbol("drawing.so", kPainting, error))
            return *static_cast<const Painting*>(found);
        throw FormatError(
            Diagnostic{"", 0, 0, "drawing needs Cairo (Debian: libcairo2): " + printable(error)});
    }();
    return opened;
}

std::vector<Segment2> hatchOf(const Hatch& hatch, const Picture& picture,
                              const DisplayList::Shape& shape) {
    return hatchLines(hatch, visibleBox(picture, shape));
}

/// Returns the number of bands drawn in parallel: each needs the memory of the whole picture.
int bandsAtOnce(const Picture& picture) {
    constexpr std::size_t kManyPoints = 10'000, kMaxThreads = 4;
    constexpr double kMaxPixels = 16e6;
    if (picture.list().points.size() < kManyPoints ||
        picture.width() * picture.height() > kMaxPixels)
        return 1;
    const std::size_t threads =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return static_cast<int>(std::min(threads, kMaxThreads));
}

/// Counts the points of shapes in several bands, once for each band but one.
std::size_t pointsAgain(const Picture& picture, const std::vector<Rows>& bands) {
    const DisplayList& list = picture.list();
    const auto band_of = [&](double y) {
        const auto next = std::upper_bound(bands.begin() + 1, bands.end(), y,
                                           [](double v, const Rows& b) { return v < b.first; });
        return next - bands.begin();
    };
    std::size_t again = 0;
    for (const DisplayList::Shape& shape : list.shapes) {
        const bool has_curves =
            shape.kind == DisplayList::Kind::Area || shape.kind == DisplayList::Kind::Lines;
        if (!has_curves) continue;
        double low = picture.height(), high = 0;
        for (std::uint32_t i = shape.first; i < shape.last; ++i)
            for (const Point2 p : list.curve(i)) {
                low = std::min(low, p.y);
                high = std::max(high, p.y);
            }
        if (low < high)
            again += static_cast<std::size_t>(band_of(high) - band_of(low)) *
                     (list.ends[shape.last] - list.ends[shape.first]);
    }
    return again;
}

/// Splits the picture into bands with similar numbers of points; one band if most shapes span
/// several.
std::vector<Rows> bandsOf(const Picture& picture, int count) {
    const int height = static_cast<int>(std::lround(picture.height()));
    if (count < 2) return {{0, height}};
    std::vector<std::size_t> points(static_cast<std::size_t>(height));  // by row
    for (const Point2 p : picture.list().points)
        if (p.y >= 0 && p.y < height) ++points[static_cast<std::size_t>(p.y)];
    const std::size_t all = std::accumulate(points.begin(), points.end(), std::size_t{0});
    std::vector<Rows> bands = {{0, height}};
    std::size_t above = 0;
    for (int row = 0; row < height; ++row) {
        above += points[static_cast<std::size_t>(row)];
        if (above * static_cast<std::size_t>(count) <= all * bands.size() || row + 1 == height ||
            bands.size() == static_cast<std::size_t>(count))
            continue;
        bands.back().beyond = row + 1;
        bands.push_back({row + 1, height});
    }
    if (4 * pointsAgain(picture, bands) > all) return {{0, height}};
    return bands;
}

}  // namespace

double textWidth(std::string_view text, const TextStyle& style) {
    return painting().text_width(printable(text), style);
}

Image rasterOf(const Picture& picture) {
    const std::vector<Rows> bands = bandsOf(picture, bandsAtOnce(picture));
    std::vector<Image> images(bands.size());
    tbb::parallel_for(std::size_t{0}, bands.size(), [&](std::size_t i) {
        images[i] = painting().pixels(picture, hatchOf, bands[i]);
    });
    Image image = std::move(images.front());
    for (std::size_t i = 1; i < bands.size(); ++i) {
        const auto place = [&](int row) { return std::ptrdiff_t{image.width} * row; };
        std::copy(images[i].pixels.begin() + place(bands[i].first),
                  images[i].pixels.begin() + place(bands[i].beyond),
                  image.pixels.begin() + place(bands[i].first));
    }
    return image;
}

std::string writePng(const Picture& picture) { return encodePng(rasterOf(picture)); }

std::string writePdf(std::span<const Picture> pages) { return painting().pdf(pages, hatchOf); }

std::string encodePng(const Image& image) {
    return pngOfDrawing(image.width, image.height, image.pixels,
                        static_cast<std::size_t>(image.width));
}

Image decodePng(std::string_view bytes) {
    const DecodedPicture decoded = decodePng(bytes, "");
    Image image{decoded.width, decoded.height, {}};
    const auto channels = static_cast<std::size_t>(decoded.channels);
    image.pixels.reserve(decoded.samples.size() / channels);
    for (std::size_t i = 0; i < decoded.samples.size(); i += channels) {
        const std::uint8_t* const sample = &decoded.samples[i];
        const std::uint32_t opacity = channels == 4 ? sample[3] : 255;
        std::uint32_t pixel = 0;
        for (std::size_t c = 0; c < 3; ++c) pixel = pixel << 8U | (sample[c] * opacity + 127) / 255;
        image.pixels.push_back(pixel);
    }
    return image;
}

}  // namespace ispace
