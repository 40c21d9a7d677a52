// SPDX-License-Identifier: GPL-3.0-or-later
// Walls drawn as two lines that run on behind the symbol of a door. The space between the lines is
// a face of its own, as long as the wall: a door in one line would join all of it to the room.
// Jambs cut the doorway out of it, and the door goes through both lines.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "io/plan/line_plan.h"
#include "io/plan/plan_rooms.h"

namespace ispace {

namespace {

constexpr double kInWall = 0.005;  // metres: beside a line, in the space behind it

/// Metres: depth of a doorway. A deeper or shorter space behind a door that no symbol opens on its
/// far side is a cupboard, and so is one as deep as shelves that ends beside the door.
constexpr double kThinnestWall = 2 * kInWall, kThickestWall = 0.6, kThickestShut = 0.4;
constexpr double kShelf = 0.25;
constexpr double kLongWall = 2;  // widths of the door

constexpr double kNear = 0.1;         // of the ends of openings in both lines
constexpr double kOnJamb = 0.01;      // of a drawn jamb
constexpr double kAlmostEven = 0.02;  // sine of the angle between the lines of a wall

Vec2 unit(const Segment2& s) { return 1 / distance(s.a, s.b) * (s.b - s.a); }

class JambFinder {
  public:
    JambFinder(std::vector<PlanOpening>& openings, std::span<const Segment2> walls,
               std::span<const double> thickness, Budget& work)
        : openings_(openings),
          walls_(walls),
          thickness_(thickness),
          search_(walls, work),
          faces_(linesOf(openings, walls), work) {}

    std::vector<PlanPath> find() {
        // Doors that it adds go through further lines.
        for (std::size_t i = 0; i < openings_.size(); ++i)
            if (isDoor(openings_[i]))
                for (const double side : {1.0, -1.0}) closeBeside(PlanOpening(openings_[i]), side);
        return std::move(jambs_);
    }

  private:
    static std::vector<Segment2> linesOf(std::span<const PlanOpening> openings,
                                         std::span<const Segment2> walls) {
        std::vector<Segment2> lines(walls.begin(), walls.end());
        for (const PlanOpening& opening : openings)
            if (!opening.wall) lines.push_back(opening.line);
        return lines;
    }

    [[nodiscard]] bool isDoor(const PlanOpening& opening) const {
        return opening.wall && !opening.is_window &&
               (thickness_.empty() || thickness_[*opening.wall] == 0);
    }

    /// The line of a wall opposite to an opening in its other line.
    struct Opposite {
        std::size_t wall = 0;
        double depth = 0;
        Segment2 line;  // of the opening on it
    };

    /// \param across of length 1, to the side of the opening where the wall is
    [[nodiscard]] std::optional<Opposite> opposite(const PlanOpening& door, Vec2 across) const {
        const Vec2 along = unit(door.line);
        std::optional<Opposite> nearest;
        for (const std::size_t i : search_.near(door.line.a, kThickestWall)) {
            const Segment2& wall = walls_[i];
            if (i == *door.wall || std::abs(cross(along, unit(wall))) > kAlmostEven) continue;
            const Segment2 feet{wholeMicrometres(nearestPoint(wall, door.line.a)),
                                wholeMicrometres(nearestPoint(wall, door.line.b))};
            const double depth = dot(feet.a - door.line.a, across);
            const auto is_aside = [&](Point2 foot, Point2 end) {
                return std::abs(dot(foot - end, along)) > kNear;
            };
            if (depth < kThinnestWall || depth > kThickestWall ||
                (nearest && nearest->depth <= depth) || is_aside(feet.a, door.line.a) ||
                is_aside(feet.b, door.line.b))
                continue;
            nearest = {i, depth, feet};
        }
        return nearest;
    }

    void closeBeside(const PlanOpening& door, double side) {
        const Vec2 across = side * perpendicular(unit(door.line));
        const Point2 middle = door.line.a + 0.5 * (door.line.b - door.line.a);
        const PlanFaces::Group* const space = faces_.groupAt(middle + kInWall * across);
        if (space == nullptr || !faces_.isHollow(*space)) return;
        std::optional<Opposite> other = opposite(door, across);
        if (!other) return;
        const double width = distance(door.line.a, door.line.b);
        if (const PlanOpening* open = openingOn(*other)) {
            // The doorway leads from end to end, where they are about opposite.
            for (Point2* foot : {&other->line.a, &other->line.b})
                for (const Point2 end : {open->line.a, open->line.b})
                    if (distance(*foot, end) <= kNear) *foot = end;
        } else if (other->depth <= kThickestShut &&
                   space->area > kLongWall * width * other->depth &&
                   (other->depth < kShelf || runsOn(*space, door, across))) {
            openings_.push_back({other->line, other->wall, false, door.drawn_on});
        } else {
            return;
        }
        addJamb({door.line.a, other->line.a}, door, *other);
        addJamb({door.line.b, other->line.b}, door, *other);
    }

    /// Returns true if the space behind a door goes on for another width at both of its ends.
    [[nodiscard]] bool runsOn(const PlanFaces::Group& space, const PlanOpening& door,
                              Vec2 across) const {
        const Vec2 along = door.line.b - door.line.a;
        return faces_.groupAt(door.line.a - along + kInWall * across) == &space &&
               faces_.groupAt(door.line.b + along + kInWall * across) == &space;
    }

    /// Returns a door on the line that overlaps the opposite opening.
    [[nodiscard]] const PlanOpening* openingOn(const Opposite& other) const {
        const Vec2 along = unit(other.line);
        const auto at = [&](Point2 p) { return dot(p - other.line.a, along); };
        for (const PlanOpening& opening : openings_) {
            if (opening.wall != other.wall) continue;
            const auto [from, to] = std::minmax({at(opening.line.a), at(opening.line.b)});
            if (from < at(other.line.b) && to > 0) return &opening;
        }
        return nullptr;
    }

    void addJamb(const Segment2& jamb, const PlanOpening& door, const Opposite& other) {
        const Point2 middle = jamb.a + 0.5 * (jamb.b - jamb.a);
        for (const std::size_t i : search_.near(middle, kOnJamb))
            if (i != *door.wall && i != other.wall && distance(middle, walls_[i]) <= kOnJamb)
                return;
        const auto [first, second] = std::minmax(jamb.a, jamb.b, lexLess);
        if (known_.insert({first.x, first.y, second.x, second.y}).second)
            jambs_.push_back({{jamb.a, jamb.b}, false, door.drawn_on});
    }

    std::vector<PlanOpening>& openings_;
    std::span<const Segment2> walls_;
    std::span<const double> thickness_;
    NearSegments search_;
    PlanFaces faces_;
    std::set<std::array<double, 4>> known_;
    std::vector<PlanPath> jambs_;
};

}  // namespace

std::vector<PlanPath> addJambs(std::vector<PlanOpening>& openings, std::span<const Segment2> walls,
                               std::span<const double> thickness, Budget& work) {
    if (std::ranges::none_of(openings, [](const PlanOpening& opening) {
            return opening.wall && !opening.is_window;
        }))
        return {};
    return JambFinder(openings, walls, thickness, work).find();
}

}  // namespace ispace
