// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/check_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "env/info.h"
#include "env/openings.h"
#include "geom/planar_map.h"
#include "layout/check_parts.h"

namespace ispace {

namespace {

/// Metres beyond a door at which its two sides are tested.
constexpr double kBeside = 0.01;

WallPlan planOf(const std::vector<Element>& elements, Diagnostics& ignored) {
    WallPlan plan;
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (isWall(elements[i].record))
            for (const WallLine& wall : wallLinesOf(elements[i].record, ignored)) plan.add(wall, i);
    return plan;
}

/// A wall line and how far off it is.
struct Behind {
    std::size_t line;
    double distance;
};

/// The first wall line that the way from `from` in this direction meets, beyond `least`.
std::optional<Behind> wallBehind(const WallPlan& plan, Point2 from, Vec2 direction, double least) {
    std::optional<Behind> nearest;
    for (std::size_t i = 0; i < plan.lines.size(); ++i) {
        const Vec2 along = plan.lines[i].b - plan.lines[i].a;
        const double denominator = cross(direction, along);
        if (denominator == 0) continue;
        const Vec2 to_line = plan.lines[i].a - from;
        const double distance = cross(to_line, along) / denominator;
        const double share = cross(to_line, direction) / denominator;
        if (share < 0 || share > 1 || distance <= least || distance > kFarthestFace) continue;
        if (!nearest || distance < nearest->distance) nearest = {i, distance};
    }
    return nearest;
}

/// Open doors that lead out of the room into a wall close behind, as between two rooms whose walls
/// stand apart: what to say of them, by the index of their element. O(doors x walls).
std::map<std::size_t, std::string> blockedDoors(const Environment& environment) {
    const std::vector<Element>& elements = environment.elements();
    Diagnostics ignored;  // the environment would not be there with any
    const WallPlan plan = planOf(elements, ignored);
    std::map<std::size_t, std::string> blocked;
    for (const Opening& door : placeOpenings(elements, plan, ignored)) {
        if (!door.passage) continue;
        const Segment2& wall = plan.lines[door.line];
        const Vec2 along = 1 / length(wall.b - wall.a) * (wall.b - wall.a);
        const Point2 middle = wall.a + (door.from + door.to) / 2 * along;
        const double face = door.depth / 2;
        const auto is_indoor = [&](Vec2 side) {
            return environment.indoor().locate(middle + (face + kBeside) * side) == Side::Inside;
        };
        const Vec2 left = perpendicular(along);
        if (is_indoor(left) == is_indoor(-left)) continue;
        const Vec2 out = is_indoor(left) ? -left : left;
        const auto behind = wallBehind(plan, middle, out, face + kWeldDistance);
        if (!behind) continue;
        std::string text = " is open, but leads only to " +
                           nameOf(elements[plan.owner[behind->line]]) + ", " +
                           lengthText(behind->distance) + " m behind, near ";
        text += placeText(middle) +
                "; say how far it reaches through with size=" + lengthText(door.to - door.from) +
                ',';
        text += lengthText(2 * behind->distance);
        blocked.emplace(door.element, std::move(text));
    }
    return blocked;
}

/// An end of a wall this near to another was meant to meet it, in metres.
constexpr double kLooseReach = 0.2;

/// All findings of a scene, record by record.
class SceneCheck {
  public:
    explicit SceneCheck(const Scene& scene)
        : context_(scene), things_(context_), placed_(context_) {
        crossings_ = wallCrossings(scene.environment.elements(), Diagnostics::kMax + 1);
        blocked_ = blockedDoors(scene.environment);
    }

    Diagnostics run() {
        const Scene& scene = context_.scene;
        std::size_t element = 0, placed = 0;
        for (std::size_t i = 0; i < scene.records.size() && !findings_.full(); ++i) {
            if (scene.records[i].schema().isEnvironment()) {
                checkWalls(element);
                things_.check(element, findings_);
                ++element;
            } else if (placed < scene.placed.size() && scene.placed[placed].record == i) {
                placed_.check(placed, findings_);
                ++placed;
            }
        }
        checkLooseEnds();
        return findings_;
    }

  private:
    /// Ends of walls that hang in the room just before another wall.
    void checkLooseEnds() {
        const std::vector<Segment2>& lines = context_.scene.environment.wallLines();
        std::map<std::pair<double, double>, int> meeting;  // lines, by their end
        for (const Segment2& line : lines)
            for (const Point2 p : {line.a, line.b}) ++meeting[{p.x, p.y}];
        std::set<std::pair<double, double>> ends;
        std::optional<Closing> narrowest;
        for (const Closing& gap : closings(lines, {}, kLooseReach)) {
            const Point2 middle = gap.line.a + 0.5 * (gap.line.b - gap.line.a);
            if (context_.indoor.locate(middle) != Side::Inside) continue;
            if (!narrowest) narrowest = gap;  // they come by width
            for (const Point2 p : {gap.line.a, gap.line.b}) {
                const auto found = meeting.find({p.x, p.y});
                if (found != meeting.end() && found->second == 1) ends.insert(found->first);
            }
        }
        if (!narrowest) return;
        const Diagnostic place = context_.finding(0, "");
        findings_.add({place.file, 0, 0,
                       std::to_string(ends.size()) +
                           (ends.size() == 1 ? " loose end of a wall" : " loose ends of walls") +
                           ", the narrowest gap " + lengthText(narrowest->width) + " m near " +
                           placeText(narrowest->line.a) + "; make them meet",
                       Severity::Warning});
    }

    void checkWalls(std::size_t element) {
        for (const WallCrossing& crossing : crossings_) {
            if (crossing.a != element) continue;
            std::string message = crossing.overlap ? " lies on " : " crosses ";
            message += context_.name(crossing.b) + " near " + placeText(crossing.place);
            message += crossing.overlap ? "; leave one of them out, or shorten it"
                                        : "; end one of them at the other";
            findings_.add(context_.finding(element, message));
        }
        if (const auto door = blocked_.find(element); door != blocked_.end())
            findings_.add(context_.finding(element, door->second));
    }

    CheckContext context_;
    ThingCheck things_;
    PlacedCheck placed_;
    std::vector<WallCrossing> crossings_;
    std::map<std::size_t, std::string> blocked_;
    Diagnostics findings_;
};

}  // namespace

Diagnostics checkScene(const Scene& scene) { return SceneCheck(scene).run(); }

}  // namespace ispace
