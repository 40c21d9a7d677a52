// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "draw/color.h"
#include "draw/picture.h"
#include "sense/depth_picture.h"
#include "sense/figure_parts.h"

namespace ispace {

namespace {

// Of the page, in pixels.
constexpr double kMargin = 16, kText = 13, kTitle = 16, kHead = 58;
constexpr double kBarGap = 28, kBarWidth = 18, kLegendWidth = 112;
constexpr int kLeastWidth = 640, kMostWidth = 4096, kLeastHeight = 200;
constexpr std::uint32_t kNoReturn = 0x000000;
using palette::kInk;
constexpr Color kFaint = palette::kFaintInk;

std::uint32_t pixelOf(Color color) {
    const auto part = [](double share) {
        return static_cast<std::uint32_t>(std::lround(share * 255));
    };
    return part(color.red) << 16U | part(color.green) << 8U | part(color.blue);
}

/// Which colour stands for which depth. Of a device that reaches far equal steps of colour are
/// equal ratios: its rooms are near.
class Scale {
  public:
    explicit Scale(const Ranger& ranger)
        : far_(ranger.ambiguity > 0 ? ranger.ambiguity : ranger.max_range) {
        constexpr double kRoom = 20, kSpan = 200;
        is_ratio_ = far_ > kRoom;
        near_ = ranger.ambiguity > 0 ? 0 : ranger.min_range;
        far_ = std::max(far_, near_ + 0.001);
        if (is_ratio_) near_ = std::max(near_, far_ / kSpan);
    }

    /// 0 at the near end, 1 at the far one.
    [[nodiscard]] double shareOf(double depth) const {
        const double share = is_ratio_ ? std::log(depth / near_) / std::log(far_ / near_)
                                       : (depth - near_) / (far_ - near_);
        return std::clamp(share, 0.0, 1.0);
    }
    [[nodiscard]] static std::uint32_t color(double share) {
        // The ends of the map are left out: its darkest blue looks like no return.
        constexpr double kColdest = 0.07, kWarmest = 0.96;
        return pixelOf(turboColor(kWarmest + (kColdest - kWarmest) * share));
    }
    /// Round depths for an axis with room for so many labels.
    [[nodiscard]] std::vector<double> ticks(double room) const {
        constexpr double kSlack = 1e-9;
        std::vector<double> depths;
        if (is_ratio_) {
            for (double tick = roundStep(near_); tick <= far_ * (1 + kSlack);
                 tick = roundStep(1.5 * tick))
                depths.push_back(tick);
            return depths;
        }
        const double step = roundStep((far_ - near_) / room);
        for (double k = std::ceil(near_ / step - kSlack); k * step <= far_ + kSlack * step; ++k)
            depths.push_back(k * step);
        return depths;
    }

  private:
    double near_ = 0, far_;
    bool is_ratio_ = false;
};

/// How large a pixel of the ranger is on the page; `stride`: only each so-manieth is shown.
struct Zoom {
    int stride = 1, x = 1, y = 1;

    explicit Zoom(const Ranger& ranger) {
        const int longest = std::max(ranger.columns, ranger.rows);
        stride = (longest + kMostWidth - 1) / kMostWidth;
        x = std::clamp(kLeastWidth / longest, 1, 8);
        // Rings of a turning head are wide apart.
        const double shape =
            ranger.projection == Projection::Pinhole
                ? ranger.fx() / ranger.fy()
                : ranger.fov_y.degrees() / ranger.rows * ranger.columns / ranger.fov_x.degrees();
        const double most = std::clamp(kMostWidth / ranger.rows, 1, 16);
        y = static_cast<int>(std::clamp(std::round(x * shape), 1.0, most));
    }
};

Image colored(const Ranger& ranger, const DepthFrame& frame, const Scale& scale, int stride) {
    Image image;
    image.width = (ranger.columns + stride - 1) / stride;
    image.height = (ranger.rows + stride - 1) / stride;
    image.pixels.reserve(static_cast<std::size_t>(image.width) *
                         static_cast<std::size_t>(image.height));
    for (int row = 0; row < ranger.rows; row += stride) {
        const float* depths =
            &frame.depths[static_cast<std::size_t>(row) * static_cast<std::size_t>(ranger.columns)];
        for (int column = 0; column < ranger.columns; column += stride) {
            const double depth = depths[column];
            image.pixels.push_back(std::isfinite(depth) ? Scale::color(scale.shareOf(depth))
                                                        : kNoReturn);
        }
    }
    return image;
}

std::string subtitle(const Ranger& ranger) {
    std::string text = ranger.projection == Projection::Pinhole ? "depth along the optical axis"
                                                                : "distance along the ray";
    if (ranger.ambiguity > 0) text.append(", repeats after ").append(metres(ranger.ambiguity));
    text.append(" · ").append(std::to_string(ranger.columns)).append(" × ");
    text.append(std::to_string(ranger.rows)).append(" pixels · ");
    text.append(degrees(ranger.fov_x)).append(" × ");
    return text.append(degrees(ranger.fov_y));
}

/// The scale as a bar with ticks, and what black means, in a column from `top` to `bottom`.
void drawLegend(Picture& picture, const Scale& scale, double left, double top, double bottom) {
    const double bar_bottom = bottom - 2.4 * kText;
    const int steps = static_cast<int>(bar_bottom - top);
    Image bar{1, steps, {}};
    bar.pixels.reserve(static_cast<std::size_t>(steps));
    for (int i = 0; i < steps; ++i)  // near at the bottom
        bar.pixels.push_back(Scale::color((steps - i - 0.5) / steps));
    picture.image({left, top}, std::move(bar), kBarWidth, 1);
    const Stroke edge{kInk, 1};
    const auto frame = [&](double from, double to) {
        picture.area(Polygon{{left + 0.5, from + 0.5},
                             {left + kBarWidth - 0.5, from + 0.5},
                             {left + kBarWidth - 0.5, to - 0.5},
                             {left + 0.5, to - 0.5}},
                     {edge});
    };
    frame(top, top + steps);

    const TextStyle label{kText, false, Align::Left, kInk, {}};
    for (const double tick : scale.ticks(steps / (2.6 * kText))) {
        const double y = top + steps * (1 - scale.shareOf(tick));
        picture.line({left + kBarWidth, y}, {left + kBarWidth + 5, y}, edge);
        picture.text({left + kBarWidth + 10, y + 0.36 * kText}, metres(tick), label);
    }
    const double box = bottom - kText - 2;
    picture.area(
        Polygon{{left, box}, {left + kBarWidth, box}, {left + kBarWidth, bottom}, {left, bottom}},
        {Color::rgb(kNoReturn)});
    picture.text({left + kBarWidth + 10, bottom - 2.5}, "no return", label);
}

}  // namespace

std::string colorDepthPng(const Sensor& sensor, const DepthFrame& frame) {
    const Ranger& ranger = sensor.as<Ranger>();
    const Scale scale(ranger);
    const Zoom zoom(ranger);
    Image image = colored(ranger, frame, scale, zoom.stride);
    const double width = image.width * zoom.x, height = image.height * zoom.y;
    const double shown = std::max<double>(height, kLeastHeight);
    Picture picture(kMargin + std::max(width, 320.0) + kBarGap + kLegendWidth,
                    kHead + shown + kMargin);

    const double room = picture.width() - 2 * kMargin;
    const TextStyle title{kTitle, true, Align::Left, kInk, {}};
    const TextStyle small{kText, false, Align::Left, kFaint, {}};
    picture.text({kMargin, 25},
                 fitText(figureTitle(sensor.id, ranger.model, "ranger", frame.frame, frame.pose),
                         room, title),
                 title);
    picture.text({kMargin, 45}, fitText(subtitle(ranger), room, small), small);
    picture.image({kMargin, kHead}, std::move(image), zoom.x, zoom.y);
    drawLegend(picture, scale, kMargin + width + kBarGap, kHead, kHead + shown);
    return picture.write(PictureFormat::Png);
}

}  // namespace ispace
