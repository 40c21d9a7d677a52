// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "cover/map_parts.h"
#include "raster/contour.h"

namespace ispace {

namespace {

constexpr std::size_t kManySensors = 2 * kSeriesColors;  // lines become finer

/// Contours of what a sensor or a set sees.
template <typename View>
std::vector<Polygon> contoursOf(const MapPicture& map, const View& view) {
    if (view.region) return drawable(map, *view.region);
    return drawable(map, contours(map.coverage.target.grid, view.cells));
}

void drawContours(Picture& picture, const MapPicture& map, const std::vector<Polygon>& curves,
                  const Stroke& line) {
    constexpr std::size_t kMostBands = 12;  // soft rims help to tell few views apart, and hide many
    const bool plain = map.other == nullptr && map.options.color == MapColor::Redundancy;
    if (plain && map.coverage.sets.size() <= kMostBands) {
        const Box2& limits = map.limits();
        const double rim = std::min(
            0.9 * map.em, 0.04 * map.view.scale * std::min(limits.width(), limits.depth()));
        picture.pushClip(std::span(curves));
        picture.area(curves, {Stroke{line.color.faded(0.16), rim}});
        picture.pop();
    }
    // A pale rim lifts the line off stripes.
    if (map.other == nullptr && map.options.color == MapColor::Sensor)
        picture.area(curves, {Stroke{palette::kWhite.faded(0.7), line.width + map.em / 9}});
    picture.area(curves, {line});
}

/// The beams on the plan, from above: each to what it meets, or to the maximum range. Where the
/// ends of neighbours would lie too near each other, every second one is left out, or three of
/// four, ...
std::vector<Segment2> beamsOf(const MapPicture& map, const SensorView& view) {
    const Laser& laser = map.scene.lasers[view.index].laser;
    const double least_gap = std::max(2.0, map.em / 6) / map.view.scale;
    const Point3 origin = view.pose.position;
    std::vector<Segment2> beams;
    for (std::size_t k = 0; k < view.beams.size(); ++k) {
        const double range = std::min<double>(view.beams[k], view.max_range);
        const Vec3 way = range * view.pose.beam(laser.bearing(static_cast<int>(k)));
        const double gap = length(Vec2{way.x, way.y}) * std::abs(laser.step.radians());
        std::size_t stride = 1;
        while (static_cast<double>(stride) * gap < least_gap && stride < view.beams.size())
            stride *= 2;
        if (k % stride != 0) continue;
        const Segment2 beam{origin.onFloor(), (origin + way).onFloor()};
        if (const auto part = clipped(beam, map.limits())) beams.push_back(*part);
    }
    return beams;
}

/// A sweep has the beams of many scans: they would hide all.
bool showsBeams(const MapPicture& map, const SensorView& view) {
    return map.options.fans == FanStyle::Beams && view.kind == ViewKind::Laser &&
           !view.beams.empty() && map.scene.lasers[view.index].laser.sweep == SweepAxis::None;
}

void drawBeams(Picture& picture, const MapPicture& map, std::size_t sensor) {
    Stroke line = sensorStroke(map, sensor);
    line.dashes.clear();
    line.width = map.em / 24;
    line.color = line.color.faded(0.6);
    picture.lines(beamsOf(map, map.coverage.sensors[sensor]), {line});
}

}  // namespace

std::size_t setOf(const Coverage& coverage, std::size_t sensor) {
    if (coverage.sensors[sensor].kind != ViewKind::Receiver) return sensor;
    const auto first = std::find_if(coverage.sensors.begin(), coverage.sensors.end(),
                                    [](const auto& s) { return s.kind == ViewKind::Receiver; });
    return static_cast<std::size_t>(first - coverage.sensors.begin());
}

Color sensorColor(const MapPicture& map, std::size_t sensor) {
    return map.other != nullptr ? palette::kInk : setColor(map, setOf(map.coverage, sensor));
}

Stroke sensorStroke(const MapPicture& map, std::size_t sensor) {
    const double em = map.em;
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    const bool many = map.coverage.sets.size() > kManySensors;
    if (map.other != nullptr) return {palette::kInk.faded(many ? 0.3 : 0.55), em / 16};
    const Color color = sensorColor(map, sensor);
    Stroke stroke{color.faded(0.95), em / 9};
    if (many) stroke = {color.faded(sensors.size() > 3 * kManySensors ? 0.4 : 0.6), em / 18};
    const std::size_t set = setOf(map.coverage, sensor);
    std::size_t dashes = set / kSeriesColors % 2;
    if (map.options.color == MapColor::Sensor) dashes = set % 4;
    if (dashes == 1) stroke.dashes = {em / 2, em / 4};
    if (dashes == 2) stroke.dashes = {em / 6, em / 4};
    if (dashes == 3) stroke.dashes = {0.8 * em, em / 4, em / 6, em / 4};
    return stroke;
}

void drawViews(Picture& picture, const MapPicture& map) {
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const SensorView& view = sensors[i];
        const Stroke line = sensorStroke(map, i);
        if (view.kind == ViewKind::Receiver) {
            // What one of them hears counts for nothing alone.
            const Color faint = line.color.faded(0.5 * line.color.alpha);
            picture.area(contoursOf(map, view), {Stroke{faint, map.em / 24}});
        } else if (showsBeams(map, view)) {
            drawBeams(picture, map, i);
        } else {
            drawContours(picture, map, contoursOf(map, view), line);
        }
    }
    if (!sensors.empty() && sensors.back().kind == ViewKind::Receiver)
        drawContours(picture, map, contoursOf(map, map.coverage.sets.back()),
                     sensorStroke(map, sensors.size() - 1));
}

}  // namespace ispace
