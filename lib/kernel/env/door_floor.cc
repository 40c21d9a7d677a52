// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/door_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "env/environment.h"
#include "env/openings.h"
#include "env/walls.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Metres: a wall that begins above hides no floor.
constexpr double kKnee = 0.5;
/// Metres between two rays that pass a wall's end on either side.
constexpr double kBeside = 1e-7;
constexpr std::size_t kMostWalls = 100;

/// Adds a line without these pieces of it.
void addWithout(const Segment2& line, std::vector<Segment2> cuts, std::vector<Segment2>& walls) {
    const Vec2 way = line.b - line.a;
    const auto at = [&](Point2 p) { return dot(p - line.a, way); };
    for (Segment2& cut : cuts)
        if (at(cut.a) > at(cut.b)) std::swap(cut.a, cut.b);
    std::sort(cuts.begin(), cuts.end(),
              [&](const Segment2& a, const Segment2& b) { return at(a.a) < at(b.a); });
    Point2 begin = line.a;
    for (const Segment2& cut : cuts) {
        if (at(cut.a) > at(begin)) walls.push_back({begin, cut.a});
        if (at(cut.b) > at(begin)) begin = cut.b;
    }
    if (at(line.b) > at(begin)) walls.push_back({begin, line.b});
}

/// Returns the share of a way at which a wall ends it; 1 if none does.
double shareToWall(Point2 from, Vec2 way, const std::vector<Segment2>& walls) {
    double least = 1;
    for (const Segment2& wall : walls) {
        const Vec2 along = wall.b - wall.a, to = wall.a - from;
        const double turn = cross(way, along);
        if (turn == 0) continue;
        const double share = cross(to, along) / turn, beside = cross(to, way) / turn;
        if (beside >= 0 && beside <= 1 && share > 0) least = std::min(least, share);
    }
    return least;
}

/// The rays from a doorway's rectangle to the floor around it, counter-clockwise.
class Rays {
  public:
    Rays(const Doorway& door, double distance, std::vector<Segment2> walls)
        : distance_(distance), walls_(std::move(walls)) {
        const Vec2 way = door.line.b - door.line.a;
        along_ = 1 / length(way) * way;
        across_ = perpendicular(along_);
        const Vec2 aside = door.thickness / 2 * across_;
        corners_ = {door.line.b - aside, door.line.b + aside, door.line.a + aside,
                    door.line.a - aside};
        if (walls_.size() <= kMostWalls) findMarks();
    }

    Polygon outline() {
        for (std::size_t quarter = 0; quarter < corners_.size(); ++quarter) {
            addRound(quarter);
            addSide(quarter);
        }
        simplify();
        return std::move(outline_);
    }

  private:
    static constexpr int kChords = 16;

    /// Removes corners beside others, and those on the way from the one before to the one behind.
    void simplify() {
        constexpr double kSame = 1e-5, kFlat = 1e-6;  // metres
        Polygon kept;
        for (const Point2 p : outline_) {
            if (!kept.empty() && distance(kept.back(), p) < kSame) continue;
            if (kept.size() > 1) {
                const Point2 before = kept[kept.size() - 2];
                const Vec2 way = p - before, to = kept.back() - before;
                const double along = dot(way, to);
                if (along > 0 && along < dot(way, way) &&
                    std::abs(cross(way, to)) < kFlat * length(way))
                    kept.pop_back();
            }
            kept.push_back(p);
        }
        while (kept.size() > 1 && distance(kept.front(), kept.back()) < kSame) kept.pop_back();
        outline_ = std::move(kept);
    }
    void findMarks() {
        for (const Segment2& wall : walls_) marks_.insert(marks_.end(), {wall.a, wall.b});
        for (std::size_t i = 0; i < walls_.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) {
                const Vec2 way = walls_[i].b - walls_[i].a;
                const Vec2 other = walls_[k].b - walls_[k].a;
                if (cross(way, other) == 0 || !intersects(walls_[i], walls_[k])) continue;
                marks_.push_back(walls_[i].a +
                                 cross(walls_[k].a - walls_[i].a, other) / cross(way, other) * way);
            }
    }
    [[nodiscard]] Vec2 direction(double angle) const {
        return std::cos(angle) * along_ + std::sin(angle) * across_;
    }
    void addRay(Point2 from, Vec2 way) {
        outline_.push_back(from + shareToWall(from, way, walls_) * way);
    }
    /// Adds the places beside each mark that lie between `low` and `high`.
    template <typename Place>
    static void addBeside(const std::vector<Point2>& marks, double low, double high, double beside,
                          Place at, std::vector<double>& places) {
        for (const Point2 mark : marks) {
            const double place = at(mark);
            for (const double one : {place - beside, place + beside})
                if (one > low && one < high) places.push_back(one);
        }
    }

    /// Adds rays about a corner.
    void addRound(std::size_t quarter) {
        // A hair towards the middle, so that a wall that begins at the corner is in front of it.
        constexpr double kHair = 1e-6;
        const Point2 corner = corners_[quarter] + (quarter < 2 ? -kHair : kHair) * along_;
        const auto angle_of = [quarter](int chord) {
            return std::numbers::pi / 2 *
                   (static_cast<double>(quarter) - 1 + static_cast<double>(chord) / kChords);
        };
        const double low = angle_of(0), high = angle_of(kChords), middle = (low + high) / 2;
        const Vec2 ahead = direction(middle);
        std::vector<double> angles;
        for (int i = 0; i <= kChords; ++i) angles.push_back(angle_of(i));
        const auto at = [&](Point2 mark) {
            const Vec2 to = mark - corner;
            return middle + std::atan2(cross(ahead, to), dot(ahead, to));
        };
        std::vector<Point2> marks = marks_;
        if (!marks.empty()) addLeaving(corner, marks);
        addBeside(marks, low, high, kBeside / distance_, at, angles);
        std::sort(angles.begin(), angles.end());
        for (const double angle : angles) addRay(corner, distance_ * direction(angle));
    }

    /// Adds the points at which walls leave the circle about a corner.
    void addLeaving(Point2 corner, std::vector<Point2>& marks) const {
        for (const Segment2& wall : walls_) {
            const Vec2 way = wall.b - wall.a, from = wall.a - corner;
            const double square = dot(way, way), half = dot(way, from);
            const double root = half * half - square * (dot(from, from) - distance_ * distance_);
            if (root <= 0) continue;
            for (const double sign : {-1.0, 1.0}) {
                const double share = (-half + sign * std::sqrt(root)) / square;
                if (share > 0 && share < 1) marks.push_back(wall.a + share * way);
            }
        }
    }

    /// Adds rays from the side of the rectangle behind a corner.
    void addSide(std::size_t quarter) {
        const Point2 corner = corners_[quarter], next = corners_[(quarter + 1) % corners_.size()];
        const Vec2 out = distance_ * direction(std::numbers::pi / 2 * static_cast<double>(quarter));
        const double side = distance(corner, next);
        if (side < kBeside) return;
        const Vec2 way = 1 / side * (next - corner);
        std::vector<Point2> marks = marks_;
        for (const Segment2& wall : walls_) {
            if (marks_.empty()) break;
            const double a = dot(wall.a - corner, out) - dot(out, out),
                         b = dot(wall.b - corner, out) - dot(out, out);
            if (a * b < 0) marks.push_back(wall.a + a / (a - b) * (wall.b - wall.a));
        }
        std::vector<double> places;
        addBeside(
            marks, 0, side, kBeside, [&](Point2 mark) { return dot(mark - corner, way); }, places);
        std::sort(places.begin(), places.end());
        for (const double place : places) addRay(corner + place * way, out);
    }

    double distance_;
    std::vector<Segment2> walls_;
    Vec2 along_, across_;
    std::array<Point2, 4> corners_;
    std::vector<Point2> marks_;  ///< ends and crossings of walls; none if there are too many
    Polygon outline_;
};

}  // namespace

DoorFloor::DoorFloor(const Environment& environment) {
    const std::vector<Element>& elements = environment.elements();
    Diagnostics findings;  // stays empty: an environment has none
    WallPlan plan;
    for (std::size_t i = 0; i < elements.size(); ++i)
        for (const WallLine& wall : wallLinesOf(elements[i].record, findings)) plan.add(wall, i);
    const std::vector<Opening> openings = placeOpenings(elements, plan, findings);
    std::vector<std::vector<Segment2>> cuts(plan.lines.size());
    for (const OpeningCut& cut : openingCuts(plan, openings)) {
        const Element& element = elements[openings[cut.opening].element];
        if (element.record.keyword() != "door") continue;
        cuts[cut.line].push_back(cut.jambs);
        faces_[element.id].push_back({cut.jambs, plan.walls[cut.line].thickness});
    }
    for (std::size_t i = 0; i < plan.lines.size(); ++i)
        if (plan.walls[i].bottom < kKnee) addWithout(plan.lines[i], std::move(cuts[i]), walls_);
}

Doorway DoorFloor::throughWall(const Doorway& door) const {
    const auto faces = faces_.find(door.id);
    if (faces == faces_.end() || faces->second.size() < 2) return door;
    const Vec2 way = door.line.b - door.line.a;
    const Vec2 across = 1 / length(way) * perpendicular(way);
    double low = -door.thickness / 2, high = door.thickness / 2;
    for (const Face& face : faces->second)
        for (const Point2 jamb : {face.jambs.a, face.jambs.b}) {
            const double at = dot(jamb - door.line.a, across);
            low = std::min(low, at - face.thickness / 2);
            high = std::max(high, at + face.thickness / 2);
        }
    const Vec2 to_middle = (low + high) / 2 * across;
    return {door.id, {door.line.a + to_middle, door.line.b + to_middle}, high - low};
}

Polygon DoorFloor::around(const Doorway& of, double distance) const {
    const Doorway door = throughWall(of);
    const Vec2 way = door.line.b - door.line.a;
    const double reach = door.thickness / 2 + distance;
    std::vector<Segment2> near;
    const Box2 box = bounds(door.line).expanded(reach);
    const double on_line = kWeldDistance * length(way);
    for (const Segment2& wall : walls_) {
        if (!bounds(wall).meets(box)) continue;
        // The wall of the door itself, and what continues it, hides no floor.
        const bool is_own = std::abs(cross(way, wall.a - door.line.a)) < on_line &&
                            std::abs(cross(way, wall.b - door.line.a)) < on_line;
        if (!is_own) near.push_back(wall);
    }
    if (near.empty()) return floorAround(door, distance);
    return Rays(door, distance, std::move(near)).outline();
}

}  // namespace ispace
