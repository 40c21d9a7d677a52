// SPDX-License-Identifier: GPL-3.0-or-later
// The background is a median a channel over pictures spread over the whole time. Colours are split
// into brightness along the ray of the background colour and chromaticity across it; the threshold
// is six robust standard deviations of all channels, at least 18 of 255. Bodies are connected over
// gaps of one pixel, and count from 40 pixels or 1/5000 of the picture on.
#include "extensions/calibration/picture_people.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "scene/sensor/camera.h"

namespace ispace::calibration {

namespace {

using Rgb8 = std::array<std::uint8_t, 3>;

std::vector<Rgb8> colorsOf(const ColorPicture& picture) {
    std::vector<Rgb8> colors(picture.rgba.size() / 4);
    for (std::size_t i = 0; i < colors.size(); ++i)
        colors[i] = {picture.rgba[4 * i], picture.rgba[4 * i + 1], picture.rgba[4 * i + 2]};
    return colors;
}

/// The picture without people, and how much its colours scatter.
struct Background {
    int width = 0, height = 0;
    std::vector<Rgb8> colors;
    double scatter = 0;  ///< robust standard deviation of a channel
};

Background backgroundOf(std::size_t pictures,
                        const std::function<ColorPicture(std::size_t)>& picture) {
    constexpr std::size_t kMostBytes = std::size_t{1} << 28U, kFewestBackgrounds = 9;
    std::size_t count = std::min(pictures, kBackgrounds);
    std::vector<std::vector<Rgb8>> samples;
    samples.reserve(count);
    Background background;
    for (std::size_t i = 0; i < count; ++i) {
        const ColorPicture one = picture(i * pictures / count);
        if (i > 0 && (one.width != background.width || one.height != background.height))
            throw FormatError({"", 0, 0, "its pictures have different sizes"});
        if (i == 0) {
            const std::size_t bytes = sizeof(Rgb8) * one.rgba.size() / 4;
            count = std::clamp(kMostBytes / std::max<std::size_t>(bytes, 1),
                               std::min(count, kFewestBackgrounds), count);
        }
        background.width = one.width;
        background.height = one.height;
        samples.push_back(colorsOf(one));
    }
    if (samples.empty()) return background;
    background.colors.resize(samples.front().size());
    std::array<std::uint8_t, kBackgrounds> values{};
    std::array<std::size_t, 256> deviations{};
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(count);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
    for (std::size_t k = 0; k < background.colors.size(); ++k)
        for (std::size_t channel = 0; channel < 3; ++channel) {
            for (std::size_t i = 0; i < count; ++i) values[i] = samples[i][k][channel];
            std::nth_element(values.begin(), middle, end);
            const int median = *middle;
            background.colors[k][channel] = *middle;
            const int off = std::abs(int{samples[k % count][k][channel]} - median);
            ++deviations[static_cast<std::size_t>(off)];
        }
    std::size_t below = 0;
    const std::size_t half = 3 * background.colors.size() / 2;
    while (below + 1 < deviations.size() && deviations[below] <= half) {
        deviations[below + 1] += deviations[below];
        ++below;
    }
    background.scatter = 1.4826 * static_cast<double>(below);
    return background;
}

/// Returns true if a pixel is of a body: neither as the background nor in its shadow.
bool differs(const Rgb8& color, const Rgb8& ground, double threshold) {
    double both = 0, square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        both += double(color[i]) * ground[i];
        square += double(ground[i]) * ground[i];
    }
    const double brightness = square > 0 ? both / square : 1;
    double chroma = 0, change = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double off = color[i] - brightness * ground[i];
        chroma += off * off;
        change = std::max(change, std::abs(double(color[i]) - ground[i]));
    }
    if (std::sqrt(chroma) > threshold) return true;
    if (change <= threshold) return false;
    // Darker alone: a shadow, unless too dark for one. Brighter alone: a body in light clothes.
    constexpr double kDarkest = 0.35;
    return brightness < kDarkest || brightness > 1;
}

class BodyFinder {
  public:
    explicit BodyFinder(const Background& background)
        : ground_(background), threshold_(std::max(kLeast, 6 * background.scatter)) {}

    [[nodiscard]] std::vector<PictureBody> in(const ColorPicture& picture) const {
        if (picture.width != ground_.width || picture.height != ground_.height)
            throw FormatError({"", 0, 0, "its pictures have different sizes"});
        const std::vector<Rgb8> colors = colorsOf(picture);
        std::vector<char> open(colors.size());
        for (std::size_t i = 0; i < colors.size(); ++i)
            open[i] = differs(colors[i], ground_.colors[i], threshold_) ? 1 : 0;
        std::vector<PictureBody> bodies;
        std::vector<int> pixels;
        const std::size_t fewest = std::max<std::size_t>(kFewestPixels, colors.size() / 5000);
        for (std::size_t i = 0; i < open.size(); ++i) {
            if (open[i] == 0) continue;
            collect(static_cast<int>(i), open, pixels);
            if (pixels.size() >= fewest) bodies.push_back(bodyOf(pixels));
        }
        std::stable_sort(
            bodies.begin(), bodies.end(),
            [](const PictureBody& a, const PictureBody& b) { return a.pixels > b.pixels; });
        return bodies;
    }

  private:
    static constexpr double kLeast = 18;  // of 255: sensors' noise and compression
    static constexpr std::size_t kFewestPixels = 40;

    /// Moves the pixels that are connected to the first one, over gaps of one pixel.
    void collect(int first, std::vector<char>& open, std::vector<int>& pixels) const {
        pixels.assign(1, first);
        open[static_cast<std::size_t>(first)] = 0;
        constexpr int kGap = 2;
        for (std::size_t next = 0; next < pixels.size(); ++next) {
            const int row = pixels[next] / ground_.width, column = pixels[next] % ground_.width;
            for (int r = std::max(0, row - kGap); r <= std::min(ground_.height - 1, row + kGap);
                 ++r)
                for (int c = std::max(0, column - kGap);
                     c <= std::min(ground_.width - 1, column + kGap); ++c) {
                    const int beside = r * ground_.width + c;
                    if (open[static_cast<std::size_t>(beside)] == 0) continue;
                    open[static_cast<std::size_t>(beside)] = 0;
                    pixels.push_back(beside);
                }
        }
    }

    [[nodiscard]] PixelPoint centreOf(int pixel) const {
        const int row = pixel / ground_.width, column = pixel % ground_.width;
        return {.column = static_cast<double>(column), .row = static_cast<double>(row)};
    }

    [[nodiscard]] PictureBody bodyOf(const std::vector<int>& pixels) const {
        PictureBody body{.left = 1e9, .right = -1, .top = 1e9, .bottom = -1};
        for (const int pixel : pixels) {
            const PixelPoint at = centreOf(pixel);
            body.left = std::min(body.left, at.column);
            body.right = std::max(body.right, at.column);
            body.top = std::min(body.top, at.row);
            body.bottom = std::max(body.bottom, at.row);
        }
        body.pixels = pixels.size();
        body.meets_edge = body.left < 1 || body.top < 1 || body.right > ground_.width - 2 ||
                          body.bottom > ground_.height - 2;
        double sum = 0, count = 0;
        const double below = body.top + (body.bottom - body.top) / 8;
        for (const int pixel : pixels) {
            const PixelPoint at = centreOf(pixel);
            if (at.row > below) continue;
            sum += at.column;
            ++count;
        }
        body.head = sum / count;
        return body;
    }

    const Background& ground_;
    double threshold_;
};

}  // namespace

std::vector<std::vector<PictureBody>> bodiesInPictures(
    std::size_t pictures, const std::function<ColorPicture(std::size_t)>& picture) {
    const Background background = backgroundOf(pictures, picture);
    const BodyFinder finder(background);
    std::vector<std::vector<PictureBody>> bodies;
    bodies.reserve(pictures);
    for (std::size_t i = 0; i < pictures; ++i) bodies.push_back(finder.in(picture(i)));
    return bodies;
}

}  // namespace ispace::calibration
