// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/check_doors.h"

#include <cmath>
#include <optional>
#include <utility>

#include "env/info.h"
#include "env/openings.h"
#include "env/texts.h"
#include "geom/planar_map.h"

namespace ispace {

namespace {

/// So far beyond the door its two sides are looked at, in metres.
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

}  // namespace

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

}  // namespace ispace
