// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/least_exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace::goals {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Calls visit(before, at, after) for each vertex of the boundary, the region on its left.
template <typename Visit>
void forEachVertex(const Region& region, Visit visit) {
    const auto along = [&visit](const Polygon& curve) {
        const std::size_t n = curve.size();
        for (std::size_t i = 0; i < n; ++i)
            visit(curve[(i + n - 1) % n], curve[i], curve[(i + 1) % n]);
    };
    along(region.outline);
    for (const Polygon& hole : region.holes) along(hole);
}

/// Returns true where the boundary turns right, or back at the end of a slit.
bool isReflex(Point2 before, Point2 at, Point2 after) {
    const Turn turn = orientation(before, at, after);
    return turn == Turn::Right || (turn == Turn::Straight && dot(at - before, after - at) < 0);
}

}  // namespace

FloorSight::FloorSight(std::span<const Region> regions, double tolerance)
    : index_(regions), tolerance_(tolerance) {
    for (const Region& region : regions) {
        longest_ += region.boundaryLength();
        forEachVertex(region, [this](Point2 before, Point2 at, Point2 after) {
            if (isReflex(before, at, after)) corners_.push_back({at, before, after});
        });
    }
}

bool FloorSight::sees(Point2 a, Point2 b) const {
    const double reach = distance(a, b);
    if (reach <= tolerance_) return true;
    const Vec2 along = (1 / reach) * (b - a);
    std::vector<double> touched = {0, reach};
    bool is_cut = false;
    index_.edgesIn(bounds(Segment2{a, b}).expanded(tolerance_), [&](const Segment2& edge) {
        if (is_cut) return;
        const double left = cross(along, edge.a - a), right = cross(along, edge.b - a);
        const double at_a = dot(along, edge.a - a), at_b = dot(along, edge.b - a);
        if (std::abs(left) <= tolerance_ || std::abs(right) <= tolerance_) {
            for (const auto& [off, at] : {std::pair(left, at_a), {right, at_b}})
                if (std::abs(off) <= tolerance_ && at > 0 && at < reach) touched.push_back(at);
        } else if ((left > 0) != (right > 0)) {
            const double at = at_a + (at_b - at_a) * left / (left - right);
            is_cut = at > tolerance_ && at < reach - tolerance_;
        }
    });
    if (is_cut) return false;
    std::sort(touched.begin(), touched.end());
    for (std::size_t i = 1; i < touched.size(); ++i) {
        if (touched[i] - touched[i - 1] <= 4 * tolerance_) continue;
        const Point2 middle = a + (touched[i - 1] + touched[i]) / 2 * along;
        if (!index_.isWithin(middle, tolerance_)) return false;
    }
    return true;
}

bool FloorSight::isTangent(const Corner& corner, Point2 towards) const {
    const Vec2 way = towards - corner.at;
    const double slack = tolerance_ * length(way);
    const double one = cross(way, corner.before - corner.at);
    const double other = cross(way, corner.after - corner.at);
    return !(one > slack && other < -slack) && !(one < -slack && other > slack);
}

std::vector<Point2> FloorSight::shortestPath(Point2 from, Point2 to) const {
    if (sees(from, to)) return {from, to};
    const std::size_t n = corners_.size();
    std::vector<double> lengths(n, kFar);
    std::vector<std::size_t> before(n, n);  // n: `from`
    std::vector<bool> is_done(n);
    using Open = std::pair<double, std::size_t>;  // the least length through it
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    const auto extend = [&](Point2 at, double length, std::size_t by) {
        for (std::size_t i = 0; i < n; ++i) {
            const Corner& corner = corners_[i];
            const double reached = length + distance(at, corner.at);
            if (is_done[i] || reached >= lengths[i] || !isTangent(corner, at) ||
                (by < n && !isTangent(corners_[by], corner.at)) || !sees(at, corner.at))
                continue;
            lengths[i] = reached;
            before[i] = by;
            open.emplace(reached + distance(corner.at, to), i);
        }
    };
    extend(from, 0, n);
    while (!open.empty()) {
        const std::size_t i = open.top().second;
        open.pop();
        if (is_done[i]) continue;
        is_done[i] = true;
        if (sees(corners_[i].at, to)) {
            std::vector<Point2> way = {to};
            for (std::size_t k = i; k < n; k = before[k]) way.push_back(corners_[k].at);
            way.push_back(from);
            std::reverse(way.begin(), way.end());
            return way;
        }
        extend(corners_[i].at, lengths[i], i);
    }
    return {};
}

namespace {

/// A point at which exposed legs begin or end: a convex vertex of a hidden region, or a corner of
/// the floor.
struct LegEnd {
    FloorSight::Corner corner;
    std::size_t node = 0;
};

/// Dijkstra over hidden regions, numbered first, and corners of the floor.
class ExposureSearch {
  public:
    ExposureSearch(const FloorSight& floor, std::span<const Region> hidden,
                   const std::vector<bool>& starts, const std::vector<bool>& goals)
        : floor_(floor), hidden_(hidden), starts_(starts), goals_(goals) {
        for (std::size_t k = 0; k < hidden.size(); ++k) {
            first_edge_.push_back(edges_.size());
            first_end_.push_back(ends_.size());
            hidden[k].forEachEdge([&](const Segment2& edge) { edges_.push_back({edge, k}); });
            forEachVertex(hidden[k], [&](Point2 before, Point2 at, Point2 after) {
                if (orientation(before, at, after) == Turn::Left)
                    ends_.push_back({{at, before, after}, k});
            });
        }
        first_edge_.push_back(edges_.size());
        const RegionIndex index(hidden);
        for (const FloorSight::Corner& corner : floor.corners()) {
            if (index.locate(corner.at) == Side::Inside) continue;
            first_end_.push_back(ends_.size());
            ends_.push_back({corner, first_end_.size() - 1});
        }
        first_end_.push_back(ends_.size());
        std::vector<Box2> boxes;
        for (const Edge& edge : edges_) boxes.push_back(bounds(edge.line));
        edge_tree_ = BoxTree(boxes);
        boxes.clear();
        for (const LegEnd& end : ends_) boxes.push_back({end.corner.at, end.corner.at});
        end_tree_ = BoxTree(boxes);
    }

    std::optional<ExposedPath> run() {
        const double longest = floor_.longest();
        for (double limit = std::min(kFirstLimit, longest);; limit = std::min(2 * limit, longest)) {
            if (const auto goal = searchWithin(limit)) return wayTo(*goal);
            if (limit >= longest) return std::nullopt;
        }
    }

  private:
    static constexpr double kFirstLimit = 1;  // metres

    struct Edge {
        Segment2 line;
        std::size_t region = 0;
    };
    struct Node {
        double exposed = kFar;
        std::size_t before = 0;
        Point2 leaves, reaches;  // of the last leg
        bool is_start = false, is_done = false;
    };

    [[nodiscard]] bool isCorner(std::size_t node) const { return node >= hidden_.size(); }

    std::optional<std::size_t> searchWithin(double limit) {
        limit_ = limit;
        nodes_.assign(first_end_.size() - 1, Node());
        open_ = {};
        for (std::size_t k = 0; k < hidden_.size(); ++k)
            if (starts_[k]) {
                nodes_[k].exposed = 0;
                nodes_[k].is_start = true;
                open_.emplace(0, k);
            }
        while (!open_.empty()) {
            const std::size_t at = open_.top().second;
            open_.pop();
            if (nodes_[at].is_done) continue;
            nodes_[at].is_done = true;
            if (!isCorner(at) && goals_[at]) return at;
            for (std::size_t i = first_end_[at]; i < first_end_[at + 1]; ++i) extendFrom(ends_[i]);
            if (isCorner(at)) continue;
            for (std::size_t i = first_edge_[at]; i < first_edge_[at + 1]; ++i)
                extendFrom(edges_[i]);
        }
        return std::nullopt;
    }

    /// Returns false if a leg between an end and this point is longer than one from beside the end.
    [[nodiscard]] bool mayEnd(const LegEnd& end, Point2 other) const {
        const auto& [at, before, after] = end.corner;
        if (isCorner(end.node)) return floor_.isTangent(end.corner, other);
        const Vec2 leg = other - at;
        const double slack = floor_.tolerance() * length(leg);
        return dot(leg, before - at) <= slack && dot(leg, after - at) <= slack;
    }

    /// Visits the legs from an end to nearest points of edges, and to corners.
    void extendFrom(const LegEnd& from) {
        const Point2 at = from.corner.at;
        const Box2 window = Box2{at, at}.expanded(limit_ - nodes_[from.node].exposed);
        edge_tree_.search(window, [&](std::size_t i) {
            const Point2 to = nearestPoint(edges_[i].line, at);
            if (isShorter(from.node, edges_[i].region, distance(at, to)) && mayEnd(from, to))
                reach(from.node, at, to, edges_[i].region);
        });
        end_tree_.search(window, [&](std::size_t i) {
            const LegEnd& to = ends_[i];
            if (isCorner(to.node) && isShorter(from.node, to.node, distance(at, to.corner.at)) &&
                mayEnd(from, to.corner.at) && mayEnd(to, at))
                reach(from.node, at, to.corner.at, to.node);
        });
    }

    /// Visits the legs that leave an edge at a right angle.
    void extendFrom(const Edge& from) {
        const Vec2 along = from.line.b - from.line.a;
        end_tree_.search(
            bounds(from.line).expanded(limit_ - nodes_[from.region].exposed), [&](std::size_t i) {
                const LegEnd& to = ends_[i];
                const double at = dot(to.corner.at - from.line.a, along) / dot(along, along);
                if (!(at > 0 && at < 1)) return;
                const Point2 foot = from.line.a + at * along;
                if (isShorter(from.region, to.node, distance(foot, to.corner.at)) &&
                    mayEnd(to, foot))
                    reach(from.region, foot, to.corner.at, to.node);
            });
    }

    [[nodiscard]] bool isShorter(std::size_t node, std::size_t next, double leg) const {
        const double exposed = nodes_[node].exposed + leg;
        return next != node && !nodes_[next].is_done && exposed <= limit_ &&
               exposed < nodes_[next].exposed;
    }

    void reach(std::size_t node, Point2 from, Point2 to, std::size_t next) {
        if (!floor_.sees(from, to)) return;
        const double exposed = nodes_[node].exposed + distance(from, to);
        nodes_[next] = {exposed, node, from, to};
        open_.emplace(exposed, next);
    }

    [[nodiscard]] ExposedPath wayTo(std::size_t goal) const {
        ExposedPath way{nodes_[goal].exposed, {}, goal, goal};
        const auto region = [this](std::size_t node) {
            return isCorner(node) ? std::nullopt : std::optional(node);
        };
        for (std::size_t at = goal; !nodes_[at].is_start; at = nodes_[at].before) {
            const Node& node = nodes_[at];
            way.legs.push_back({node.leaves, node.reaches, region(node.before), region(at)});
            way.first = node.before;
        }
        std::reverse(way.legs.begin(), way.legs.end());
        return way;
    }

    const FloorSight& floor_;
    std::span<const Region> hidden_;
    const std::vector<bool>& starts_;
    const std::vector<bool>& goals_;
    std::vector<Edge> edges_;                          // by region
    std::vector<LegEnd> ends_;                         // by node
    std::vector<std::size_t> first_edge_, first_end_;  // of regions, of nodes
    BoxTree edge_tree_, end_tree_;
    double limit_ = 0;
    std::vector<Node> nodes_;
    using Open = std::pair<double, std::size_t>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

}  // namespace

std::optional<ExposedPath> leastExposedPath(const FloorSight& floor, std::span<const Region> hidden,
                                            const std::vector<bool>& starts,
                                            const std::vector<bool>& goals) {
    return ExposureSearch(floor, hidden, starts, goals).run();
}

}  // namespace ispace::goals
