// SPDX-License-Identifier: GPL-3.0-or-later
// The floor that a disc sweeps, by its configuration space (T. Lozano-Pérez, Spatial planning: a
// configuration space approach, 1983): the centre may be where no wall is within the radius, which
// is the complement of a union of capsules; the piece with the start, swept by the disc again, is
// the floor. This is a morphological opening, restricted to one component. Chords of capsules and
// simplified outlines cost up to 1 % of the radius; the sweep uses a radius 1 % larger, so that
// floor within reach is kept.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "geom/arrangement.h"
#include "geom/polygon.h"
#include "io/plan/plan_lines.h"
#include "io/plan/plan_rooms.h"

namespace ispace {

namespace {

/// Number of chords to half a circle.
constexpr int kChords = 16;

/// The disc's radius is met within this share; half of it goes to chords and simpler outlines.
constexpr double kTolerance = 0.01;

/// Slivers that rounding leaves between a wall and an offset of it are thinner than this share of
/// the radius.
constexpr double kSliver = 0.01;

/// Outlines may move by this, in metres, so that they lie this near to doors.
constexpr double kSimplify = 2e-5, kAtDoor = 5 * kSimplify;

/// Returns all points within the radius of the segment, arcs by chords.
Polygon capsule(const Segment2& s, double radius) {
    const Vec2 along = s.b - s.a;
    const double start = along.x == 0 && along.y == 0 ? 0 : std::atan2(along.y, along.x);
    Polygon outline;
    const auto arc = [&](Point2 center, double from) {
        for (int i = 0; i <= kChords; ++i) {
            const double angle = from + std::numbers::pi * i / kChords;
            outline.push_back(center + radius * Vec2{std::cos(angle), std::sin(angle)});
        }
    };
    arc(s.b, start - std::numbers::pi / 2);
    arc(s.a, start + std::numbers::pi / 2);
    return outline;
}

/// Appends the region as triangles, which have no holes.
void appendTriangles(const Region& region, std::vector<Polygon>& solids) {
    const Triangulation all = triangulate(region);
    for (const auto& [a, b, c] : all.triangles)
        solids.push_back({all.vertices[a], all.vertices[b], all.vertices[c]});
}

bool isSliver(const Region& region, double radius) {
    return 2 * region.area() < kSliver * radius * region.boundaryLength();
}

/// Removes corners, including the coinciding ones where arcs were cut.
Region normalised(const Region& region, double tolerance) {
    std::vector<Polygon> curves = simplified(curvesOf(region), tolerance);
    const auto are_one = [](Point2 a, Point2 b) { return distance(a, b) <= kSimplify; };
    for (Polygon& curve : curves) {
        curve.erase(std::unique(curve.begin(), curve.end(), are_one), curve.end());
        while (curve.size() > 1 && are_one(curve.front(), curve.back())) curve.pop_back();
    }
    Region result;
    result.outline = std::move(curves.front());
    result.holes.assign(std::make_move_iterator(curves.begin() + 1),
                        std::make_move_iterator(curves.end()));
    return result;
}

/// Returns the positions that the disc's centre can reach.
std::vector<Region> centres(std::span<const Region> rooms, std::span<const Segment2> walls,
                            double radius) {
    const auto [low, high] = bounds(rooms).expanded(radius);
    std::vector<Polygon> blocked;
    blocked.reserve(walls.size());
    for (const Segment2& wall : walls) blocked.push_back(capsule(wall, radius));
    return difference({{low, {high.x, low.y}, high, {low.x, high.y}}, {}}, blocked);
}

}  // namespace

std::vector<Region> reachedFloor(std::span<const Region> rooms, std::span<const Segment2> walls,
                                 Point2 start, double radius) {
    const std::vector<Region> pieces = centres(rooms, walls, radius);
    const auto home = std::find_if(pieces.begin(), pieces.end(), [start](const Region& piece) {
        return piece.locate(start) != Side::Outside;
    });
    if (home == pieces.end()) return {};
    // Arcs keep only the corners that the tolerance needs; the sweep makes up for that.
    const Region centre = normalised(*home, kTolerance / 2 * radius);
    const double sweep = (1 + kTolerance) * radius;
    std::vector<Polygon> swept;
    appendTriangles(centre, swept);
    centre.forEachEdge([&](const Segment2& edge) { swept.push_back(capsule(edge, sweep)); });
    std::vector<Region> reached;
    for (const Region& room : rooms) {
        std::vector<Polygon> unreached;
        for (const Region& piece : difference(room, swept))
            if (!isSliver(piece, radius)) appendTriangles(piece, unreached);
        if (unreached.empty()) {
            reached.push_back(room);
            continue;
        }
        for (Region& piece : difference(room, unreached))
            if (!isSliver(piece, radius)) reached.push_back(normalised(piece, kSimplify));
    }
    return reached;
}

namespace {

/// Returns the parts of doors that lie on the outlines of two pieces.
std::vector<Segment2> passagesBetween(std::span<const Region> pieces,
                                      std::span<const Segment2> doors, Budget& work) {
    std::vector<Segment2> edges;
    for (const Region& piece : pieces)
        piece.forEachEdge([&edges](const Segment2& edge) { edges.push_back(edge); });
    const NearSegments search(edges, work);
    std::vector<Segment2> passages;
    for (const Segment2& door : doors) {
        const Vec2 along = door.b - door.a;
        const auto share = [&](Point2 p) {
            return std::clamp(dot(p - door.a, along) / dot(along, along), 0.0, 1.0);
        };
        const auto at = [&](double s) { return door.a + s * along; };
        std::vector<std::pair<double, int>> ends;  // of edges on the door, and their beginnings
        for (const std::size_t i : search.near(bounds(door), kAtDoor)) {
            const auto [from, to] = std::minmax({share(edges[i].a), share(edges[i].b)});
            if (!(from < to) || distance(at(from), edges[i]) > kAtDoor ||
                distance(at(to), edges[i]) > kAtDoor)
                continue;
            ends.emplace_back(from, 1);
            ends.emplace_back(to, -1);
        }
        std::sort(ends.begin(), ends.end());
        int pieces_here = 0;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            pieces_here += ends[i].second;
            const Segment2 part{at(ends[i].first), at(ends[i + 1].first)};
            if (pieces_here >= 2 && distance(part.a, part.b) > kAtDoor) passages.push_back(part);
        }
    }
    return passages;
}

/// Joins lines of a closed curve, in its order, where one begins at the end of another.
std::vector<PlanPath> chained(const std::vector<Segment2>& lines) {
    const auto begins = [&lines](std::size_t i) {
        return lines[i].a != lines[i == 0 ? lines.size() - 1 : i - 1].b;
    };
    std::size_t first = 0;
    while (first < lines.size() && !begins(first)) ++first;
    std::vector<PlanPath> paths;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Segment2& line = lines[(first + i) % lines.size()];
        if (i == 0 || begins((first + i) % lines.size())) paths.push_back({{line.a}, false, 0});
        paths.back().points.push_back(line.b);
    }
    return paths;
}

double lengthOf(const PlanPath& path) {
    double sum = 0;
    for (std::size_t i = 0; i < path.pieceCount(); ++i) {
        const auto [a, b] = path.piece(i);
        sum += distance(a, b);
    }
    return sum;
}

}  // namespace

std::vector<PlanPath> reachedOutlines(std::span<const Region> pieces,
                                      std::span<const Segment2> doors, Budget& work) {
    const std::vector<Segment2> passages = passagesBetween(pieces, doors, work);
    std::vector<PlanPath> outlines;
    for (const Region& piece : pieces)
        for (Polygon& curve : curvesOf(piece)) {
            std::vector<Segment2> edges;
            forEachEdge(curve, [&edges](const Segment2& edge) { edges.push_back(edge); });
            const std::vector<Segment2> rest = withoutPassages(edges, passages, work, kAtDoor);
            if (rest == edges) {
                outlines.push_back({std::move(curve), true, 0});
                continue;
            }
            for (PlanPath& path : chained(rest))
                if (lengthOf(path) > kAtDoor) outlines.push_back(std::move(path));
        }
    return outlines;
}

}  // namespace ispace
