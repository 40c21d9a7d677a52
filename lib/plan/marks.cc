// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/marks.h"

#include <array>
#include <cmath>

namespace ispace {

namespace {

bool overlap(const Box2& a, const Box2& b) {
    return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

bool contains(const Box2& outer, const Box2& inner) {
    return outer.low.x <= inner.low.x && inner.high.x <= outer.high.x &&
           outer.low.y <= inner.low.y && inner.high.y <= outer.high.y;
}

Box2 boxAround(Point2 p, double half_width, double half_height) {
    return {{p.x - half_width, p.y - half_height}, {p.x + half_width, p.y + half_height}};
}

/// The mark's body about the origin, y up.
void fillBody(Picture& picture, SensorSign sign, double radius, Color color, double rim = 0) {
    Polygon curve;
    if (sign == SensorSign::Disc) {
        picture.circle({}, radius + rim, {color});
        return;
    }
    if (sign == SensorSign::Square) {
        const double half = 0.9 * radius;
        curve = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    } else {
        const double tip = 1.35 * radius, side = std::sqrt(0.75) * tip;
        curve = {{0, tip}, {-side, -tip / 2}, {side, -tip / 2}};
    }
    if (rim > 0)
        picture.area(curve, {color, Stroke{color, 2 * rim}});
    else
        picture.area(curve, {color});
}

}  // namespace

BearingSpan bearingsOf(const Scene& scene, const Placed& placed) {
    const Record& record = scene.records[placed.record];
    const SensorKind* kind = sensorKind(record.keyword());
    if (kind != nullptr && kind->bearings != nullptr)
        return kind->bearings(scene.sensors[placed.index].model);
    BearingSpan span{Angle::degrees(-22.5), Angle::degrees(22.5), 5};
    if (record.has("fov")) {
        const Angle fov = Angle::degrees(record.tuple("fov").front());
        span = {-0.5 * fov, 0.5 * fov, 5};
    }
    if (record.has("range")) span.range = record.tuple("range").back();
    return span;
}

std::optional<Angle> headingOf(const Pose3& pose) {
    constexpr double kSteep = 0.02;  // of a direction's level part: no more than a degree
    const Vec3 forward = pose.beam(Angle());
    if (length(Vec2{forward.x, forward.y}) <= kSteep) return std::nullopt;
    return directionOf(forward.x, forward.y);
}

void drawSensorMark(Picture& picture, Point2 page, const SensorMark& mark, double radius) {
    using palette::kWhite;
    picture.pushView({1, {0, 0}, page});
    if (mark.heading) {
        const Vec2 forward = unitVector(*mark.heading), left = perpendicular(forward);
        const Point2 center, tip = center + 3.4 * radius * forward;
        const Point2 neck = center + 1.9 * radius * forward;
        const Polygon head = {tip, neck + 0.85 * radius * left, neck - 0.85 * radius * left};
        picture.line(center, neck, {kWhite, radius});
        picture.area(head, {Stroke{kWhite, 0.6 * radius}});
        picture.line(center, neck, {mark.color, 0.5 * radius});
        picture.area(head, {mark.color});
    }
    fillBody(picture, mark.sign, radius, kWhite, 0.3 * radius);
    fillBody(picture, mark.sign, radius, mark.color);
    if (mark.hollow) fillBody(picture, mark.sign, 0.5 * radius, kWhite);
    picture.pop();
}

void LabelPlacer::addMark(Point2 page, std::optional<Angle> heading) {
    marks_.push_back(boxAround(page, 0.45 * em_, 0.45 * em_));
    if (!heading) return;
    const Vec2 forward = em_ * unitVector(*heading);
    marks_.push_back(boxAround({page.x + forward.x, page.y - forward.y}, 0.4 * em_, 0.4 * em_));
}

Point2 LabelPlacer::placeSign(Point2 page, double radius) {
    const double half = radius + 0.1 * em_;
    Point2 best = page;
    double least = costOf(boxAround(page, half, half));
    for (const double away : {1.2, 2.4}) {
        for (int turn = 0; turn < 8 && least > 0; ++turn) {
            const Vec2 off = away * em_ * unitVector(Angle::degrees(45.0 * turn));
            const Point2 place{page.x + off.x, page.y - off.y};
            if (const double cost = costOf(boxAround(place, half, half)) + away; cost < least) {
                least = cost;
                best = place;
            }
        }
    }
    labels_.push_back(boxAround(best, half, half));
    return best;
}

std::optional<Point2> LabelPlacer::placeLabel(Point2 page, Angle heading, double width, double size,
                                              bool crowd) {
    constexpr std::array<double, 8> kTurns = {180, 135, -135, 90, -90, 45, -45, 0};
    const double half_width = width / 2 + 0.15 * em_, half_height = 0.55 * size;
    std::optional<Point2> best;
    double least = crowd ? 1 : 100;  // of places that are worse than no label
    for (std::size_t i = 0; i < kTurns.size(); ++i) {
        const Vec2 away = unitVector(heading + Angle::degrees(kTurns[i]));
        const Point2 middle{page.x + away.x * (0.6 * em_ + half_width),
                            page.y - away.y * (0.6 * em_ + half_height)};
        const Box2 box = boxAround(middle, half_width, half_height);
        if (const double cost = costOf(box) + static_cast<double>(i) / 10; cost < least) {
            least = cost;
            best = middle;
        }
    }
    if (best) labels_.push_back(boxAround(*best, half_width, half_height));
    return best;
}

bool LabelPlacer::take(const Box2& box) {
    if (costOf(box) > 0) return false;
    labels_.push_back(box);
    return true;
}

double LabelPlacer::costOf(const Box2& box) const {
    double cost = contains(frame_, box) ? 0 : 100;
    for (const Box2& label : labels_) cost += overlap(label, box) ? 100 : 0;
    for (const Box2& mark : marks_) cost += overlap(mark, box) ? 5 : 0;
    return cost;
}

}  // namespace ispace
