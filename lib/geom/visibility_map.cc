// SPDX-License-Identifier: GPL-3.0-or-later

// GCC would load as one what was just stored as two, and processors wait for that: a sixth of the
// time of a look.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-slp-vectorize")
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/simd.h"
#include "geom/visibility.h"
#include "geom/visibility_breadth.h"
#include "geom/visibility_mesh.h"
#include "geom/visibility_query.h"
#include "geom/visibility_rounds.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

/// From so many triangles on, windows go on in turn: in fewer, processors guess well. Measured.
constexpr std::size_t kManyTriangles = 1000;

double square(double x) { return x * x; }
double squaredLength(Vec2 v) { return dot(v, v); }

/// The farthest that anything in the box can be.
double farthestIn(const Box2& box, Point2 p) {
    return length(Vec2{std::max(std::abs(box.low.x - p.x), std::abs(box.high.x - p.x)),
                       std::max(std::abs(box.low.y - p.y), std::abs(box.high.y - p.y))});
}

/// From a viewpoint at a corner: through the edges opposite to it of all triangles there.
template <typename Look>
void lookAroundCorner(const SightMesh& mesh, Index corner, Look& look) {
    const Index first = corner;
    do {
        look.throughEdge(corner);
        const Index behind = mesh.doors[nextOf(corner)].behind;
        if (behind == Door::kFree) return;
        corner = nextOf(behind);
    } while (corner != first);
}

/// From a viewpoint in a triangle, in it or on its boundary.
template <typename Look>
void lookAround(const SightMesh& mesh, Index triangle, Look& look) {
    std::array<bool, 3> is_on;
    for (Index i = 0; i < 3; ++i)
        is_on[i] = !(look.turn(3 * triangle + (i + 1) % 3, 3 * triangle + (i + 2) % 3) > 0);
    for (Index i = 0; i < 3; ++i) {
        const Index edge = 3 * triangle + i;
        if (is_on[(i + 1) % 3] && is_on[(i + 2) % 3]) {
            lookAroundCorner(mesh, edge, look);
            return;
        }
        if (!is_on[i]) continue;
        const Index behind = mesh.doors[edge].behind;
        if (is_on[(i + 1) % 3] || is_on[(i + 2) % 3] || behind == Door::kFree) continue;
        for (const Index side : {edge, behind}) {
            look.throughEdge(nextOf(side));
            look.throughEdge(beforeOf(side));
        }
        return;
    }
    for (Index i = 0; i < 3; ++i) look.throughEdge(3 * triangle + i);
}

/// From a viewpoint outside of the box: through the sides that face it, and past them.
template <typename Look>
void lookFromOutside(const SightMesh& mesh, Point2 viewpoint, Look& look) {
    const Box2& box = mesh.box;
    const std::array<bool, 4> faces{viewpoint.y<box.low.y, viewpoint.x> box.high.x,
                                    viewpoint.y > box.high.y, viewpoint.x < box.low.x};
    // The first one counter-clockwise of the view: the other one, if there is one, comes before it
    // around the box.
    std::size_t first = 0;
    while (!faces[first] || faces[(first + 1) % 4]) ++first;
    const std::size_t last = faces[(first + 3) % 4] ? (first + 3) % 4 : first;
    look.throughDoor(mesh.in[first]);
    if (last != first) look.throughDoor(mesh.in[last]);
    look.run();
    const Vec2 begin = look.wayTo(nextOf(mesh.in[last])),
               end = look.wayTo(beforeOf(mesh.in[first]));
    const Vec2 after = perpendicular(begin), before = -perpendicular(end);
    look.out().addFree(begin, after);
    look.out().addFree(after, before);
    look.out().addFree(before, end);
}

/// False only if nothing within kSightContact of p lies outside of its triangle or on its boundary.
bool isNearEdge(const SightMesh& mesh, Point2 p, Index triangle) {
    const std::size_t door = std::size_t{3} * triangle;
    const Vec2 a = mesh.doors[door].corner - p, b = mesh.doors[door + 1].corner - p;
    const Vec2 c = mesh.doors[door + 2].corner - p;
    const auto is_near = [](Vec2 from, Vec2 to) {
        return square(cross(from, to)) <= square(kSightContact) * squaredLength(to - from);
    };
    return is_near(a, b) || is_near(b, c) || is_near(c, a);
}

bool isStrictlyInside(const Box2& box, Point2 p) {
    return box.low.x < p.x && p.x < box.high.x && box.low.y < p.y && p.y < box.high.y;
}

/// From the boundary of the box to its outside, by the least that a double can move.
Point2 offBoundary(const Box2& box, Point2 p) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto move = [](double x, double low, double high) {
        if (x == low) return std::nextafter(x, -kInfinity);
        return x == high ? std::nextafter(x, kInfinity) : x;
    };
    return {move(p.x, box.low.x, box.high.x), move(p.y, box.low.y, box.high.y)};
}

/// A look from inside of the box.
struct Task {
    const SightMesh& mesh;
    Point2 viewpoint;
    Index triangle;  ///< with the viewpoint
    double range;
    double farthest;  ///< no corner is farther from the viewpoint
    std::span<const Index> transparent;
    std::vector<SightEnd>& ends;
};

template <bool kBounded, bool kContact>
ISPACE_INLINE void lookInside(const Task& task) {
    Look<kBounded, kContact> look(task.mesh.doors.data(), task.viewpoint, task.range, task.farthest,
                                  task.transparent, task.ends);
    lookAround(task.mesh, task.triangle, look);
    look.run();
    look.out().finish();
}

/// The same as Look finds. Without clones: they gain nothing here.
void lookInBreadth(const Task& task) {
    Look<false, false> look(task.mesh.doors.data(), task.viewpoint, task.range, task.farthest, {},
                            task.ends);
    BreadthFirst breadth(task.mesh.doors.data(), task.viewpoint, task.farthest, look);
    lookAround(task.mesh, task.triangle, breadth);
    breadth.run();
    look.out().finish();
}

// What most looks are.
ISPACE_SIMD_CLONES [[gnu::flatten]] void lookFreely(const Task& task) {
    lookInside<false, false>(task);
}
ISPACE_SIMD_CLONES [[gnu::flatten]] void lookBounded(const Task& task) {
    lookInside<true, false>(task);
}

}  // namespace

struct VisibilityMap::Data {
    Data(std::span<const Segment2> lines, std::span<const Ellipse> ellipses)
        : mesh(lines), rounds(ellipses, static_cast<Index>(lines.size())) {}
    SightMesh mesh;
    RoundBodies rounds;
};

VisibilityMap::VisibilityMap(std::span<const Segment2> lines, std::span<const Ellipse> rounds)
    : data_(std::make_unique<Data>(lines, rounds)) {}
VisibilityMap::VisibilityMap(VisibilityMap&&) noexcept = default;
VisibilityMap& VisibilityMap::operator=(VisibilityMap&&) noexcept = default;
VisibilityMap::~VisibilityMap() = default;

void VisibilityMap::look(Point2 viewpoint, double max_range, VisibleRegion& region) const {
    lookPastLines(viewpoint, max_range, region);
    if (!data_->rounds.empty()) data_->rounds.cut(region);
}

void VisibilityMap::lookPastLines(Point2 viewpoint, double max_range, VisibleRegion& region) const {
    const SightMesh& mesh = data_->mesh;
    viewpoint = withinSight(viewpoint);
    region.viewpoint = viewpoint;
    region.max_range = max_range;
    region.is_whole = true;
    region.ends.clear();
    if (!(max_range > 0)) return;

    const bool inside = isStrictlyInside(mesh.box, viewpoint);
    if (!inside) viewpoint = offBoundary(mesh.box, viewpoint);
    Index triangle = 0;
    bool contact = false;
    std::optional<ContactFinder> finder;
    std::span<const Index> transparent;
    if (inside) {
        triangle = mesh.locate(viewpoint);
        if (isNearEdge(mesh, viewpoint, triangle)) {
            finder.emplace(mesh);
            finder->gather(viewpoint, triangle);
            contact = finder->found();
        }
    }
    if (contact) {
        viewpoint = finder->moved(viewpoint);
        triangle = mesh.locateFrom(viewpoint, triangle);
        finder->gather(viewpoint, triangle);
        transparent = finder->bothSides();
    }
    // Where sight is free for ever, it ends somewhere beyond all lines.
    const double range =
        std::min(max_range, std::isinf(max_range) ? std::max(farthestIn(mesh.box, viewpoint),
                                                             data_->rounds.farthest(viewpoint))
                                                  : kFarthestSight);
    if (contact) region.viewpoint = viewpoint;
    region.max_range = range;
    const bool bounded = range < farthestIn(mesh.cells_box, viewpoint);
    const double farthest = farthestIn(mesh.box, viewpoint);
    if (!inside) {
        Look<true, false> look(mesh.doors.data(), viewpoint, range, farthest, {}, region.ends);
        lookFromOutside(mesh, viewpoint, look);
        look.out().finish();
        return;
    }
    const Task task{mesh, viewpoint, triangle, range, farthest, transparent, region.ends};
    if (contact)
        lookInside<true, true>(task);
    else if (bounded)
        lookBounded(task);
    else if (mesh.doors.size() < 3 * kManyTriangles)
        lookFreely(task);
    else
        lookInBreadth(task);
}

VisibleRegion VisibilityMap::look(Point2 viewpoint, double max_range) const {
    VisibleRegion region;
    look(viewpoint, max_range, region);
    return region;
}

}  // namespace ispace
