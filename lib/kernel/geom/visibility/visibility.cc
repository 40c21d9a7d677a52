// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/polygon.h"
#include "geom/predicates.h"
#include "geom/visibility/visibility_mesh.h"

namespace ispace {

namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;

bool isArc(const VisibilityEdge& edge) { return edge.line == VisibilityEdge::kArc; }

/// Computes the angle from direction a counter-clockwise to b, in [0, 2 pi).
double angleBetween(Vec2 a, Vec2 b) {
    const double angle = std::atan2(cross(a, b), dot(a, b));
    return angle < 0 ? angle + kWholeTurn : angle;
}

/// Computes the point of the edge in a direction.
Point2 pointIn(const VisibleRegion& region, const VisibilityEdge& edge, Vec2 direction) {
    if (isArc(edge)) return region.viewpoint + region.max_range * direction;
    const Vec2 a = edge.from - region.viewpoint, b = edge.to - region.viewpoint;
    const double right = -cross(direction, a), left = cross(direction, b);
    // Written so that 0 / 0 gives 0.
    const double share = std::min(1.0, std::max(0.0, right / (right + left)));
    return edge.from + share * (edge.to - edge.from);
}

void addEdge(VisibleRegion& region, const VisibilityEdge& edge) {
    if (cross(edge.from - region.viewpoint, edge.to - region.viewpoint) > 0)
        region.edges.push_back(edge);
}

}  // namespace

double area(const VisibleRegion& region) {
    double twice = 0;
    for (const VisibilityEdge& edge : region.edges) {
        const Vec2 from = edge.from - region.viewpoint, to = edge.to - region.viewpoint;
        twice += isArc(edge) ? region.max_range * region.max_range * angleBetween(from, to)
                             : cross(from, to);
    }
    return twice / 2;
}

Curve outlineOf(const VisibleRegion& region) {
    Curve curve;
    if (region.edges.empty()) return curve;
    curve.reserve(2 * region.edges.size() + 2);
    const auto go_to = [&curve](Point2 from, Point2 to) {
        if (from != to) curve.push_back({from, to});
    };
    if (!region.is_whole) go_to(region.viewpoint, region.edges.front().from);
    for (std::size_t i = 0; i < region.edges.size(); ++i) {
        const VisibilityEdge& edge = region.edges[i];
        if (i > 0) go_to(region.edges[i - 1].to, edge.from);
        curve.push_back({edge.from, edge.to});
        if (isArc(edge)) {
            curve.back().radius = region.max_range;
            curve.back().center = region.viewpoint;
        }
    }
    const Point2 last = region.edges.back().to;
    if (region.is_whole) {
        go_to(last, region.edges.front().from);
    } else {
        go_to(last, region.viewpoint);
    }
    return curve;
}

VisibleRegion sectorOf(const VisibleRegion& region, Angle first, Angle span) {
    if (span >= Angle::degrees(360)) return region;
    VisibleRegion sector{region.viewpoint, region.max_range, false, {}};
    if (region.edges.empty() || !(span > Angle())) return sector;
    const Vec2 begin = unitVector(first), stop = unitVector(first + span);
    // The sector begins in the first edge that ends after `begin`: where the angles drop by almost
    // a turn. The least of them may be a tie, or one of the last by rounding.
    std::vector<double> stops;
    stops.reserve(region.edges.size());
    for (const VisibilityEdge& edge : region.edges)
        stops.push_back(angleBetween(begin, edge.to - region.viewpoint));
    std::size_t start = 0;
    double drop = stops.back() - stops.front();
    for (std::size_t i = 1; i < stops.size(); ++i)
        if (stops[i - 1] - stops[i] > drop) {
            drop = stops[i - 1] - stops[i];
            start = i;
        }
    const std::size_t count = region.edges.size();
    sector.edges.reserve(count + 1);
    for (std::size_t i = 0; i <= count; ++i) {
        VisibilityEdge edge = region.edges[(start + i) % count];
        const bool comes_back = i == count;
        const double from = angleBetween(begin, edge.from - region.viewpoint);
        // If the first edge begins before the sector, its angle is almost a whole turn.
        const bool is_split = (i == 0 || comes_back) && from > stops[start];
        if (comes_back && !is_split) break;
        // All others begin where the previous one ended, whatever their angle rounds to.
        if (i == 0 && is_split)
            edge.from = pointIn(region, edge, begin);
        else if (i == 0 && from >= span.radians())
            break;
        const bool is_last = comes_back || stops[(start + i) % count] >= span.radians();
        if (is_last) edge.to = pointIn(region, edge, stop);
        addEdge(sector, edge);
        if (is_last) break;
    }
    return sector;
}

bool holds(const VisibleRegion& region, Point2 p) {
    const Vec2 way = p - region.viewpoint;
    if (way == Vec2()) return !region.edges.empty();
    return std::any_of(region.edges.begin(), region.edges.end(), [&](const VisibilityEdge& edge) {
        const Vec2 from = edge.from - region.viewpoint, to = edge.to - region.viewpoint;
        if (cross(from, way) < 0 || cross(way, to) < 0) return false;
        if (isArc(edge)) return dot(way, way) <= region.max_range * region.max_range;
        return cross(to - from, way - from) >= 0;
    });
}

namespace {

using Index = std::uint32_t;

double squaredLength(Vec2 v) { return dot(v, v); }

constexpr double kSquaredEpsilon = kRayEpsilon * kRayEpsilon;

}  // namespace

void TouchedLines::gather(Point2 p, Index triangle) {
    lines_.clear();
    triangles_.clear();
    many_.clear();
    add(triangle);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        for (Index edge = 3 * triangles_[i], k = 0; k < 3; ++k, ++edge) {
            if (squaredDistance(p, edge) > kSquaredEpsilon) continue;
            if (mesh_.isLine(edge)) lines_.push_back(edge);
            const Index behind = mesh_.portals[edge].behind;
            if (behind != Portal::kFree) add(behind / 3);
        }
    }
}

Point2 TouchedLines::moved(Point2 p) const {
    double least = kSquaredEpsilon;
    Point2 nearest = p;
    bool is_vertex = false;
    for (const Index edge : lines_) {
        for (const Index end : {nextOf(edge), beforeOf(edge)}) {
            const double squared = squaredLength(mesh_.portals[end].corner - p);
            if (!(squared <= least)) continue;
            least = squared;
            nearest = mesh_.portals[end].corner;
            is_vertex = true;
        }
    }
    if (is_vertex) return nearest;
    least = std::numeric_limits<double>::infinity();
    for (const Index edge : lines_) {
        const double squared = squaredDistance(p, edge);
        if (!(squared < least)) continue;
        least = squared;
        nearest = nearestPoint(wallOf(edge), p);
    }
    return nearest;
}

std::span<const Index> TouchedLines::bothSides() {
    const std::size_t count = lines_.size();
    for (std::size_t i = 0; i < count; ++i) lines_.push_back(mesh_.portals[lines_[i]].behind);
    std::sort(lines_.begin(), lines_.end());
    lines_.erase(std::unique(lines_.begin(), lines_.end()), lines_.end());
    return lines_;
}

Segment2 TouchedLines::wallOf(Index edge) const {
    return {mesh_.portals[nextOf(edge)].corner, mesh_.portals[beforeOf(edge)].corner};
}

double TouchedLines::squaredDistance(Point2 p, Index edge) const {
    return squaredLength(nearestPoint(wallOf(edge), p) - p);
}

void TouchedLines::add(Index triangle) {
    // Seldom more than a few.
    constexpr std::size_t kFew = 32;
    if (triangles_.size() < kFew) {
        if (std::find(triangles_.begin(), triangles_.end(), triangle) != triangles_.end()) return;
    } else {
        if (many_.empty()) many_.insert(triangles_.begin(), triangles_.end());
        if (!many_.insert(triangle).second) return;
    }
    triangles_.push_back(triangle);
}

}  // namespace ispace
