// SPDX-License-Identifier: GPL-3.0-or-later
// Views as wedges sorted by direction: a point is in the view if the wall of its wedge is behind
// it. Directions are compared by pseudo-angles, margins widen the search to neighbouring wedges.
// The floor is scaled to 2^20, so that epsilons of rays are fixed shares of it.
#include "extensions/proofs/gallery/star_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geom/arrangement.h"
#include "geom/predicates.h"

namespace ispace::proofs::gallery {

namespace {

/// Ascends from 0 to 4 with the direction.
double pseudoAngle(Vec2 v) {
    const double share = v.y / (std::abs(v.x) + std::abs(v.y));
    const double turn = v.x >= 0 ? share : 2 - share;
    return turn < 0 ? turn + 4 : turn;
}

Vec2 unitOf(Vec2 v) { return (1 / length(v)) * v; }

double scaleOf(std::span<const Region> regions) {
    double largest = 0;
    for (const Region& region : regions)
        for (const Point2 p : region.outline)
            largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    if (!(largest > 0)) return 1;
    int exponent;
    std::frexp(kScaledExtent / largest, &exponent);
    return std::ldexp(1.0, exponent - 1);
}

std::vector<Region> scaled(std::span<const Region> regions, double scale) {
    std::vector<Region> result(regions.begin(), regions.end());
    const auto enlarge = [scale](Polygon& curve) {
        for (Point2& p : curve) p = {scale * p.x, scale * p.y};
    };
    for (Region& region : result) {
        enlarge(region.outline);
        for (Polygon& hole : region.holes) enlarge(hole);
    }
    return result;
}

std::vector<Segment2> wallsOf(const std::vector<Region>& regions) {
    std::vector<Segment2> walls;
    for (const Region& region : regions)
        region.forEachEdge([&](const Segment2& edge) { walls.push_back(edge); });
    return walls;
}

/// Corners by position; without those at which curves touch.
std::vector<Corner> cornersOf(const std::vector<Region>& regions) {
    std::vector<Corner> all;
    for (const Region& region : regions)
        for (const Polygon& curve : curvesOf(region)) {
            const std::size_t n = curve.size();
            for (std::size_t i = 0; i < n; ++i) {
                const Point2 before = curve[(i + n - 1) % n], next = curve[(i + 1) % n];
                const bool is_convex = orientation(before, curve[i], next) == Turn::Left;
                all.push_back({curve[i], before, next, is_convex, false});
            }
        }
    std::sort(all.begin(), all.end(),
              [](const Corner& a, const Corner& b) { return lexLess(a.at, b.at); });
    std::vector<Corner> single;
    for (std::size_t i = 0; i < all.size(); ++i)
        if ((i == 0 || all[i - 1].at != all[i].at) &&
            (i + 1 == all.size() || all[i + 1].at != all[i].at))
            single.push_back(all[i]);
    return single;
}

/// Builds the outline of a region without parts that no wall bounds.
Polygon outlineAlongWalls(const VisibleRegion& region) {
    Polygon outline;
    const auto add = [&outline](Point2 p) {
        if (outline.empty() || outline.back() != p) outline.push_back(p);
    };
    if (!region.is_whole) add(region.viewpoint);
    for (const VisibilityEdge& edge : region.edges) {
        if (edge.line == VisibilityEdge::kArc) {
            add(region.viewpoint);
            continue;
        }
        add(edge.from);
        add(edge.to);
    }
    while (outline.size() > 1 && outline.front() == outline.back()) outline.pop_back();
    return outline;
}

}  // namespace

StarView::StarView(const VisibleRegion& region, std::span<const Segment2> walls)
    : viewpoint_(region.viewpoint), outline_(outlineAlongWalls(region)) {
    std::vector<Wedge> wedges;
    std::vector<double> turns;
    for (const VisibilityEdge& edge : region.edges) {
        const Vec2 from = edge.from - viewpoint_, to = edge.to - viewpoint_;
        if (edge.line == VisibilityEdge::kArc || from == Vec2() || to == Vec2()) continue;
        const Segment2& wall = walls[edge.line];
        Vec2 normal = unitOf(perpendicular(wall.b - wall.a));
        double depth = dot(normal, viewpoint_ - wall.a);
        if (depth < 0) {
            normal = -normal;
            depth = -depth;
        }
        wedges.push_back({unitOf(from), unitOf(to), normal, depth});
        turns.push_back(pseudoAngle(from));
        box_.add(edge.from);
        box_.add(edge.to);
    }
    box_.add(viewpoint_);
    // Directions ascend but for one wrap.
    std::size_t first = 0;
    for (std::size_t i = 1; i < turns.size(); ++i)
        if (turns[i] < turns[first]) first = i;
    std::rotate(wedges.begin(), wedges.begin() + static_cast<std::ptrdiff_t>(first), wedges.end());
    std::rotate(turns.begin(), turns.begin() + static_cast<std::ptrdiff_t>(first), turns.end());
    wedges_ = std::move(wedges);
    turns_ = std::move(turns);
}

bool StarView::mayHold(Point2 p, double margin) const {
    margin += kRounding;
    if (wedges_.empty() || !box_.expanded(margin).contains(p)) return false;
    const Vec2 way = p - viewpoint_;
    // Beyond, rays that pass within the margin lie within a sixth of a turn.
    if (dot(way, way) <= 4 * margin * margin) return true;
    const auto begin = turns_.begin();
    const std::size_t count = turns_.size();
    const auto above = std::upper_bound(begin, turns_.end(), pseudoAngle(way));
    const std::size_t own =
        above == begin ? count - 1 : static_cast<std::size_t>(above - begin) - 1;
    const auto begins_near = [&](const Wedge& wedge) {
        return cross(wedge.from, way) >= -margin && dot(way, wedge.from + wedge.to) > 0;
    };
    const auto ends_near = [&](const Wedge& wedge) {
        return cross(way, wedge.to) >= -margin && dot(way, wedge.from + wedge.to) > 0;
    };
    const auto is_in = [&](const Wedge& wedge) {
        return begins_near(wedge) && ends_near(wedge) &&
               dot(wedge.normal, way) + wedge.depth >= -margin;
    };
    // Clockwise over the wedges that end within the margin, then counter-clockwise.
    for (std::size_t k = 0, i = own; k < count; ++k, i = (i == 0 ? count : i) - 1) {
        if (is_in(wedges_[i])) return true;
        if (k > 0 && !ends_near(wedges_[i])) break;
    }
    for (std::size_t k = 1, i = (own + 1) % count; k < count; ++k, i = (i + 1) % count) {
        if (!begins_near(wedges_[i])) break;
        if (is_in(wedges_[i])) return true;
    }
    return false;
}

Floor::Floor(std::span<const Region> regions)
    : scale_(scaleOf(regions)),
      regions_(scaled(regions, scale_)),
      walls_(wallsOf(regions_)),
      corners_(cornersOf(regions_)),
      map_(walls_) {
    area_ = totalArea(regions_);
}

const Corner* Floor::exactCornerAt(Point2 p) const {
    const auto it =
        std::lower_bound(corners_.begin(), corners_.end(), p,
                         [](const Corner& corner, Point2 q) { return lexLess(corner.at, q); });
    return it != corners_.end() && it->at == p ? &*it : nullptr;
}

std::optional<Corner> Floor::cornerAt(Point2 p) const {
    if (const Corner* corner = exactCornerAt(p)) return *corner;
    for (const Segment2& wall : walls_) {
        if (distance(p, wall) > kOffLine) continue;
        if (distance(p, wall.a) < kClearance || distance(p, wall.b) < kClearance)
            return std::nullopt;
        return Corner{p, wall.a, wall.b, false, true};
    }
    return std::nullopt;
}

VisibleRegion Floor::viewFrom(Point2 p) const {
    VisibleRegion region = map_.query(p, 4 * kScaledExtent);
    const std::optional<Corner> corner = cornerAt(p);
    if (!corner) return region;
    p = region.viewpoint;
    const Vec2 first = corner->next - p, last = corner->before - p;
    std::vector<VisibilityEdge> inside;
    for (const VisibilityEdge& edge : region.edges) {
        const Vec2 way = unitOf(edge.from - p) + unitOf(edge.to - p);
        const bool is_left = cross(first, way) > 0;
        const bool is_right = corner->is_rounded ? is_left : cross(way, last) > 0;
        const bool is_inside = corner->is_convex ? is_left && is_right : is_left || is_right;
        if (edge.line != VisibilityEdge::kArc && is_inside) inside.push_back(edge);
    }
    // The order begins at the wall to the next corner.
    for (std::size_t i = 1; i < inside.size(); ++i) {
        if (inside[i - 1].to == inside[i].from) continue;
        const Vec2 end = inside[i - 1].to - p, start = inside[i].from - p;
        if (std::abs(cross(unitOf(end), unitOf(start))) < 0x1p-30 && dot(end, start) > 0) continue;
        std::rotate(inside.begin(), inside.begin() + static_cast<std::ptrdiff_t>(i), inside.end());
        break;
    }
    region.edges = std::move(inside);
    region.is_whole = false;
    return region;
}

std::optional<Window> Floor::windowTo(Point2 from, Point2 near, Point2 far,
                                      std::uint32_t hit) const {
    const Segment2& wall = walls_[hit];
    for (const Point2 end : {wall.a, wall.b})
        if (distance(far, end) < kClearance && !isConvexAt(end)) return std::nullopt;
    const Vec2 along = unitOf(wall.b - wall.a), sight = unitOf(far - from);
    const Window window{near, far, kRounding / std::abs(cross(along, sight))};
    return window.error < kClearance ? std::optional(window) : std::nullopt;
}

std::optional<Window> Floor::windowBetween(Point2 from, const VisibilityEdge& edge,
                                           const VisibilityEdge& next) const {
    const bool is_first_near = distance(from, edge.to) < distance(from, next.from);
    const Point2 near = is_first_near ? edge.to : next.from;
    const Segment2& passed = walls_[is_first_near ? edge.line : next.line];
    const Point2 end = distance(near, passed.a) < distance(near, passed.b) ? passed.a : passed.b;
    if (distance(near, end) > kRounding) return std::nullopt;
    return is_first_near ? windowTo(from, end, next.from, next.line)
                         : windowTo(from, end, edge.to, edge.line);
}

std::optional<std::vector<Window>> Floor::windowsOf(const VisibleRegion& region) const {
    if (region.edges.empty()) return std::nullopt;
    std::vector<Window> windows;
    const Point2 from = region.viewpoint;
    const std::size_t count = region.edges.size();
    for (const VisibilityEdge& edge : region.edges)
        if (edge.line == VisibilityEdge::kArc ||
            !(distance(from, Segment2{edge.from, edge.to}) > kClearance))
            return std::nullopt;
    const auto add = [&windows](const std::optional<Window>& window) {
        if (window) windows.push_back(*window);
        return window.has_value();
    };
    for (std::size_t i = 0; i + (region.is_whole ? 0 : 1) < count; ++i) {
        const VisibilityEdge& edge = region.edges[i];
        const VisibilityEdge& next = region.edges[(i + 1) % count];
        if (distance(edge.to, next.from) > kRounding && !add(windowBetween(from, edge, next)))
            return std::nullopt;
    }
    if (region.is_whole) return windows;
    const std::optional<Corner> corner = cornerAt(from);
    if (!corner) return std::nullopt;
    const VisibilityEdge &first = region.edges.front(), &last = region.edges.back();
    if (distance(first.from, corner->next) > kRounding &&
        !add(windowTo(from, corner->next, first.from, first.line)))
        return std::nullopt;
    if (distance(last.to, corner->before) > kRounding &&
        !add(windowTo(from, corner->before, last.to, last.line)))
        return std::nullopt;
    // Rounding moves the lines of sight from a point on a wall, beyond their near end by more.
    constexpr double kMaxLever = kRounding / (2 * kOffLine);
    const auto is_long = [from](const Window& window) {
        return distance(from, window.far) > kMaxLever * distance(from, window.near);
    };
    if (corner->is_rounded && std::any_of(windows.begin(), windows.end(), is_long))
        return std::nullopt;
    return windows;
}

}  // namespace ispace::proofs::gallery
