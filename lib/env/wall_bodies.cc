// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "env/walls.h"

namespace ispace {

namespace {

/// A mitre reaches at most this many half thicknesses beyond its corner, as drawing programs have
/// it; sharper corners are cut off straight.
constexpr double kMitreLimit = 4;

/// The end of a thick piece, seen from there along the wall.
struct End {
    std::size_t line;
    Vec2 direction;      ///< unit, away from the end
    Point2 left, right;  ///< corners of the box at this end
    double angle;        ///< of direction, radians
};

using Ends = std::map<std::pair<double, double>, std::vector<End>>;

/// Adds the box of a thick piece, and its ends to those of their points.
void addBox(const WallLine& wall, std::size_t line, const Segment2& piece, Body& body, Ends& ends) {
    const Vec2 along = piece.b - piece.a;
    const Vec2 unit = (1 / length(along)) * along;
    const Vec2 side = wall.thickness / 2 * perpendicular(unit);
    const Point2 a_left = piece.a + side, a_right = piece.a - side;
    const Point2 b_left = piece.b + side, b_right = piece.b - side;
    body.prisms.push_back(
        {{a_right, b_right, b_left, a_left}, wall.bottom, wall.top, wall.material});
    ends[{piece.a.x, piece.a.y}].push_back(
        {line, unit, a_left, a_right, std::atan2(unit.y, unit.x)});
    ends[{piece.b.x, piece.b.y}].push_back(
        {line, -unit, b_right, b_left, std::atan2(-unit.y, -unit.x)});
}

/// Fills the notch that is left between two ends at a point where the turn from the first to the
/// second, counter-clockwise, is more than half a circle.
std::optional<Polygon> mitre(Point2 corner, const End& first, const End& second) {
    const Point2 a = first.left, b = second.right;
    if (distance(a, b) <= kWeldDistance) return std::nullopt;
    Polygon polygon{corner, a, b};
    const double denominator = cross(first.direction, second.direction);
    if (denominator != 0) {
        // a - s * first.direction meets b - t * second.direction.
        const double s = cross(a - b, second.direction) / denominator;
        const Point2 tip = a - s * first.direction;
        const double half = std::max(distance(corner, a), distance(corner, b));
        if (distance(corner, tip) <= kMitreLimit * half) polygon = {corner, a, tip, b};
    }
    if (!(signedArea(polygon) > 0)) return std::nullopt;
    return polygon;
}

void addJoints(std::span<const WallLine> lines, Ends& ends, std::vector<Body>& bodies) {
    for (auto& [key, at_point] : ends) {
        if (at_point.size() < 2) continue;
        std::stable_sort(at_point.begin(), at_point.end(),
                         [](const End& s, const End& t) { return s.angle < t.angle; });
        for (std::size_t i = 0; i < at_point.size(); ++i) {
            const bool last = i + 1 == at_point.size();
            const End& first = at_point[i];
            const End& second = at_point[last ? 0 : i + 1];
            const double turn = second.angle - first.angle + (last ? 2 * std::numbers::pi : 0);
            if (turn <= std::numbers::pi) continue;
            const WallLine& s = lines[first.line];
            const WallLine& t = lines[second.line];
            const double bottom = std::max(s.bottom, t.bottom), top = std::min(s.top, t.top);
            if (bottom >= top) continue;
            const std::size_t owner = std::min(first.line, second.line);
            if (auto joint = mitre({key.first, key.second}, first, second))
                bodies[owner].prisms.push_back(
                    {std::move(*joint), bottom, top, lines[owner].material});
        }
    }
}

}  // namespace

std::vector<Body> wallBodies(std::span<const WallLine> lines, const WeldedLines& welded) {
    std::vector<Body> bodies(lines.size());
    Ends ends;
    for (std::size_t i = 0; i < welded.pieces.size(); ++i) {
        const std::size_t line = welded.source[i];
        const WallLine& wall = lines[line];
        if (wall.thickness > 0)
            addBox(wall, line, welded.pieces[i], bodies[line], ends);
        else
            bodies[line].sheets.push_back({welded.pieces[i], wall.bottom, wall.top, wall.material});
    }
    addJoints(lines, ends, bodies);
    return bodies;
}

}  // namespace ispace
