// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "report/map/map_parts.h"

namespace ispace {

namespace {

Point2 between(Point2 from, Point2 to, double share) { return from + share * (to - from); }

/// Returns the edges of steps, and an arrow along the middle from the foot to the head.
std::vector<std::vector<Point2>> stairLines(const Polygon& outline) {
    constexpr double kTread = 0.28, kTip = 0.2;  // metres
    const Point2 right = outline[0], head = outline[1], left = outline[2], foot = outline[3];
    const double length = distance(right, head);
    const int steps = std::max(2, static_cast<int>(std::lround(length / kTread)));
    std::vector<std::vector<Point2>> lines;
    for (int i = 1; i < steps; ++i)
        lines.push_back({between(right, head, static_cast<double>(i) / steps),
                         between(foot, left, static_cast<double>(i) / steps)});
    const Point2 from = between(right, foot, 0.5), to = between(head, left, 0.5);
    const double back = length > kTip ? 1 - kTip / length : 0.5;
    const Point2 tip = between(from, to, back);
    lines.push_back({from, to});
    lines.push_back({between(tip, between(right, head, back), 0.4), to,
                     between(tip, between(foot, left, back), 0.4)});
    return lines;
}

}  // namespace

void drawPassages(Picture& picture, const MapPicture& map) {
    if (map.options.passages.empty()) return;
    const Stroke rim{palette::kFaintInk, map.em / 14};
    Stroke dashed = rim;
    dashed.dashes = {map.em / 2, map.em / 3};
    picture.pushLayer("passages");
    for (const MapPassage& passage : map.options.passages) {
        Polygon closed = passage.outline;
        if (closed.empty()) continue;
        picture.pushView(map.view);
        picture.area(closed, {palette::kWhite.faded(0.5)});
        closed.push_back(closed.front());
        picture.lines(closed, {passage.kind == "shaft" ? dashed : rim});
        const bool has_corners = passage.outline.size() == 4;
        if (has_corners && passage.kind == "stairs")
            picture.lines(stairLines(passage.outline), {rim});
        if (has_corners && passage.kind == "lift")
            picture.lines(
                std::vector<std::vector<Point2>>{{closed[0], closed[2]}, {closed[1], closed[3]}},
                {rim});
        const Point2 corner = picture.toPage(bounds(passage.outline).low);
        picture.pop();
        picture.text(corner + Vec2{0.3 * map.em, -0.4 * map.em}, passage.id,
                     {0.8 * map.em, false, Align::Left, palette::kFaintInk, {}});
    }
    picture.pop();
}

}  // namespace ispace
