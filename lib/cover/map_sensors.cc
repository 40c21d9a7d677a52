// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <optional>

#include "cover/map_parts.h"

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

/// Puts labels beside their marks where they cover least.
class LabelPlacer {
  public:
    LabelPlacer(const Box2& frame, double em) : frame_(frame), em_(em) {}

    /// A mark and its arrow, which labels should not cover.
    void addMark(Point2 page, Angle heading) {
        const Vec2 forward = em_ * unitVector(heading);
        marks_.push_back(boxAround(page, 0.45 * em_, 0.45 * em_));
        marks_.push_back(boxAround({page.x + forward.x, page.y - forward.y}, 0.4 * em_, 0.4 * em_));
    }

    /// Middle of the label of a mark, or nothing where it would cover another label. Of the places
    /// around the mark, those behind the heading come first.
    std::optional<Point2> place(Point2 page, Angle heading, double text_width) {
        constexpr std::array<double, 8> kTurns = {180, 135, -135, 90, -90, 45, -45, 0};
        const double half_width = text_width / 2 + 0.15 * em_, half_height = 0.55 * em_;
        std::optional<Point2> best;
        double least = 100;  // of places that are worse than no label
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

  private:
    [[nodiscard]] double costOf(const Box2& box) const {
        double cost = contains(frame_, box) ? 0 : 100;
        for (const Box2& label : labels_) cost += overlap(label, box) ? 100 : 0;
        for (const Box2& mark : marks_) cost += overlap(mark, box) ? 5 : 0;
        return cost;
    }

    Box2 frame_;
    double em_;
    std::vector<Box2> marks_, labels_;
};

}  // namespace

Stroke sensorStroke(std::size_t index, std::size_t sensors, double em) {
    const bool many = sensors > 2 * kSeriesColors;
    Stroke stroke{seriesColor(index).faded(many ? 0.6 : 0.95), em / (many ? 16 : 9)};
    if (index / kSeriesColors % 2 == 1) stroke.dashes = {em / 2, em / 4};
    return stroke;
}

void drawSensorMark(Canvas& canvas, Point2 page, Angle heading, double radius, Color color) {
    canvas.pushView({1, {0, 0}, page});
    const Vec2 forward = unitVector(heading), left = perpendicular(forward);
    const Point2 center, tip = center + 3.4 * radius * forward;
    const Point2 neck = center + 1.9 * radius * forward;
    const Polygon head = {tip, neck + 0.85 * radius * left, neck - 0.85 * radius * left};
    const Stroke rim{map_colors::kWhite, radius};
    canvas.line(center, neck, rim);
    canvas.stroke(head, {map_colors::kWhite, 0.6 * radius});
    canvas.fillCircle(center, 1.3 * radius, map_colors::kWhite);
    canvas.line(center, neck, {color, 0.5 * radius});
    canvas.fill(head, color);
    canvas.fillCircle(center, radius, color);
    canvas.pop();
}

void drawSensors(Canvas& canvas, const Scene& scene, const PageView& view, const Box2& frame,
                 double em) {
    const double radius = (scene.lasers.size() > 2 * kSeriesColors ? 0.28 : 0.36) * em;
    TextStyle style{em, true, Align::Center, map_colors::kInk, map_colors::kWhite.faded(0.85)};
    LabelPlacer labels(frame, em);
    const auto is_on_plan = [&](Point2 page) { return contains(frame, {page, page}); };
    for (const PlacedLaser& sensor : scene.lasers)
        if (const Point2 page = view * sensor.pose.position.onFloor(); is_on_plan(page))
            labels.addMark(page, sensor.pose.heading);
    for (std::size_t i = 0; i < scene.lasers.size(); ++i) {
        const Pose3& pose = scene.lasers[i].pose;
        if (const Point2 page = view * pose.position.onFloor(); is_on_plan(page))
            drawSensorMark(canvas, page, pose.heading, radius, seriesColor(i));
    }
    for (const PlacedLaser& sensor : scene.lasers) {
        const Point2 page = view * sensor.pose.position.onFloor();
        if (!is_on_plan(page)) continue;
        const std::string id = fitText(sensor.id, 10 * em, style);
        if (const auto middle = labels.place(page, sensor.pose.heading, textWidth(id, style)))
            canvas.text({middle->x, middle->y + 0.36 * em}, id, style);
    }
}

}  // namespace ispace
