// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/arrangement.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

constexpr auto kHint = "leave out some of what lies upon each other";

/// Appends the edges, turned so that the curve has this orientation: the winding number inside is
/// higher by `added` or `removed`.
void addCurve(const Polygon& curve, bool counter_clockwise, int added, int removed,
              std::vector<LinePiece>& lines) {
    const int turn = (signedArea(curve) > 0) != counter_clockwise ? -1 : 1;
    forEachEdge(curve, [&](const Segment2& edge) {
        lines.push_back(
            {edge, static_cast<std::uint32_t>(lines.size()), turn * added, turn * removed, false});
    });
}

/// Boxes of segments of some region, or of several.
struct EdgeTree {
    std::vector<Segment2> edges;
    std::vector<std::size_t> owners;  // index of the region
    BoxTree tree;

    explicit EdgeTree(std::span<const Region> regions) {
        for (std::size_t i = 0; i < regions.size(); ++i)
            regions[i].forEachEdge([&](const Segment2& edge) {
                edges.push_back(edge);
                owners.push_back(i);
            });
        tree = BoxTree(boundsOfEach(edges));
    }

    [[nodiscard]] bool meets(const Box2& box) const {
        bool any = false;
        tree.search(box, [&](std::size_t) { any = true; });
        return any;
    }

    /// Finds the region that contains p, by the parity of edges above it. \pre p lies on no edge
    [[nodiscard]] std::optional<std::size_t> regionAt(Point2 p) const {
        std::map<std::size_t, bool> odd;
        const Box2 above{p, {p.x, std::numeric_limits<double>::infinity()}};
        tree.search(above, [&](std::size_t i) {
            const auto [left, right] =
                std::minmax(edges[i].a, edges[i].b, [](Point2 a, Point2 b) { return a.x < b.x; });
            if (left.x > p.x || right.x <= p.x || orientation(left, right, p) != Turn::Right)
                return;
            bool& is_odd = odd[owners[i]];
            is_odd = !is_odd;
        });
        for (const auto& [owner, is_odd] : odd)
            if (is_odd) return owner;
        return std::nullopt;
    }
};

/// Finds the boxes that meet no other box.
std::vector<bool> alone(const std::vector<Box2>& boxes) {
    // Boxes that coincide are searched for once: each of many would find all of them.
    std::map<std::array<double, 4>, std::size_t> copies;
    const auto key = [](const Box2& box) {
        return std::array{box.low.x, box.low.y, box.high.x, box.high.y};
    };
    std::vector<Box2> distinct;
    for (const Box2& box : boxes)
        if (++copies[key(box)] == 1) distinct.push_back(box);
    const BoxTree tree(distinct);
    std::vector<bool> out;
    out.reserve(boxes.size());
    for (const Box2& box : boxes) {
        std::size_t met = copies[key(box)];
        if (met == 1) {
            met = 0;
            tree.search(box, [&met](std::size_t) { ++met; });
        }
        out.push_back(met == 1);
    }
    return out;
}

}  // namespace

std::vector<Region> difference(const Region& region, std::span<const Polygon> solids) {
    std::vector<LinePiece> lines;
    addCurve(region.outline, true, 1, 0, lines);
    for (const Polygon& hole : region.holes) addCurve(hole, false, 1, 0, lines);
    const Box2 box = bounds(region.outline);
    const std::vector<Box2> boxes = boundsOfEach(solids);
    // Most furniture is apart from other solids and simply becomes a hole.
    const std::vector<bool> is_alone = alone(boxes);
    const EdgeTree walls({&region, 1});
    std::vector<std::size_t> clear;
    for (std::size_t i = 0; i < solids.size(); ++i) {
        if (!box.meets(boxes[i])) continue;
        if (is_alone[i] && !walls.meets(boxes[i]))
            clear.push_back(i);
        else
            addCurve(solids[i], true, 0, 1, lines);
    }
    std::vector<Region> pieces = differenceOf(std::move(lines), {"outlines", kHint});
    const EdgeTree edges(pieces);
    for (const std::size_t i : clear) {
        const auto piece = edges.regionAt(solids[i].front());
        if (!piece) continue;
        Polygon hole = solids[i];
        if (signedArea(hole) > 0) std::reverse(hole.begin(), hole.end());
        pieces[*piece].holes.push_back(std::move(hole));
    }
    return pieces;
}

std::vector<Region> difference(const Regions& regions, std::span<const Polygon> solids) {
    std::vector<Region> pieces;
    for (const Region& part : regions.parts)
        for (Region& piece : difference(part, solids)) pieces.push_back(std::move(piece));
    return pieces;
}

std::vector<Region> unite(std::span<const Polygon> solids) {
    std::vector<LinePiece> lines;
    for (const Polygon& solid : solids) addCurve(solid, true, 1, 0, lines);
    return differenceOf(std::move(lines), {"outlines", kHint});
}

double totalArea(std::span<const Region> regions) {
    double sum = 0;
    for (const Region& region : regions) sum += region.area();
    return sum;
}

namespace {

/// Cosine of the largest turn that is followed by walking: on the far side of a polygon rounding
/// could end a walk at once.
constexpr double kTurned = 0.7;

/// A convex polygon cut by lines that turn once around.
///
/// Its vertices form a ring of links. A cut walks from the last vertex to the one deepest behind
/// the line and removes the vertices around it: each is removed once.
class Remainder {
  public:
    explicit Remainder(const Polygon& polygon) {
        const std::size_t n = polygon.size();
        links_.reserve(2 * n);
        for (std::size_t i = 0; i < n; ++i)
            links_.push_back({polygon[i], i == 0 ? n - 1 : i - 1, i + 1 == n ? 0 : i + 1});
        count_ = n;
    }

    /// Clips the polygon to the left side of the line.
    void cut(Point2 a, Point2 b) {
        const Vec2 along = b - a;
        const double extent = length(along);
        if (count_ == 0 || extent == 0) return;
        const auto depth = [&](std::size_t i) { return cross(along, links_[i].p - a); };
        findLowest(1 / extent * along, depth);
        if (depth(at_) >= 0) return;
        std::size_t first = at_, last = at_, taken = 1;
        for (; taken < count_ && depth(links_[last].next) < 0; ++taken) last = links_[last].next;
        for (; taken < count_ && depth(links_[first].prev) < 0; ++taken) first = links_[first].prev;
        if (taken == count_) {
            count_ = 0;
            return;
        }
        const auto crossing = [&](std::size_t i, std::size_t k) {
            const double s = depth(i), t = depth(k);
            return links_[i].p + s / (s - t) * (links_[k].p - links_[i].p);
        };
        const std::size_t before = links_[first].prev, after = links_[last].next;
        const std::size_t in = links_.size(), out = in + 1;
        const Point2 enters = crossing(before, first), leaves = crossing(last, after);
        links_.push_back({enters, before, out});
        links_.push_back({leaves, in, after});
        links_[before].next = in;
        links_[after].prev = out;
        count_ = count_ - taken + 2;
        at_ = in;
    }

    [[nodiscard]] Polygon corners() const {
        Polygon polygon;
        polygon.reserve(count_);
        for (std::size_t i = at_; polygon.size() < count_; i = links_[i].next)
            polygon.push_back(links_[i].p);
        return polygon;
    }

  private:
    struct Link {
        Point2 p;
        std::size_t prev, next;
    };
    std::vector<Link> links_;
    std::size_t count_ = 0, at_ = 0;
    Vec2 last_;

    template <typename Depth>
    void findLowest(Vec2 along, const Depth& depth) {
        const bool jumped = dot(along, last_) < kTurned;
        last_ = along;
        double least = depth(at_);
        std::size_t steps = 0;
        for (const auto way : {&Link::next, &Link::prev}) {
            for (std::size_t i = links_[at_].*way; steps < count_; i = links_[i].*way, ++steps) {
                const double next = depth(i);
                if (next > least && !jumped) break;
                if (next > least) continue;
                least = next;
                at_ = i;
            }
        }
    }
};

}  // namespace

double Caliper::reach(Vec2 direction) {
    const auto reach_of = [&](std::size_t i) { return dot(corners_[i] - Point2(), direction); };
    const std::size_t n = corners_.size();
    const bool jumped = dot(direction, last_) < kTurned;
    last_ = direction;
    double most = reach_of(at_);
    std::size_t steps = 0;
    for (const std::size_t step : {std::size_t{1}, n - 1}) {
        for (std::size_t i = (at_ + step) % n; steps < n; i = (i + step) % n, ++steps) {
            const double next = reach_of(i);
            if (next < most && !jumped) break;
            if (next < most) continue;
            most = next;
            at_ = i;
        }
    }
    return most;
}

Polygon sharedByConvex(const Polygon& a, const Polygon& b) {
    Remainder rest(a);
    forEachEdge(b, [&](const Segment2& edge) { rest.cut(edge.a, edge.b); });
    return rest.corners();
}

}  // namespace ispace
