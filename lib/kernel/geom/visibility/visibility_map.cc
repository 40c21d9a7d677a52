// SPDX-License-Identifier: GPL-3.0-or-later

// GCC would load two values just stored singly as one, which stalls the processor: a sixth of the
// time of a search.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-slp-vectorize")
#endif

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/simd.h"
#include "geom/predicates.h"
#include "geom/visibility/mesh_tiles.h"
#include "geom/visibility/visibility.h"
#include "geom/visibility/visibility_breadth.h"
#include "geom/visibility/visibility_mesh.h"
#include "geom/visibility/visibility_query.h"
#include "geom/visibility/visibility_rounds.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

/// From these numbers of triangles on, in all and within the range, BreadthFirst is faster: in
/// smaller meshes branches are predicted well, and short views end before it pays. Measured.
constexpr std::size_t kManyTriangles = 1000;
constexpr double kManyWithinRange = 600;

double square(double x) { return x * x; }
double squaredLength(Vec2 v) { return dot(v, v); }

/// Computes the distance of the farthest point of the box.
double farthestIn(const Box2& box, Point2 p) {
    return length(Vec2{std::max(std::abs(box.low.x - p.x), std::abs(box.high.x - p.x)),
                       std::max(std::abs(box.low.y - p.y), std::abs(box.high.y - p.y))});
}

/// From a viewpoint at a corner: through the edges opposite to it of all triangles there.
template <typename Search>
void expandAroundCorner(const ExpansionMesh& mesh, Index corner, Search& search) {
    const Index first = corner;
    do {
        search.throughEdge(corner);
        const Index behind = mesh.portals[nextOf(corner)].behind;
        if (behind == Portal::kFree) return;
        corner = nextOf(behind);
    } while (corner != first);
}

/// From a viewpoint in a triangle, in it or on its boundary.
template <typename Search>
void expandAround(const ExpansionMesh& mesh, Index triangle, Search& search) {
    std::array<bool, 3> is_on;
    for (Index i = 0; i < 3; ++i)
        is_on[i] = !(search.turn(3 * triangle + (i + 1) % 3, 3 * triangle + (i + 2) % 3) > 0);
    for (Index i = 0; i < 3; ++i) {
        const Index edge = 3 * triangle + i;
        if (is_on[(i + 1) % 3] && is_on[(i + 2) % 3]) {
            expandAroundCorner(mesh, edge, search);
            return;
        }
        if (!is_on[i]) continue;
        const Index behind = mesh.portals[edge].behind;
        if (is_on[(i + 1) % 3] || is_on[(i + 2) % 3] || behind == Portal::kFree) continue;
        for (const Index side : {edge, behind}) {
            search.throughEdge(nextOf(side));
            search.throughEdge(beforeOf(side));
        }
        return;
    }
    for (Index i = 0; i < 3; ++i) search.throughEdge(3 * triangle + i);
}

/// Expands from a viewpoint outside of the box: through the sides that face it, and past them.
template <typename Search>
void expandFromOutside(const ExpansionMesh& mesh, Point2 viewpoint, Search& search) {
    const Box2& box = mesh.box;
    const std::array<bool, 4> faces{viewpoint.y<box.low.y, viewpoint.x> box.high.x,
                                    viewpoint.y > box.high.y, viewpoint.x < box.low.x};
    // The first one counter-clockwise of the view: the other one, if there is one, comes before it
    // around the box.
    std::size_t first = 0;
    while (!faces[first] || faces[(first + 1) % 4]) ++first;
    const std::size_t last = faces[(first + 3) % 4] ? (first + 3) % 4 : first;
    search.throughPortal(mesh.in[first]);
    if (last != first) search.throughPortal(mesh.in[last]);
    search.run();
    const Vec2 begin = search.wayTo(nextOf(mesh.in[last])),
               end = search.wayTo(beforeOf(mesh.in[first]));
    const Vec2 after = perpendicular(begin), before = -perpendicular(end);
    search.out().addFree(begin, after);
    search.out().addFree(after, before);
    search.out().addFree(before, end);
}

/// Whether BreadthFirst is faster up to this range.
bool isInBreadth(const ExpansionMesh& mesh, double range) {
    // There are about as many cells as triangles.
    const double per_area = mesh.columns_per_metre * mesh.rows_per_metre;
    return mesh.portals.size() >= 3 * kManyTriangles &&
           std::numbers::pi * square(range) * per_area >= kManyWithinRange;
}

/// False only if all points within kRayEpsilon of p lie strictly inside its triangle.
bool isNearEdge(const ExpansionMesh& mesh, Point2 p, Index triangle) {
    const std::size_t portal = std::size_t{3} * triangle;
    const Vec2 a = mesh.portals[portal].corner - p, b = mesh.portals[portal + 1].corner - p;
    const Vec2 c = mesh.portals[portal + 2].corner - p;
    const auto is_near = [](Vec2 from, Vec2 to) {
        return square(cross(from, to)) <= square(kRayEpsilon) * squaredLength(to - from);
    };
    return is_near(a, b) || is_near(b, c) || is_near(c, a);
}

bool isStrictlyInside(const Box2& box, Point2 p) {
    return box.low.x < p.x && p.x < box.high.x && box.low.y < p.y && p.y < box.high.y;
}

/// Moves a point on the boundary of the box outside, by one ulp.
Point2 offBoundary(const Box2& box, Point2 p) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto move = [](double x, double low, double high) {
        if (x == low) return std::nextafter(x, -kInfinity);
        return x == high ? std::nextafter(x, kInfinity) : x;
    };
    return {move(p.x, box.low.x, box.high.x), move(p.y, box.low.y, box.high.y)};
}

/// A query from inside of the box.
struct Query {
    const ExpansionMesh& mesh;
    Point2 viewpoint;
    Index triangle;  ///< with the viewpoint
    double range;
    double farthest;  ///< no corner is farther from the viewpoint
    std::span<const Index> transparent;
    std::vector<VisibilityEdge>& edges;
};

template <bool kBounded, bool kTouches>
ISPACE_INLINE void queryInside(const Query& query) {
    Expansion<kBounded, kTouches> search(query.mesh.portals.data(), query.viewpoint, query.range,
                                         query.farthest, query.transparent, query.edges);
    expandAround(query.mesh, query.triangle, search);
    search.run();
    search.out().finish();
}

/// Computes the same result as Expansion. Clones bring no speedup here.
template <bool kBounded>
void queryInBreadth(const Query& query) {
    Expansion<kBounded, false> search(query.mesh.portals.data(), query.viewpoint, query.range,
                                      query.farthest, {}, query.edges);
    BreadthFirst<kBounded> breadth(query.mesh.portals.data(), query.viewpoint, query.farthest,
                                   search);
    expandAround(query.mesh, query.triangle, breadth);
    breadth.run();
    search.out().finish();
}

// Most queries.
ISPACE_SIMD_CLONES [[gnu::flatten]] void queryFreely(const Query& query) {
    queryInside<false, false>(query);
}
ISPACE_SIMD_CLONES [[gnu::flatten]] void queryBounded(const Query& query) {
    queryInside<true, false>(query);
}

/// Divides the free directions from one point of the circle counter-clockwise to another by arcs of
/// a quarter turn, the last one of less. \param is_long more than a half turn
void addArcs(Point2 viewpoint, Point2 from, Point2 to, bool is_long,
             std::vector<VisibilityEdge>& edges) {
    const Vec2 end = to - viewpoint;
    const std::size_t first = edges.size();
    // After a whole number of quarter turns, rounding may lead a little beyond the end: that is no
    // turn that is left.
    const auto is_far = [&] {
        const Vec2 begin = from - viewpoint;
        const double along = dot(begin, end), left = cross(begin, end);
        const bool may_be_whole = is_long && edges.size() == first;
        return along < 0 || (may_be_whole ? !(left > 0) : left < -along / 2);
    };
    while (edges.size() < first + 4 && is_far()) {
        const Point2 next = viewpoint + perpendicular(from - viewpoint);
        edges.push_back({from, next, VisibilityEdge::kArc});
        from = next;
    }
    if (cross(from - viewpoint, end) > 0)
        edges.push_back({from, to, VisibilityEdge::kArc});
    else if (edges.size() > first)
        edges.back().to = to;
}

/// Lists the edges of a view from one on a line on, and divides arcs from there, so that they do
/// not depend on the triangle in which the view begins. \pre edges all around
void listFromLine(Point2 viewpoint, double range, std::vector<VisibilityEdge>& edges) {
    const auto is_before = [](const VisibilityEdge& a, const VisibilityEdge& b) {
        return a.line != b.line ? a.line < b.line : lexLess(a.from, b.from);
    };
    const auto first = std::min_element(edges.begin(), edges.end(), is_before);
    if (first == edges.end()) return;
    std::vector<VisibilityEdge> listed;
    if (first->line == VisibilityEdge::kArc) {
        const Point2 right = viewpoint + Vec2{range, 0};
        addArcs(viewpoint, right, right, true, listed);
    } else {
        std::rotate(edges.begin(), first, edges.end());
        listed.reserve(edges.size());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            if (edges[i].line != VisibilityEdge::kArc) {
                listed.push_back(edges[i]);
                continue;
            }
            const std::size_t begin = i;
            while (i + 1 < edges.size() && edges[i + 1].line == VisibilityEdge::kArc) ++i;
            addArcs(viewpoint, edges[begin].from, edges[i].to, i >= begin + 2, listed);
        }
    }
    edges = std::move(listed);
}

}  // namespace

struct VisibilityMap::Data {
    Data(std::span<const Segment2> lines, std::span<const Ellipse> ellipses) {
        constexpr std::size_t kMany = 1000;
        const auto make_rounds = [&] {
            rounds.emplace(ellipses, static_cast<Index>(lines.size()));
        };
        const auto make_meshes = [&] { meshes.emplace(lines); };
        if (ellipses.size() < kMany) {
            make_rounds();
            make_meshes();
        } else {
            // A waiting thread must not start other work.
            tbb::this_task_arena::isolate([&] { tbb::parallel_invoke(make_rounds, make_meshes); });
        }
    }
    std::optional<MeshTiles> meshes;
    std::optional<RoundBodies> rounds;
};

VisibilityMap::VisibilityMap(std::span<const Segment2> lines, std::span<const Ellipse> rounds)
    : data_(std::make_unique<Data>(lines, rounds)) {}
VisibilityMap::VisibilityMap(VisibilityMap&&) noexcept = default;
VisibilityMap& VisibilityMap::operator=(VisibilityMap&&) noexcept = default;
VisibilityMap::~VisibilityMap() = default;

void VisibilityMap::query(Point2 viewpoint, double max_range, VisibleRegion& region,
                          double reach) const {
    queryLines(viewpoint, max_range, reach, region);
    if (data_->meshes->isDivided()) listFromLine(region.viewpoint, region.max_range, region.edges);
    if (!data_->rounds->empty()) data_->rounds->cut(region);
}

void VisibilityMap::queryLines(Point2 viewpoint, double max_range, double reach,
                               VisibleRegion& region) const {
    viewpoint = withinSight(viewpoint);
    region.viewpoint = viewpoint;
    region.max_range = max_range;
    region.is_whole = true;
    region.edges.clear();
    if (!(max_range > 0)) return;

    const ExpansionMesh& mesh = data_->meshes->meshFor(viewpoint, std::max(max_range, reach));
    const bool inside = isStrictlyInside(mesh.box, viewpoint);
    if (!inside) viewpoint = offBoundary(mesh.box, viewpoint);
    Index triangle = 0;
    bool touches = false;
    std::optional<TouchedLines> finder;
    std::span<const Index> transparent;
    if (inside) {
        triangle = mesh.locate(viewpoint);
        if (isNearEdge(mesh, viewpoint, triangle)) {
            finder.emplace(mesh);
            finder->gather(viewpoint, triangle);
            touches = finder->found();
        }
    }
    if (touches) {
        viewpoint = finder->moved(viewpoint);
        triangle = mesh.locateFrom(viewpoint, triangle);
        finder->gather(viewpoint, triangle);
        transparent = finder->bothSides();
    }
    // An unbounded view ends somewhere beyond all lines.
    const double range =
        std::min(max_range, std::isinf(max_range) ? std::max(farthestIn(mesh.box, viewpoint),
                                                             data_->rounds->farthest(viewpoint))
                                                  : kMaxSight);
    if (touches) region.viewpoint = viewpoint;
    region.max_range = range;
    const bool bounded = range < farthestIn(mesh.cells_box, viewpoint);
    const double farthest = farthestIn(mesh.box, viewpoint);
    if (!inside) {
        Expansion<true, false> search(mesh.portals.data(), viewpoint, range, farthest, {},
                                      region.edges);
        expandFromOutside(mesh, viewpoint, search);
        search.out().finish();
        return;
    }
    const Query query{mesh, viewpoint, triangle, range, farthest, transparent, region.edges};
    if (touches)
        queryInside<true, true>(query);
    else if (bounded && isInBreadth(mesh, range))
        queryInBreadth<true>(query);
    else if (bounded)
        queryBounded(query);
    else if (mesh.portals.size() < 3 * kManyTriangles)
        queryFreely(query);
    else
        queryInBreadth<false>(query);
}

VisibleRegion VisibilityMap::query(Point2 viewpoint, double max_range) const {
    VisibleRegion region;
    query(viewpoint, max_range, region);
    return region;
}

}  // namespace ispace
