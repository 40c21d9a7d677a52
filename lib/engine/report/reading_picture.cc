// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/reading_picture.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "base/number.h"
#include "drawing/color.h"
#include "drawing/drawing.h"
#include "geom/tolerance.h"

namespace ispace {

std::string pictureTitle(std::string_view id, std::string_view model, std::string_view kind,
                         int frame, const Pose3& pose) {
    std::string text(id);
    text.append(" (").append(model.empty() ? kind : model).append("), frame ");
    text += std::to_string(frame);
    if (pose.tilt != Angle()) text.append(", tilt ").append(degrees(pose.tilt));
    if (pose.roll != Angle()) text.append(", roll ").append(degrees(pose.roll));
    return text;
}

std::string metres(double value) { return formatDouble(nineDecimals(value)) + " m"; }

std::string degrees(Angle angle) {
    const std::string size = formatDouble(std::round(std::fabs(angle.degrees()) * 10) / 10);
    std::string text = angle < Angle() && size != "0" ? "−" : "";
    return text.append(size).append("°");
}

namespace {

// Measures of the page, in pixels.
constexpr double kMargin = 16, kText = 13, kTitle = 16, kHead = 58;
constexpr double kBarGap = 28, kBarWidth = 18, kLegendWidth = 112;
constexpr int kLeastWidth = 640, kMostWidth = 4096, kMinHeight = 200;
constexpr std::uint32_t kNoReturn = 0x000000;
using palette::kInk;
constexpr Color kFaint = palette::kFaintInk;

std::uint32_t packed(Color color) {
    const auto part = [](double share) {
        return static_cast<std::uint32_t>(std::lround(share * 255));
    };
    return part(color.red) << 16U | part(color.green) << 8U | part(color.blue);
}

/// Maps depths to colours. For a device of long range equal steps of colour are equal ratios, since
/// most surfaces are near.
class Scale {
  public:
    Scale(const Ranger& ranger, std::optional<DepthSpectrum> spectrum)
        : far_(ranger.ambiguity > 0 ? ranger.ambiguity : ranger.max_range) {
        if (spectrum) {
            std::tie(near_, far_) = std::minmax(spectrum->warm, spectrum->cold);
            near_is_cold_ = spectrum->warm > spectrum->cold;
            return;
        }
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
    [[nodiscard]] std::uint32_t color(double share) const {
        // The ends of the map are skipped: its darkest blue looks like no return.
        constexpr double kColdest = 0.07, kWarmest = 0.96;
        if (near_is_cold_) share = 1 - share;
        return packed(turboColor(kWarmest + (kColdest - kWarmest) * share));
    }
    /// Returns round depths for the ticks of an axis with room for so many labels.
    [[nodiscard]] std::vector<double> ticks(double room) const {
        std::vector<double> depths;
        if (is_ratio_) {
            for (double tick = roundStep(near_); tick <= far_ * (1 + kStepTolerance);
                 tick = roundStep(1.5 * tick))
                depths.push_back(tick);
            return depths;
        }
        const double step = roundStep((far_ - near_) / room);
        for (double k = std::ceil(near_ / step - kStepTolerance);
             k * step <= far_ + kStepTolerance * step; ++k)
            depths.push_back(k * step);
        return depths;
    }

  private:
    double near_ = 0, far_;
    bool is_ratio_ = false, near_is_cold_ = false;
};

/// Size of a ranger's pixel on the page; only every `stride`-th pixel is drawn.
struct Zoom {
    int stride = 1, x = 1, y = 1;

    explicit Zoom(const Ranger& ranger) {
        const int longest = std::max(ranger.columns, ranger.rows);
        stride = (longest + kMostWidth - 1) / kMostWidth;
        x = std::clamp(kLeastWidth / longest, 1, 8);
        // Rings of a rotating head are far apart.
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
            image.pixels.push_back(std::isfinite(depth) ? scale.color(scale.shareOf(depth))
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

/// Draws the scale as a bar with ticks, and the key of black, in a column from `top` to `bottom`.
void drawLegend(Picture& picture, const Scale& scale, double left, double top, double bottom) {
    const double bar_bottom = bottom - 2.4 * kText;
    const int steps = static_cast<int>(bar_bottom - top);
    Image bar{1, steps, {}};
    bar.pixels.reserve(static_cast<std::size_t>(steps));
    for (int i = 0; i < steps; ++i)  // near at the bottom
        bar.pixels.push_back(scale.color((steps - i - 0.5) / steps));
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

std::string colorDepthPng(const Sensor& sensor, const DepthFrame& frame,
                          std::optional<DepthSpectrum> spectrum) {
    const Ranger& ranger = sensor.as<Ranger>();
    const Scale scale(ranger, spectrum);
    const Zoom zoom(ranger);
    Image image = colored(ranger, frame, scale, zoom.stride);
    const double width = image.width * zoom.x, height = image.height * zoom.y;
    const double shown = std::max<double>(height, kMinHeight);
    Picture picture(kMargin + std::max(width, 320.0) + kBarGap + kLegendWidth,
                    kHead + shown + kMargin);

    const double room = picture.width() - 2 * kMargin;
    const TextStyle title{kTitle, true, Align::Left, kInk, {}};
    const TextStyle small{kText, false, Align::Left, kFaint, {}};
    picture.text({kMargin, 25},
                 fitText(pictureTitle(sensor.id, ranger.model, "ranger", frame.frame, frame.pose),
                         room, title),
                 title);
    picture.text({kMargin, 45}, fitText(subtitle(ranger), room, small), small);
    picture.image({kMargin, kHead}, std::move(image), zoom.x, zoom.y);
    drawLegend(picture, scale, kMargin + width + kBarGap, kHead, kHead + shown);
    return picture.write(PictureFormat::Png);
}

namespace {

constexpr Color kGrid = Color::rgb(0xC8CCD0), kView = Color::rgb(0xEAF2F9);
constexpr Color kViewEdge = Color::rgb(0x9DBAD5), kReturn = Color::rgb(0xC0392B);

/// Bearing 0 is up, positive bearings are on the left.
Angle onPage(Angle bearing) { return bearing + Angle::degrees(90); }
Point2 place(Angle bearing, double range) { return Point2{} + range * unitVector(onPage(bearing)); }

/// Measures of the picture, in pixels unless stated otherwise.
struct PageLayout {
    double size;    ///< of the page
    double em;      ///< of text
    double disc;    ///< radius of the polar grid
    double extent;  ///< metres at the rim of the disc
    double ring;    ///< metres between rings
    Point2 center;

    PageLayout(const Laser& laser, const Scan& scan, int pixels)
        : size(pixels), em(std::clamp(pixels / 48.0, 7.0, 40.0)) {
        double farthest = 0;
        for (const float range : scan.ranges)
            if (std::isfinite(range)) farthest = std::max<double>(farthest, range);
        // The map zooms to the returns: a desk fills it even for a long-range sensor.
        const double limit = std::max(laser.max_range, 0.001);
        if (farthest == 0) farthest = limit;
        constexpr double kMinRings = 4;
        ring = roundStep(farthest / kMinRings / 1.3);
        extent = std::min(std::ceil(farthest / ring - 1e-6) * ring, limit);
        const double head = 3.6 * em, rim = 2.1 * em;
        disc = std::max(1.0, (size - head - 2 * rim) / 2);
        center = {size / 2, head + rim + disc};
    }
};

void drawView(Picture& picture, const Laser& laser, double extent) {
    const Angle from = onPage(laser.first), to = onPage(laser.first + laser.span());
    if (laser.span() >= Angle::degrees(360)) {
        picture.circle({}, extent, {kView});
        return;
    }
    picture.sector({}, extent, from, to, {kView});
    for (const Angle edge : {laser.first, laser.last()})
        picture.line({}, place(edge, extent), {kViewEdge, 1});
}

void drawGrid(Picture& picture, const PageLayout& layout) {
    const Stroke fine{kGrid, 1};
    const int rings = static_cast<int>(std::floor(layout.extent / layout.ring + 1e-6));
    for (int k = 1; k <= rings; ++k) picture.circle({}, k * layout.ring, {fine});
    picture.circle({}, layout.extent, {Stroke{kFaint, 1}});
    for (int degrees = 0; degrees < 360; degrees += 30)
        picture.line(place(Angle::degrees(degrees), 0.25 * layout.ring),
                     place(Angle::degrees(degrees), layout.extent), fine);
}

/// Writes text centred at a point of the page.
void writeAt(Picture& picture, Point2 page, std::string_view text, const TextStyle& style) {
    constexpr double kHalfCapital = 0.36;  // of the text size
    picture.pushView({1, {}, {page.x, page.y + kHalfCapital * style.size}});
    picture.text({}, text, style);
    picture.pop();
}

/// Writes bearings outside the rim, distances on their rings.
void drawLabels(Picture& picture, const PageLayout& layout) {
    TextStyle style{layout.em, false, Align::Center, kFaint, {}};
    for (int spoke = -5; spoke <= 6; ++spoke) {
        const Angle bearing = Angle::degrees(30 * spoke);
        const Point2 rim = picture.toPage(place(bearing, layout.extent));
        const Vec2 out = unitVector(onPage(bearing));
        const std::string label = degrees(bearing);
        const double gap_x = 0.6 * layout.em + textWidth(label, style) / 2, gap_y = 1.1 * layout.em;
        writeAt(picture, {rim.x + gap_x * out.x, rim.y - gap_y * out.y}, label, style);
    }
    style.halo = Color::rgb(0xFFFFFF).faded(0.85);
    style.color = kInk;
    const int rings = static_cast<int>(std::floor(layout.extent / layout.ring + 1e-6));
    const Angle between_spokes = Angle::degrees(-165);
    for (int k = 1; k <= rings; ++k) {
        const Point2 at = picture.toPage(place(between_spokes, k * layout.ring));
        writeAt(picture, at, metres(k * layout.ring), style);
    }
}

void drawReturns(Picture& picture, const Laser& laser, const Scan& scan, const PageLayout& layout) {
    const double radius = std::clamp(layout.size / 380, 1.2, 6.0) * layout.extent / layout.disc;
    for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
        const double range = scan.ranges[k];
        if (std::isfinite(range))
            picture.circle(place(laser.bearing(static_cast<int>(k)), range), radius, {kReturn});
    }
}

/// Draws a triangle that points to bearing 0.
void drawSensor(Picture& picture, const PageLayout& layout) {
    const double metre = layout.extent / layout.disc, size = 0.62 * layout.em * metre;
    const Polygon mark = {
        {0, 1.15 * size}, {-0.8 * size, -0.75 * size}, {0.8 * size, -0.75 * size}};
    picture.area(mark, {kInk});
    picture.area(mark, {Stroke{Color::rgb(0xFFFFFF), 1.2}});
}

std::string subtitle(const Laser& laser, const Scan& scan) {
    const auto hits = std::count_if(scan.ranges.begin(), scan.ranges.end(),
                                    [](float range) { return std::isfinite(range); });
    std::string text = std::to_string(hits);
    text.append(" of ").append(std::to_string(scan.ranges.size())).append(" beams return · ");
    text.append(degrees(laser.span()));
    text.append(" field of view · ");
    return text.append("range ")
        .append(metres(laser.min_range))
        .append(" to ")
        .append(metres(laser.max_range));
}

}  // namespace

std::string obstacleMapPng(const Sensor& sensor, const Scan& scan, int pixels) {
    const Laser& laser = sensor.as<Laser>();
    Picture picture(pixels, pixels);
    const PageLayout layout(laser, scan, pixels);
    const double margin = layout.em, room = layout.size - 2 * margin;
    const TextStyle title{1.25 * layout.em, true, Align::Left, kInk, {}};
    const TextStyle small{layout.em, false, Align::Left, kFaint, {}};
    std::string heading = pictureTitle(sensor.id, laser.model, "laser", scan.frame, scan.pose);
    if (laser.sweep != SweepAxis::None)
        heading.append(", scan ").append(std::to_string(scan.number));
    picture.text({margin, 1.8 * layout.em}, fitText(heading, room, title), title);
    picture.text({margin, 3.3 * layout.em}, fitText(subtitle(laser, scan), room, small), small);

    picture.pushView({layout.disc / layout.extent, {}, layout.center});
    drawView(picture, laser, layout.extent);
    drawGrid(picture, layout);
    drawLabels(picture, layout);
    drawReturns(picture, laser, scan, layout);
    drawSensor(picture, layout);
    picture.pop();
    return picture.write(PictureFormat::Png);
}

const ReadingDrawings& readingDrawings() {
    static constexpr ReadingDrawings kDrawings{obstacleMapPng, colorDepthPng};
    return kDrawings;
}

}  // namespace ispace
