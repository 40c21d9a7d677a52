// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/obstacle_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "draw/color.h"
#include "draw/picture.h"
#include "sense/figure_parts.h"

namespace ispace {

namespace {

using palette::kInk;
constexpr Color kFaint = palette::kFaintInk;
constexpr Color kGrid = Color::rgb(0xC8CCD0), kView = Color::rgb(0xEAF2F9);
constexpr Color kViewEdge = Color::rgb(0x9DBAD5), kReturn = Color::rgb(0xC0392B);

/// Bearing 0 is up, positive ones to the left.
Angle onPage(Angle bearing) { return bearing + Angle::degrees(90); }
Point2 place(Angle bearing, double range) { return Point2{} + range * unitVector(onPage(bearing)); }

/// The figure's measures, in pixels if not said otherwise.
struct Layout {
    double size;    ///< of the page
    double em;      ///< of text
    double disc;    ///< radius of the polar grid
    double extent;  ///< metres at the rim of the disc
    double ring;    ///< metres from ring to ring
    Point2 center;

    Layout(const Laser& laser, const Scan& scan, int pixels)
        : size(pixels), em(std::clamp(pixels / 48.0, 7.0, 40.0)) {
        double farthest = 0;
        for (const float range : scan.ranges)
            if (std::isfinite(range)) farthest = std::max<double>(farthest, range);
        // A scan of a desk by a sensor that reaches far shows the desk.
        const double limit = std::max(laser.max_range, 0.001);
        if (farthest == 0) farthest = limit;
        constexpr double kFewestRings = 4;
        ring = roundStep(farthest / kFewestRings / 1.3);
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

void drawGrid(Picture& picture, const Layout& layout) {
    const Stroke fine{kGrid, 1};
    const int rings = static_cast<int>(std::floor(layout.extent / layout.ring + 1e-6));
    for (int k = 1; k <= rings; ++k) picture.circle({}, k * layout.ring, {fine});
    picture.circle({}, layout.extent, {Stroke{kFaint, 1}});
    for (int degrees = 0; degrees < 360; degrees += 30)
        picture.line(place(Angle::degrees(degrees), 0.25 * layout.ring),
                     place(Angle::degrees(degrees), layout.extent), fine);
}

/// Text centred at a place of the page.
void writeAt(Picture& picture, Point2 page, std::string_view text, const TextStyle& style) {
    constexpr double kHalfCapital = 0.36;  // of the size
    picture.pushView({1, {}, {page.x, page.y + kHalfCapital * style.size}});
    picture.text({}, text, style);
    picture.pop();
}

/// Bearings outside the rim, distances on their rings.
void drawLabels(Picture& picture, const Layout& layout) {
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

void drawReturns(Picture& picture, const Laser& laser, const Scan& scan, const Layout& layout) {
    const double radius = std::clamp(layout.size / 380, 1.2, 6.0) * layout.extent / layout.disc;
    for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
        const double range = scan.ranges[k];
        if (std::isfinite(range))
            picture.circle(place(laser.bearing(static_cast<int>(k)), range), radius, {kReturn});
    }
}

/// A triangle that points to bearing 0.
void drawSensor(Picture& picture, const Layout& layout) {
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
    const Layout layout(laser, scan, pixels);
    const double margin = layout.em, room = layout.size - 2 * margin;
    const TextStyle title{1.25 * layout.em, true, Align::Left, kInk, {}};
    const TextStyle small{layout.em, false, Align::Left, kFaint, {}};
    std::string heading = figureTitle(sensor.id, laser.model, "laser", scan.frame, scan.pose);
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

}  // namespace ispace
