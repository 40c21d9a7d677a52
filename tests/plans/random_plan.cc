// SPDX-License-Identifier: GPL-3.0-or-later
#include "random_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "base/number.h"
#include "geom/pose.h"
#include "geom/predicates.h"

namespace ispace::testing {

namespace {

constexpr double kDoor = 0.9, kDoorDepth = 0.7;  // free width on both sides of it
constexpr double kFromDoor = 0.35;               // other walls end at least this far from a door
constexpr double kFromWall = 0.06, kApart = 0.08;
constexpr double kMinWidth = 2.2;  // of a room

std::string point(Point2 p) { return formatDouble(p.x) + ',' + formatDouble(p.y); }

/// Numbers of millimetres read well.
double rounded(double x) { return std::round(x * 1000) / 1000; }

/// A room, or part of the floor that is still to be divided. Convex, counter-clockwise.
using Room = Polygon;

/// The least distance between two parallel lines that hold the room between them.
double widthOf(const Room& room) {
    double least = std::numeric_limits<double>::infinity();
    forEachEdge(room, [&](const Segment2& edge) {
        const Vec2 inner = (1 / distance(edge.a, edge.b)) * perpendicular(edge.b - edge.a);
        double deepest = 0;
        for (const Point2 corner : room) deepest = std::max(deepest, dot(corner - edge.a, inner));
        least = std::min(least, deepest);
    });
    return least;
}

/// True if an edge of one of two convex polygons has the other beyond it, `apart` away.
bool areApart(const Polygon& a, const Polygon& b, double apart) {
    const auto parts = [apart](const Polygon& one, const Polygon& other) {
        bool any = false;
        forEachEdge(one, [&](const Segment2& edge) {
            const Vec2 outer = (-1 / distance(edge.a, edge.b)) * perpendicular(edge.b - edge.a);
            any = any || std::all_of(other.begin(), other.end(), [&](Point2 corner) {
                      return dot(corner - edge.a, outer) >= apart;
                  });
        });
        return any;
    };
    return parts(a, b) || parts(b, a);
}

/// Every corner lies in the room, this far from its walls.
bool isWithin(const Polygon& piece, const Room& room, double from_walls) {
    bool all = true;
    forEachEdge(room, [&](const Segment2& edge) {
        const Vec2 inner = (1 / distance(edge.a, edge.b)) * perpendicular(edge.b - edge.a);
        for (const Point2 corner : piece) all = all && dot(corner - edge.a, inner) >= from_walls;
    });
    return all;
}

class PlanMaker {
  public:
    explicit PlanMaker(const PlanOptions& options) : options_(options), random_(options.seed) {
        if (options_.is_askew) world_from_plan_.heading = Angle::degrees(between(0, 360));
        world_from_plan_.position = {rounded(between(-5, 5)), rounded(between(-5, 5))};
    }

    std::string make() {
        text_ = "#env 1\n";
        std::vector<Room> parts = makeOutline();
        for (Room& part : parts) divide(std::move(part));
        text_ += "inside at=" + point(world_from_plan_ * middleOf(rooms_.front())) + '\n';
        spread(options_.holes, &PlanMaker::addShaft);
        spread(options_.holes, &PlanMaker::addPillar);
        spread(options_.furniture, &PlanMaker::addFurniture);
        return std::move(text_);
    }

  private:
    double between(double low, double high) {
        return low + (high - low) * std::uniform_real_distribution<double>()(random_);
    }
    bool withChance(double share) { return between(0, 1) < share; }
    std::size_t oneOf(std::size_t count) {
        const auto one = static_cast<std::size_t>(between(0, static_cast<double>(count)));
        return std::min(one, count - 1);
    }

    /// Writes the outer walls. The convex parts of the floor, in the plan's frame.
    std::vector<Room> makeOutline() {
        const double ratio = between(1, 1.8);
        const bool is_l = options_.area >= 40 && withChance(0.5);
        const double notch_share = is_l ? between(0.15, 0.3) : 0;
        const double area = options_.area / (1 - notch_share);
        const double width = rounded(std::sqrt(area * ratio)), depth = rounded(area / width);
        if (!is_l) {
            const Room whole = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
            addOutline(whole);
            return {whole};
        }
        // The notch keeps half of both sides at least.
        const double notch = rounded(width * std::sqrt(notch_share) * between(0.9, 1.1));
        const double x = width - notch, y = depth - rounded(area * notch_share / notch);
        addOutline({{0, 0}, {width, 0}, {width, y}, {x, y}, {x, depth}, {0, depth}});
        const Segment2 wall{{x, 0}, {x, y}};
        addWall(wall);
        return {{{0, 0}, wall.a, wall.b, {x, depth}, {0, depth}},
                {wall.a, {width, 0}, {width, y}, wall.b}};
    }

    void addOutline(const Polygon& outline) {
        text_ += "fence id=outline closed=yes path=";
        for (std::size_t i = 0; i < outline.size(); ++i)
            text_.append(i == 0 ? "" : ";").append(point(world_from_plan_ * outline[i]));
        text_ += '\n';
    }

    /// An inner wall with an open door. \pre it is long enough
    void addWall(const Segment2& wall) {
        const std::string id = "w" + std::to_string(++walls_);
        const double extent = distance(wall.a, wall.b), margin = kDoor / 2 + kFromDoor;
        const double offset = between(margin, extent - margin);
        text_.append("wall id=").append(id);
        text_.append(" from=").append(point(world_from_plan_ * wall.a));
        text_.append(" to=").append(point(world_from_plan_ * wall.b)).append("\n");
        text_.append("door wall=").append(id).append(" offset=").append(formatDouble(offset));
        text_.append(" size=").append(formatDouble(kDoor)).append(" open=yes\n");
        const Vec2 along = (1 / extent) * (wall.b - wall.a);
        const Pose2 door{wall.a + offset * along, directionOf(along.x, along.y)};
        doors_.push_back(rectangleAt(door, kDoor, 2 * kDoorDepth));
        gaps_.push_back(
            {wall.a + (offset - kDoor / 2) * along, wall.a + (offset + kDoor / 2) * along});
    }

    /// Divides a room until its parts are as large as rooms are to be.
    void divide(Room room) {
        if (signedArea(room) > options_.room_area * between(1.2, 1.8)) {
            constexpr int kTries = 20;
            for (int i = 0; i < kTries; ++i) {
                if (auto parts = tryCut(room)) {
                    divide(std::move(parts->first));
                    return divide(std::move(parts->second));
                }
            }
        }
        rooms_.push_back(std::move(room));
    }

    /// Returns a cut across the longer extent of the room near its middle, unless it would end at a
    /// door or make a narrow room.
    std::optional<std::pair<Room, Room>> tryCut(const Room& room) {
        const Box2 box = bounds(room);
        const bool is_wide = box.width() >= box.depth();
        const double share = between(0.3, 0.7);
        const Point2 through = is_wide ? Point2{rounded(box.low.x + share * box.width()), 0}
                                       : Point2{0, rounded(box.low.y + share * box.depth())};
        const double askew = options_.is_askew ? between(-10, 10) : 0;
        const Vec2 along = unitVector(Angle::degrees((is_wide ? 90 : 0) + askew));
        // Through a point of the level or upright line, in the middle of the box.
        const Point2 middle =
            is_wide ? Point2{through.x, box.center().y} : Point2{box.center().x, through.y};
        std::pair<Room, Room> parts;
        std::vector<Point2> ends;
        for (std::size_t i = 0; i < room.size(); ++i) {
            const Point2 a = room[i], b = room[(i + 1) % room.size()];
            const double left_a = cross(along, a - middle), left_b = cross(along, b - middle);
            (left_a >= 0 ? parts.first : parts.second).push_back(a);
            if ((left_a >= 0) == (left_b >= 0)) continue;
            const Point2 end = a + (left_a / (left_a - left_b)) * (b - a);
            ends.push_back(end);
            parts.first.push_back(end);
            parts.second.push_back(end);
        }
        if (ends.size() != 2 || !isFine(room, ends) || widthOf(parts.first) < kMinWidth ||
            widthOf(parts.second) < kMinWidth)
            return std::nullopt;
        addWall({ends[0], ends[1]});
        return parts;
    }

    /// A wall may end there: not at a door, nor beside a corner.
    [[nodiscard]] bool isFine(const Room& room, const std::vector<Point2>& ends) const {
        return std::all_of(ends.begin(), ends.end(), [&](Point2 end) {
            return std::none_of(
                       gaps_.begin(), gaps_.end(),
                       [&](const Segment2& gap) { return distance(end, gap) < kFromDoor; }) &&
                   std::none_of(room.begin(), room.end(),
                                [&](Point2 corner) { return distance(end, corner) < kFromDoor; });
        });
    }

    [[nodiscard]] static Point2 middleOf(const Room& room) {
        Vec2 sum{0, 0};
        for (const Point2 corner : room) sum = sum + (corner - room[0]);
        return room[0] + (1 / static_cast<double>(room.size())) * sum;
    }

    static Polygon rectangleAt(const Pose2& pose, double length, double width) {
        const double x = length / 2, y = width / 2;
        return {pose * Point2{-x, -y}, pose * Point2{x, -y}, pose * Point2{x, y},
                pose * Point2{-x, y}};
    }

    /// Calls `add` so often for each room as its area wants, once more by chance.
    void spread(double per_area, void (PlanMaker::*add)(const Room&)) {
        for (const Room& room : rooms_) {
            const double wanted = per_area * signedArea(room);
            const int count = static_cast<int>(std::floor(wanted + between(0, 1)));
            for (int i = 0; i < count; ++i) (this->*add)(room);
        }
    }

    /// Finds a position for an object of this size in the room: along one of its walls, or
    /// anywhere.
    std::optional<Pose2> findPlace(const Room& room, double length, double width, bool at_wall) {
        constexpr int kTries = 30;
        for (int i = 0; i < kTries; ++i) {
            const std::size_t side = oneOf(room.size());
            const Point2 a = room[side], b = room[(side + 1) % room.size()];
            const Vec2 along = (1 / distance(a, b)) * (b - a);
            Pose2 pose{a, directionOf(along.x, along.y)};
            const double depth =
                at_wall ? width / 2 + 1.5 * kFromWall : between(0.3, widthOf(room));
            pose.position = a + between(0, distance(a, b)) * along + depth * perpendicular(along);
            if (isFree(rectangleAt(pose, length, width), room)) return pose;
        }
        return std::nullopt;
    }

    [[nodiscard]] bool isFree(const Polygon& piece, const Room& room) const {
        const auto is_apart = [&](const Polygon& other) { return areApart(piece, other, kApart); };
        return isWithin(piece, room, kFromWall) &&
               std::all_of(doors_.begin(), doors_.end(), is_apart) &&
               std::all_of(pieces_.begin(), pieces_.end(), is_apart);
    }

    void put(const std::string& what, const Pose2& pose, double length, double width,
             const std::string& rest) {
        pieces_.push_back(rectangleAt(pose, length, width));
        const Angle heading = wrapped(pose.heading + world_from_plan_.heading);
        text_.append(what).append(" at=").append(point(world_from_plan_ * pose.position));
        text_.append(" heading=").append(formatDouble(heading.degrees())).append(rest).append("\n");
    }

    static std::string size(double length, double width) {
        return " size=" + formatDouble(length) + ',' + formatDouble(width);
    }

    void addShaft(const Room& room) {
        const double length = rounded(between(0.5, 1.2)), width = rounded(between(0.4, 1));
        // The known inside point is in the middle of the first room.
        if (&room == &rooms_.front()) return;
        const auto pose = findPlace(room, length, width, false);
        if (!pose) return;
        const Polygon outline = rectangleAt(*pose, length, width);
        pieces_.push_back(outline);
        text_ += "fence closed=yes path=";
        for (std::size_t i = 0; i < outline.size(); ++i)
            text_.append(i == 0 ? "" : ";").append(point(world_from_plan_ * outline[i]));
        text_ += '\n';
    }

    void addPillar(const Room& room) {
        const double width = rounded(between(0.25, 0.5));
        const std::string kind = withChance(0.5) ? " kind=round" : "";
        if (const auto pose = findPlace(room, width, width, false))
            put("pillar", *pose, width, width, size(width, width) + kind);
    }

    void addFurniture(const Room& room) {
        const double kind = between(0, 1);
        if (kind < 0.4) return addDesk(room);
        if (kind < 0.6) {
            const double width = rounded(between(0.7, 1.1));
            if (const auto pose = findPlace(room, width, width, false))
                put("table", *pose, width, width, size(width, width));
            return;
        }
        const double length = rounded(between(0.6, 1.8)), width = rounded(between(0.35, 0.6));
        if (const auto pose = findPlace(room, length, width, withChance(0.8)))
            put("cube", *pose, length, width, size(length, width) + ",1.8");
    }

    /// At a wall, which it has on its right, with a chair on its left if there is room for one.
    void addDesk(const Room& room) {
        const double length = rounded(between(1.2, 1.6)), width = rounded(between(0.65, 0.8));
        const std::string kind = withChance(0.3) ? " kind=closed" : "";
        const auto desk = findPlace(room, length, width, true);
        if (!desk) return;
        put("desk", *desk, length, width, size(length, width) + kind);
        constexpr double kChair = 0.45;
        const Pose2 chair{*desk * Point2{0, width / 2 + kChair / 2 + 2 * kApart},
                          wrapped(desk->heading - Angle::degrees(90))};
        if (isFree(rectangleAt(chair, kChair, kChair), room))
            put("chair", chair, kChair, kChair, "");
    }

    PlanOptions options_;
    std::mt19937_64 random_;
    Pose2 world_from_plan_;
    std::string text_;
    int walls_ = 0;
    std::vector<Room> rooms_;
    std::vector<Segment2> gaps_;           // doors
    std::vector<Polygon> doors_, pieces_;  // areas without objects
};

}  // namespace

std::string randomPlan(const PlanOptions& options) { return PlanMaker(options).make(); }

}  // namespace ispace::testing
