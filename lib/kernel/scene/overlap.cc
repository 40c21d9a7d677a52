// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/overlap.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "env/body.h"
#include "env/point_location.h"
#include "env/slice.h"
#include "geom/arrangement.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

struct Span {
    double low = std::numeric_limits<double>::infinity(), high = -low;
};

Span spanOf(const Polygon& polygon, Vec2 direction) {
    Span span;
    for (const Point2 p : polygon) {
        const double at = dot(p - Point2(), direction);
        span.low = std::min(span.low, at);
        span.high = std::max(span.high, at);
    }
    return span;
}

/// Computes the overlap of two spans; the shorter way out if one contains the other.
double depthAlong(const Polygon& a, const Polygon& b, Vec2 direction) {
    const Span s = spanOf(a, direction), t = spanOf(b, direction);
    return std::min(s.high - t.low, t.high - s.low);
}

Point2 middleOf(const Polygon& polygon) {
    // Relative to the first vertex, to keep precision far from the origin.
    Vec2 sum;
    for (const Point2 p : polygon) sum = sum + (p - polygon.front());
    return polygon.front() + 1 / static_cast<double>(polygon.size()) * sum;
}

/// Computes the least depth along the normals of the edges of `edges`; empty if the two are apart.
/// O(n + m): the normals turn once around.
std::optional<double> leastDepth(const Polygon& edges, const Polygon& a, const Polygon& b,
                                 double least) {
    // Four calipers, as the normals rotate: the extent of each polygon in both directions.
    Caliper a_there(a), a_back(a), b_there(b), b_back(b);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Vec2 side = edges[i + 1 == edges.size() ? 0 : i + 1] - edges[i];
        const double extent = length(side);
        if (extent == 0) continue;
        const Vec2 normal = 1 / extent * perpendicular(side), back = -1 * normal;
        least = std::min({least, a_there.reach(normal) + b_back.reach(back),
                          b_there.reach(normal) + a_back.reach(back)});
        if (least <= kCornerTolerance) return std::nullopt;
    }
    return least;
}

/// Clips a line to the part that lies deeper than kCornerTolerance in a convex polygon.
std::optional<Segment2> pieceWithin(const Segment2& line, const Polygon& convex) {
    const Vec2 along = line.b - line.a;
    double from = 0, to = 1;
    for (std::size_t i = 0; i < convex.size(); ++i) {
        const Point2 a = convex[i], b = convex[i + 1 == convex.size() ? 0 : i + 1];
        const double extent = distance(a, b);
        if (extent == 0) continue;
        const double start = cross(b - a, line.a - a) / extent - kCornerTolerance;
        const double rise = cross(b - a, along) / extent;
        if (rise == 0) {
            if (start < 0) return std::nullopt;
        } else if (rise > 0) {
            from = std::max(from, -start / rise);
        } else {
            to = std::min(to, -start / rise);
        }
    }
    if ((to - from) * length(along) <= kCornerTolerance) return std::nullopt;
    return Segment2{line.a + from * along, line.a + to * along};
}

/// Returns the parameters along the line (0 .. 1) where the polygon's edges meet it, ends included,
/// sorted.
std::vector<double> meetings(const Segment2& line, const Polygon& polygon) {
    const Vec2 along = line.b - line.a;
    const double square = dot(along, along);
    const Box2 box = bounds(line);
    std::vector<double> at{0, 1};
    forEachEdge(polygon, [&](const Segment2& edge) {
        if (!bounds(edge).meets(box)) return;
        const Vec2 other = edge.b - edge.a;
        const double turn = cross(along, other);
        if (turn == 0) {
            for (const Point2 p : {edge.a, edge.b}) at.push_back(dot(p - line.a, along) / square);
        } else {
            at.push_back(cross(edge.a - line.a, other) / turn);
        }
    });
    std::erase_if(at, [](double t) { return !(t >= 0 && t <= 1); });
    std::sort(at.begin(), at.end());
    return at;
}

/// Finds a point beside an edge of `a`, inside it, that also lies in `b`: for coincident outlines.
std::optional<Point2> placeBeside(const Polygon& a, const Polygon& b) {
    constexpr double kBeside = 0.01;
    for (std::size_t i = 0; i < a.size() && i < 8; ++i) {
        const Point2 p = a[i], q = a[i + 1 == a.size() ? 0 : i + 1];
        const Point2 beside = p + 0.5 * (q - p) + kBeside * perpendicular(q - p);
        if (containsWithMargin(a, beside, kCornerTolerance) &&
            containsWithMargin(b, beside, kCornerTolerance))
            return beside;
    }
    return std::nullopt;
}

std::optional<Point2> edgeWithin(const Polygon& a, const Polygon& b) {
    const Box2 box = bounds(b);
    std::optional<Point2> place;
    forEachEdge(a, [&](const Segment2& edge) {
        if (!place && bounds(edge).meets(box)) place = placeWithin(edge, b);
    });
    return place;
}

}  // namespace

std::optional<Overlap> overlapOf(const Polygon& a, const Polygon& b) {
    // Separate elements are mostly separated along the line between their middles.
    const Vec2 way = middleOf(b) - middleOf(a);
    if (length(way) > 0 && depthAlong(a, b, 1 / length(way) * way) <= kCornerTolerance)
        return std::nullopt;
    const double most = std::numeric_limits<double>::infinity();
    const auto first = leastDepth(a, a, b, most);
    if (!first) return std::nullopt;
    const auto depth = leastDepth(b, a, b, *first);
    if (!depth) return std::nullopt;
    if (b.size() == 2) {
        const auto piece = pieceWithin({b[0], b[1]}, a);
        return Overlap{*depth, piece ? middleOf({piece->a, piece->b}) : middleOf(b)};
    }
    const Polygon shared = sharedByConvex(a, b);
    return Overlap{*depth, middleOf(shared.empty() ? b : shared)};
}

double penetrationDepth(const Polygon& a, const Polygon& b, Vec2 direction) {
    return spanOf(a, direction).high - spanOf(b, direction).low;
}

std::optional<Point2> placeWithin(const Segment2& line, const Polygon& polygon) {
    const std::vector<double> at = meetings(line, polygon);
    const double extent = distance(line.a, line.b);
    for (std::size_t i = 1; i < at.size(); ++i) {
        if ((at[i] - at[i - 1]) * extent <= kCornerTolerance) continue;
        const Point2 middle = line.a + (at[i - 1] + at[i]) / 2 * (line.b - line.a);
        if (containsWithMargin(polygon, middle, kCornerTolerance)) return middle;
    }
    return std::nullopt;
}

std::optional<Point2> sharedPlace(const Slice& cut, const Polygon& convex) {
    const Box2 box = bounds(convex);
    std::optional<Point2> place;
    if (convex.size() == 2) {
        for (const Polygon& solid : cut.solids) {
            if (!place && bounds(solid).meets(box))
                place = placeWithin({convex[0], convex[1]}, solid);
        }
        return place;
    }
    cut.forEachLine([&](const Segment2& line) {
        if (place || !bounds(line).meets(box)) return;
        if (const auto piece = pieceWithin(line, convex)) place = middleOf({piece->a, piece->b});
    });
    // No line of the cut enters the polygon: it lies wholly in a solid, or outside all.
    const Point2 middle = middleOf(convex);
    if (!place && cut.blocked(middle)) place = middle;
    return place;
}

std::optional<Point2> sharedPlace(const Slice& a, const Slice& b) {
    for (const Polygon& s : a.solids)
        for (const Polygon& t : b.solids) {
            if (!bounds(s).meets(bounds(t))) continue;
            if (auto place = edgeWithin(s, t)) return place;
            if (auto place = edgeWithin(t, s)) return place;
            if (auto place = placeBeside(s, t)) return place;
        }
    for (const auto& [sheets, solids] : {std::pair(&a.sheets, &b.solids), {&b.sheets, &a.solids}})
        for (const Segment2& line : *sheets)
            for (const Polygon& solid : *solids)
                if (bounds(line).meets(bounds(solid)))
                    if (auto place = placeWithin(line, solid)) return place;
    return std::nullopt;
}

Parts::Parts(const Environment& environment, const std::function<bool(const Box2&)>& keep) {
    const std::vector<Element>& elements = environment.elements();
    first_.reserve(elements.size() + 1);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        first_.push_back(parts_.size());
        for (const Prism& prism : elements[i].body.prisms)
            if (!keep || keep(bounds(prism.footprint))) add(i, prism);
        for (const Sheet& sheet : elements[i].body.sheets)
            if (!keep || keep(bounds(sheet.line)))
                parts_.push_back({i, {sheet.line.a, sheet.line.b}, sheet.bottom, sheet.top});
    }
    first_.push_back(parts_.size());
    std::vector<Box2> boxes;
    boxes.reserve(parts_.size());
    for (const Part& part : parts_) boxes.push_back(bounds(part.footprint));
    tree_ = BoxTree(boxes);
}

void Parts::add(std::size_t element, const Prism& prism) {
    if (isConvex(prism.footprint)) {
        parts_.push_back({element, prism.footprint, prism.bottom, prism.top});
        return;
    }
    const Triangulation pieces = triangulate({prism.footprint, {}});
    for (const auto& [i, j, k] : pieces.triangles)
        parts_.push_back({element,
                          {pieces.vertices[i], pieces.vertices[j], pieces.vertices[k]},
                          prism.bottom,
                          prism.top});
}

std::span<const Part> Parts::of(std::size_t element) const {
    return {parts_.data() + first_[element], first_[element + 1] - first_[element]};
}

MeshCuts::MeshCuts(const Body& body) : body_(&body) {
    heights_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Mesh& mesh : body.meshes)
        for (const Point3& p : mesh.vertices) {
            box_.add(p.onFloor());
            heights_.bottom = std::min(heights_.bottom, p.z);
            heights_.top = std::max(heights_.top, p.z);
        }
}

const Slice& MeshCuts::at(double height) {
    constexpr std::size_t kKept = 256;
    if (cuts_.size() >= kKept && !cuts_.contains(height)) cuts_.clear();
    const auto [place, is_new] = cuts_.try_emplace(height);
    if (is_new) cutMeshes(*body_, height, place->second);
    return place->second;
}

std::vector<double> MeshCuts::heightsIn(const HeightRange& heights) const {
    constexpr int kLevels = 32, kMax = 5;
    std::vector<double> levels;
    for (int i = 0; i < kLevels; ++i) {
        const double height =
            heights_.bottom + (heights_.top - heights_.bottom) * (i + 0.5) / kLevels;
        if (height > heights.bottom && height < heights.top) levels.push_back(height);
    }
    if (levels.empty()) return {heights.bottom + (heights.top - heights.bottom) / 2};
    std::vector<double> some;
    const std::size_t count = std::min<std::size_t>(levels.size(), kMax);
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(levels[i * (levels.size() - 1) / std::max<std::size_t>(count - 1, 1)]);
    return some;
}

}  // namespace ispace
