// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/utf8.h"
#include "cover/map_parts.h"

namespace ispace {

namespace {

constexpr std::size_t kCrowd = 40;  // marks and labels of more sensors are smaller

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

/// Puts signs and labels where they cover least. All on the page.
class LabelPlacer {
  public:
    LabelPlacer(const Box2& frame, double em) : frame_(frame), em_(em) {}

    /// A mark and its arrow, which nothing should cover.
    void addMark(Point2 page, std::optional<Angle> heading) {
        marks_.push_back(boxAround(page, 0.45 * em_, 0.45 * em_));
        if (!heading) return;
        const Vec2 forward = em_ * unitVector(*heading);
        marks_.push_back(boxAround({page.x + forward.x, page.y - forward.y}, 0.4 * em_, 0.4 * em_));
    }

    /// Place for the sign of a spot: its own, or the next one around it that is free.
    Point2 placeSign(Point2 page) {
        const double half = (kSpotRadius + 0.1) * em_;
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

    /// Middle of the label of a mark, or nothing where it would cover another label, or another
    /// mark in a crowd. Of the places around the mark, those behind the heading come first.
    std::optional<Point2> placeLabel(Point2 page, Angle heading, double text_width,
                                     double text_size, bool crowd) {
        constexpr std::array<double, 8> kTurns = {180, 135, -135, 90, -90, 45, -45, 0};
        const double half_width = text_width / 2 + 0.15 * em_, half_height = 0.55 * text_size;
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

    /// True if nothing else lies in the box, which is then taken.
    bool take(const Box2& box) {
        if (costOf(box) > 0) return false;
        labels_.push_back(box);
        return true;
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

/// The mark's body about the origin, y up.
Polygon bodyOf(ViewKind kind, double radius) {
    if (kind == ViewKind::Ranger) {
        const double half = 0.9 * radius;
        return {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    }
    const double tip = 1.35 * radius, side = std::sqrt(0.75) * tip;
    return {{0, tip}, {-side, -tip / 2}, {side, -tip / 2}};
}

void fillBody(Picture& picture, ViewKind kind, double radius, Color color, double rim = 0) {
    if (kind == ViewKind::Laser) {
        picture.circle({}, radius + rim, {color});
        return;
    }
    const Polygon body = bodyOf(kind, radius);
    if (rim > 0) picture.area(body, {Stroke{color, 2 * rim}});
    picture.area(body, {color});
}

Point2 pageOf(const MapPicture& map, const SensorView& sensor) {
    return map.view * sensor.pose.position.onFloor();
}

/// Marks of those that stand on the plan; `hollow`: of the layout that this one is compared with.
void drawSensors(Picture& picture, const MapPicture& map, const Box2& frame, bool hollow,
                 LabelPlacer& places) {
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    const double radius = map.em * (sensors.size() > kCrowd ? 0.24
                                    : sensors.size() > 14   ? 0.3
                                                            : 0.36);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const Point2 page = pageOf(map, sensors[i]);
        if (!contains(frame, {page, page})) continue;
        SensorMark mark = markOf(map, i);
        mark.hollow = hollow;
        if (hollow) mark.color = palette::kOtherSensor;
        // On top of another one it is smaller, so that both are seen.
        const auto is_here = [&](const SensorView& sensor) {
            return distance(pageOf(map, sensor), page) < 0.4 * radius;
        };
        const auto end = sensors.begin() + static_cast<std::ptrdiff_t>(i);
        const bool on_top = std::any_of(sensors.begin(), end, is_here);
        drawSensorMark(picture, page, mark, on_top ? 0.5 * radius : radius);
        places.addMark(page, mark.heading);
    }
}

void drawIds(Picture& picture, const MapPicture& map, const Box2& frame, LabelPlacer& places) {
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    const bool crowd = sensors.size() > kCrowd;
    const double size = crowd ? std::max(10.0, 0.7 * map.em) : map.em;
    const TextStyle style{size, true, Align::Center, palette::kInk, palette::kWhite.faded(0.85)};
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const Point2 page = pageOf(map, sensors[i]);
        if (!contains(frame, {page, page})) continue;
        const std::string id = fitText(sensors[i].id, 10 * size, style);
        const Angle heading = markOf(map, i).heading.value_or(Angle());
        if (const auto middle = places.placeLabel(page, heading, textWidth(id, style), size, crowd))
            picture.text({middle->x, middle->y + 0.36 * size}, id, style);
    }
}

/// Names of zones in their first free corner; the legend names those that have no room.
void drawZoneNames(Picture& picture, const MapPicture& map, LabelPlacer& places) {
    const double size = std::max(10.0, 0.85 * map.em), inset = 0.4 * map.em;
    const TextStyle style{size, false, Align::Left, palette::kZone, palette::kWhite.faded(0.8)};
    for (const Element& element : map.scene.environment.elements()) {
        if (element.record.keyword() != "zone") continue;
        const Box2 zone = bounds(zoneOutline(element.record));
        const Point2 low = map.view * Point2{zone.low.x, zone.high.y};  // y is down on the page
        const Point2 high = map.view * Point2{zone.high.x, zone.low.y};
        const double room = high.x - low.x - 2 * inset;
        const std::string name = fitText(element.id, room, style);
        const double width = textWidth(name, style);
        if (width > room || (room < 5 * size && name != printable(element.id))) continue;
        for (const Point2 corner :
             {Point2{low.x + inset, high.y - inset - size}, Point2{low.x + inset, low.y + inset},
              Point2{high.x - inset - width, high.y - inset - size},
              Point2{high.x - inset - width, low.y + inset}}) {
            if (!places.take({corner, {corner.x + width, corner.y + size}})) continue;
            picture.text({corner.x, corner.y + 0.86 * size}, name, style);
            break;
        }
    }
}

}  // namespace

SensorMark markOf(const MapPicture& map, std::size_t sensor) {
    constexpr double kSteep = 0.02;  // of a direction's level part: no more than a degree
    const SensorView& view = map.coverage.sensors[sensor];
    const Vec3 forward = view.pose.beam(Angle());
    SensorMark mark{view.kind, {}, sensorColor(map, sensor)};
    if (length(Vec2{forward.x, forward.y}) > kSteep)
        mark.heading = directionOf(forward.x, forward.y);
    return mark;
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
    fillBody(picture, mark.kind, radius, kWhite, 0.3 * radius);
    fillBody(picture, mark.kind, radius, mark.color);
    if (mark.hollow) fillBody(picture, mark.kind, 0.5 * radius, kWhite);
    picture.pop();
}

void drawSpotSign(Picture& picture, Point2 page, const std::string& number, double em) {
    picture.circle(page, kSpotRadius * em, {palette::kWhite});
    picture.circle(page, kSpotRadius * em, {Stroke{palette::kInk, em / 12}});
    const TextStyle style{std::max(10.0, 0.85 * em), true, Align::Center, palette::kInk, {}};
    picture.text({page.x, page.y + 0.36 * style.size}, number, style);
}

std::size_t markedSpots(const MapPicture& map) {
    constexpr double kLeastShare = 0.0025;  // of the room
    const CoverageReport& report = map.coverage.report;
    const std::size_t most = std::min<std::size_t>(map.terse ? 3 : 5, report.unseen.size());
    std::size_t count = 0;
    while (count < most && report.unseen[count].area >= kLeastShare * report.indoor_area) ++count;
    return count;
}

void drawMarks(Picture& picture, const MapPicture& map, const Box2& frame) {
    LabelPlacer places(frame, map.em);
    if (map.other != nullptr) {
        const MapPicture other{map.scene, *map.other, map.options, nullptr, map.em, map.view};
        drawSensors(picture, other, frame, true, places);
    }
    drawSensors(picture, map, frame, false, places);
    for (std::size_t i = 0; i < markedSpots(map); ++i) {
        const Point2 page = map.view * map.coverage.report.unseen[i].place;
        drawSpotSign(picture, places.placeSign(page), std::to_string(i + 1), map.em);
    }
    drawIds(picture, map, frame, places);
    drawZoneNames(picture, map, places);
}

}  // namespace ispace
