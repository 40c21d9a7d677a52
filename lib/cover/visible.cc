// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/visible.h"

#include <algorithm>
#include <cmath>

#include "cover/sight_outline.h"
#include "geom/overlay.h"
#include "sensor/field_of_view.h"

namespace ispace {

namespace {

/// The one rule for directions. \param direction in the world
bool sees(const Laser& laser, Angle heading, Angle direction) {
    const Angle bearing = direction - heading;
    if (laser.sees(bearing)) return true;
    if (laser.sweep != SweepAxis::Heading) return false;
    const FanLimits limits = fanLimits(laser, heading);
    const double beyond =
        std::fmod(std::fmod((direction - limits.first).degrees(), 360) + 360, 360);
    return beyond <= limits.span.degrees() + 1e-9;  // as Laser::sees has it
}

/// Cells strictly inside the outline of what a place sees; some may lie beyond the greatest range.
CellSet cellsAround(const Grid& grid, const SliceSight& sight, Point2 place, double max_range) {
    VisibleRegion region;
    sight.query(place, kBeyondRange * max_range, region);
    Polygon outline;
    outline.reserve(3 * region.edges.size());
    forEachCorner(region, [&outline](Point2 corner) { outline.push_back(corner); });
    CellSet cells = cellsWithin(grid, {&outline, 1});
    Slice touching;
    touching.solids = sight.solidsTouching(place);
    if (!touching.solids.empty()) cells -= cellsBlocked(grid, touching.solids);
    return cells;
}

/// Tells most directions apart without an arc tangent: surely in the fan, surely not, or too near
/// to one of its sides to say.
class FanFilter {
  public:
    FanFilter(const Laser& laser, Angle heading) {
        const FanLimits limits = fanLimits(laser, heading);
        is_gap_ = limits.span > Angle::degrees(180);
        const Angle last = limits.first + limits.span;
        // The lesser of the fan and the gap beside it is convex.
        from_ = unitVector(is_gap_ ? last : limits.first);
        to_ = unitVector(is_gap_ ? limits.first : last);
        is_whole_ = limits.span >= Angle::degrees(360);
        is_line_ = limits.span >= Angle::degrees(360 - 1e-3) || limits.span <= Angle::degrees(1e-3);
    }
    enum class Answer { Yes, No, Unsure };
    [[nodiscard]] Answer operator()(Vec2 offset) const {
        constexpr double kMargin = 1e-6;  // radians: far more than what rounds
        const double margin = kMargin * (std::abs(offset.x) + std::abs(offset.y));
        if (is_whole_) return Answer::Yes;
        if (is_line_) return Answer::Unsure;
        const double left = cross(from_, offset), right = cross(offset, to_);
        if (left > margin && right > margin) return is_gap_ ? Answer::No : Answer::Yes;
        if (left < -margin || right < -margin) return is_gap_ ? Answer::Yes : Answer::No;
        return Answer::Unsure;
    }

  private:
    Vec2 from_, to_;
    bool is_gap_ = false, is_line_ = false, is_whole_ = false;
};

}  // namespace

bool scansSlice(const Laser& laser, const Pose3& pose) {
    return pose.isLevel() && (laser.sweep == SweepAxis::None || laser.sweep == SweepAxis::Heading);
}

bool scansSlice(const Sensor& sensor) {
    return sensor.is<Laser>() && scansSlice(sensor.as<Laser>(), sensor.pose);
}

FanLimits fanLimits(const Laser& laser, Angle heading) {
    return {heading + laser.first, laser.sweptSpan()};
}

std::vector<Curve> regionSeen(const SliceSight& sight, const Sensor& sensor) {
    const Point2 place = sensor.pose.position.onFloor();
    VisibleRegion region;
    sight.query(place, sensor.as<Laser>().max_range, region);
    const FanLimits limits = fanLimits(sensor.as<Laser>(), sensor.pose.heading);
    Curve outline = outlineOf(sectorOf(region, limits.first, limits.span));
    if (outline.empty()) return {};
    const std::vector<Polygon> solids = sight.solidsTouching(place);
    if (solids.empty()) return {std::move(outline)};
    std::vector<Layer> layers = {{.curves = {std::move(outline)}, .counts = false, .marks = 1}};
    for (const Polygon& solid : solids) layers.push_back({.curves = {curveOf(solid)}});
    return Overlay(layers).curves(
        [](const LayerLabel& label) { return label.marks == 1 && label.count == 0; });
}

VisibleCells visibleCells(const Grid& grid, const SliceSight& sight, Point2 place,
                          double max_range) {
    VisibleCells visible;
    cellsAround(grid, sight, place, max_range).forEach([&](std::size_t cell) {
        const Vec2 offset = grid.center(cell) - place;
        const auto far = static_cast<float>(length(offset));
        if (withinRange(static_cast<double>(far), max_range))
            visible.entries.push_back(
                {static_cast<std::uint32_t>(cell), far, directionOf(offset.x, offset.y).degrees()});
    });
    return visible;
}

CellSet cellsInFan(const Grid& grid, const VisibleCells& visible, const Laser& laser,
                   Angle heading) {
    CellSet cells(grid.size());
    for (const VisibleCells::Entry& entry : visible.entries)
        if (withinRange(static_cast<double>(entry.distance), laser.max_range) &&
            (entry.distance == 0 || sees(laser, heading, Angle::degrees(entry.direction))))
            cells.set(entry.cell);
    return cells;
}

CellSet cellsSeen(const Grid& grid, const SliceSight& sight, const Sensor& sensor) {
    const Point2 place = sensor.pose.position.onFloor();
    const Laser& laser = sensor.as<Laser>();
    const FanFilter filter(laser, sensor.pose.heading);
    CellSet cells = cellsAround(grid, sight, place, laser.max_range);
    const CellSet around = cells;
    around.forEach([&](std::size_t cell) {
        const Vec2 offset = grid.center(cell) - place;
        const FanFilter::Answer answer = filter(offset);
        if (answer == FanFilter::Answer::No || !withinRange(length(offset), laser.max_range) ||
            (answer == FanFilter::Answer::Unsure && offset != Vec2{} &&
             !sees(laser, sensor.pose.heading, directionOf(offset.x, offset.y))))
            cells.reset(cell);
    });
    return cells;
}

CellSet cellsAmongBeams(const Grid& grid, const Sensor& sensor, std::span<const float> beams) {
    const Point3 origin = sensor.pose.position;
    Polygon outline;
    outline.reserve(beams.size() + 1);
    for (std::size_t k = 0; k < beams.size(); ++k) {
        const double range = std::min(static_cast<double>(beams[k]), sensor.as<Laser>().max_range);
        const Vec3 beam = sensor.pose.beam(sensor.as<Laser>().bearing(static_cast<int>(k)));
        outline.push_back((origin + range * beam).onFloor());
    }
    if (sensor.as<Laser>().span() < Angle::degrees(360)) outline.push_back(origin.onFloor());
    const std::vector<Polygon> curves = {std::move(outline)};
    return cellsWithin(grid, curves);
}

}  // namespace ispace
