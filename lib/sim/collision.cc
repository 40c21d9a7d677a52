// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/collision.h"

#include <algorithm>
#include <cassert>

#include "geom/predicates.h"

namespace ispace {

namespace {

std::vector<Segment2> linesOf(const Band& band) {
    std::vector<Segment2> lines;
    band.forEachLine([&](const Segment2& line) { lines.push_back(line); });
    return lines;
}

/// The way of a place past the origin.
struct RelativeWay {
    Vec2 from, to;

    [[nodiscard]] double nearest() const {
        return distance(Point2{}, Segment2{{from.x, from.y}, {to.x, to.y}});
    }
    /// As Obstacles::stop.
    [[nodiscard]] bool stops(double reach) const {
        const double least = nearest();
        return least < reach && least < length(from);
    }
};

}  // namespace

double distance(const Segment2& s, const Segment2& t) {
    if (intersects(s, t)) return 0;
    return std::min({distance(s.a, t), distance(s.b, t), distance(t.a, s), distance(t.b, s)});
}

Obstacles::Obstacles(const Band& band)
    : solids_(band.solids),
      lines_(linesOf(band)),
      solid_owners_(band.solid_owners),
      grid_(lines_, 0) {
    boxes_.reserve(solids_.size());
    for (const Polygon& solid : solids_) boxes_.push_back(bounds(solid));
    // In the order of Band::forEachLine.
    line_owners_ = band.sheet_owners;
    for (std::size_t i = 0; i < solids_.size(); ++i)
        line_owners_.insert(line_owners_.end(), solids_[i].size(), solid_owners_[i]);
    assert(line_owners_.size() == lines_.size());
}

/// The owner of a line that comes nearer than `reach` to p and for which the test holds.
template <typename Test>
std::optional<std::size_t> Obstacles::find(Point2 p, double reach, Test test) const {
    std::optional<std::size_t> owner;
    const auto visit = [&](std::span<const std::uint32_t> cell) {
        for (const std::uint32_t i : cell) {
            if (owner) return;
            if (test(lines_[i])) owner = line_owners_[i];
        }
    };
    grid_.searchFrom(p, visit, [&](double seen) { return owner || seen >= reach; });
    return owner;
}

std::optional<std::size_t> Obstacles::overlap(Point2 center, double radius) const {
    const double allowed = radius - kTouch;
    const auto owner = find(center, allowed,
                            [&](const Segment2& line) { return distance(center, line) < allowed; });
    if (owner) return owner;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
        const auto& [low, high] = boxes_[i];
        const bool in_box =
            low.x <= center.x && center.x <= high.x && low.y <= center.y && center.y <= high.y;
        if (in_box && locate(solids_[i], center) != Side::Outside) return solid_owners_[i];
    }
    return std::nullopt;
}

double Obstacles::nearest(Point2 p, double farthest) const {
    double nearest = farthest;
    const auto visit = [&](std::span<const std::uint32_t> cell) {
        for (const std::uint32_t i : cell) nearest = std::min(nearest, distance(p, lines_[i]));
    };
    grid_.searchFrom(p, visit, [&](double seen) { return seen >= nearest; });
    return nearest;
}

bool Obstacles::near(const Segment2& way, double distance) const {
    const double reach = distance + ispace::distance(way.a, way.b);
    const auto owner = find(way.a, reach, [&](const Segment2& line) {
        return ispace::distance(way.a, line) < reach && ispace::distance(way, line) < distance;
    });
    return owner.has_value();
}

std::optional<std::size_t> Obstacles::stop(const Segment2& way, double radius) const {
    const double allowed = radius - kTouch;
    const double reach = allowed + distance(way.a, way.b);
    return find(way.a, reach, [&](const Segment2& line) {
        const double start = distance(way.a, line);
        if (start >= reach) return false;
        const double least = distance(way, line);
        return least < allowed && least < start;
    });
}

Point2 Move::place(int part) const {
    if (part == 0 || to.path == 0) return start();
    if (part == kParts) return end();
    return advance(*from, *limits, duration * part / kParts).motion.pose.position;
}

void Move::cancel() {
    to = {.motion = *from};
    to.motion.halt();
}

std::optional<std::size_t> collides(const Move& move, const Obstacles& obstacles) {
    if (!obstacles.near(move.chord(), move.radius - kTouch + move.to.bulge)) return std::nullopt;
    if (move.to.bulge == 0) return obstacles.stop(move.chord(), move.radius);
    Point2 last = move.start();
    for (int part = 1; part <= Move::kParts; ++part) {
        const Point2 next = move.place(part);
        if (const auto owner = obstacles.stop({last, next}, move.radius)) return owner;
        last = next;
    }
    return std::nullopt;
}

bool collides(const Move& move, const Move& other, bool other_moves) {
    const double reach = move.radius + other.radius - kTouch;
    const Point2 other_end = other_moves ? other.end() : other.start();
    const RelativeWay way{move.start() - other.start(), move.end() - other_end};
    const double lag = move.to.lag + (other_moves ? other.to.lag : 0);
    // Most are too far apart for any way to meet.
    const double farthest = reach + lag + move.to.path + (other_moves ? other.to.path : 0);
    if (dot(way.from, way.from) > farthest * farthest) return false;
    if (way.nearest() >= reach + lag) return false;
    if (lag == 0) return way.stops(reach);
    Vec2 last = way.from;
    for (int part = 1; part <= Move::kParts; ++part) {
        const Vec2 next = move.place(part) - (other_moves ? other.place(part) : other.start());
        if (RelativeWay{last, next}.stops(reach)) return true;
        last = next;
    }
    return false;
}

}  // namespace ispace
