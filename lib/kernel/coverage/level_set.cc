// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/level_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "coverage/shadow_footprint.h"

namespace ispace {

namespace {

/// Finds the root between a point with a value of 0 or more and one with a negative value, by
/// regula falsi (Illinois).
template <typename Function>
Point2 rootBetween(const Function& value, Point2 inside, double at_inside, Point2 outside,
                   double at_outside) {
    constexpr int kSteps = 60;
    constexpr double kNear = 1e-10;  // metres
    bool was_inside = false, was_outside = false;
    for (int i = 0; i < kSteps && distance(inside, outside) > kNear; ++i) {
        const double share = at_inside / (at_inside - at_outside);
        const Point2 middle = inside + share * (outside - inside);
        const double here = value(middle);
        if (here == 0) return middle;
        if (here > 0) {
            inside = middle;
            at_inside = here;
            if (was_inside) at_outside /= 2;
            was_inside = true;
            was_outside = false;
        } else {
            outside = middle;
            at_outside = here;
            if (was_outside) at_inside /= 2;
            was_outside = true;
            was_inside = false;
        }
    }
    return inside + 0.5 * (outside - inside);
}

/// Traces the boundary through the cells of a grid of samples ("marching squares").
class LevelTracer {
  public:
    LevelTracer(const LevelFunction& function, const Box2& box, int side)
        : function_(function), box_(box), side_(side) {
        constexpr double kShare = 0.25;  // of a cell
        const Vec2 inset{kShare * box.width() / (side - 1), kShare * box.depth() / (side - 1)};
        inner_ = {box.low + inset, box.high - inset};
    }

    std::vector<Curve> run() {
        crossBlock(0, 0, side_ - 1, side_ - 1);
        std::vector<Curve> curves;
        while (!next_.empty()) {
            Curve curve;
            const std::size_t first = next_.begin()->first;
            std::size_t from = first;
            std::vector<Point2> roots = {roots_.at(first)};
            while (true) {
                const auto step = next_.find(from);
                if (step == next_.end()) break;
                const std::size_t to = step->second;
                next_.erase(step);
                roots.push_back(roots_.at(to));
                from = to;
            }
            for (std::size_t i = 0; i + 1 < roots.size(); i += kJoined)
                join(roots, i, std::min(i + kJoined, roots.size() - 1), curve);
            std::erase_if(curve, [](const CurveEdge& edge) { return edge.from == edge.to; });
            if (from == first && curve.size() > 1) curves.push_back(std::move(curve));
        }
        return curves;
    }

  private:
    static constexpr int kMaxDepth = 8;
    static constexpr std::size_t kJoined = 16;  // pieces in an arc at most

    [[nodiscard]] Point2 place(int column, int row) const {
        return levelPlace(box_, side_, column, row);
    }
    [[nodiscard]] double sample(int column, int row) const {
        return std::min(function_.sample(column, row), within(place(column, row)));
    }
    /// Returns the distance from the border, negative outside.
    [[nodiscard]] double within(Point2 p) const {
        return std::min(std::min(p.x - inner_.low.x, inner_.high.x - p.x),
                        std::min(p.y - inner_.low.y, inner_.high.y - p.y));
    }
    [[nodiscard]] double valueAt(Point2 p) const { return std::min(function_.value(p), within(p)); }
    [[nodiscard]] Point2 root(Point2 inside, double at_inside, Point2 outside,
                              double at_outside) const {
        return rootBetween([this](Point2 p) { return valueAt(p); }, inside, at_inside, outside,
                           at_outside);
    }
    /// Returns the number of the side of a cell: 0 its lower one, then counter-clockwise. Cells
    /// share their sides.
    [[nodiscard]] std::size_t sideOf(int column, int row, int side) const {
        const bool is_upright = side == 1 || side == 3;
        const int c = column + (side == 1 ? 1 : 0), r = row + (side == 2 ? 1 : 0);
        return 2 * (static_cast<std::size_t>(r) * static_cast<std::size_t>(side_) +
                    static_cast<std::size_t>(c)) +
               (is_upright ? 1 : 0);
    }

    /// Adds the pieces of the boundary in the cells from (column, row) up to (last, top).
    void crossBlock(int column, int row, int last, int top) {
        constexpr int kFew = 2;  // cells whose samples take less time than bounds
        if (last - column > kFew || top - row > kFew) {
            const Box2 block{place(column, row), place(last, top)};
            const auto [low, high] = function_.bounds(block);
            // The distance from the border is least at a corner.
            const bool is_inside = low >= 0 && std::min(within(block.low), within(block.high)) >= 0;
            if (is_inside || high < 0) return;
            const int middle = (column + last) / 2, center = (row + top) / 2;
            crossBlock(column, row, middle, center);
            crossBlock(middle, row, last, center);
            crossBlock(column, center, middle, top);
            crossBlock(middle, center, last, top);
            return;
        }
        for (int r = row; r < top; ++r)
            for (int c = column; c < last; ++c) crossCell(c, r);
    }

    /// Adds the pieces of the boundary in a cell, each with the area on its left: counter-clockwise
    /// around the cell, a piece ends where the border enters the area and begins where it leaves.
    void crossCell(int column, int row) {
        constexpr std::array<std::pair<int, int>, 5> kCorners = {
            {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
        std::array<double, 5> values{};
        int inside = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto [right, up] = kCorners[i];
            values[i] = sample(column + right, row + up);
            if (values[i] >= 0) ++inside;
        }
        if (inside == 0 || inside == 4) return;
        values[4] = values[0];
        std::array<std::optional<bool>, 4> leaves;  // at each side; empty: not crossed
        int crossed = 0;
        for (std::size_t side = 0; side < 4; ++side) {
            const auto [ax, ay] = kCorners[side];
            const auto [bx, by] = kCorners[side + 1];
            const double a = values[side], b = values[side + 1];
            if ((a >= 0) == (b >= 0)) continue;
            leaves[side] = a >= 0;
            ++crossed;
            const std::size_t key = sideOf(column, row, static_cast<int>(side));
            if (roots_.count(key) != 0) continue;
            const Point2 p = place(column + ax, row + ay), q = place(column + bx, row + by);
            roots_.emplace(key, a >= 0 ? root(p, a, q, b) : root(q, b, p, a));
        }
        const Point2 low = place(column, row), high = place(column + 1, row + 1);
        const bool joins = crossed == 4 && valueAt(low + 0.5 * (high - low)) >= 0;
        for (int side = 0; side < 4; ++side) {
            if (leaves[static_cast<std::size_t>(side)] != true) continue;
            // The last entry before it, or, if opposite corners are joined through the middle, the
            // next one.
            const int turn = joins ? 1 : 3;
            int to = (side + turn) % 4;
            while (leaves[static_cast<std::size_t>(to)] != false) to = (to + turn) % 4;
            next_[sideOf(column, row, side)] = sideOf(column, row, to);
        }
    }

    /// Returns the point of the boundary nearest to the middle of a chord, on the normal there;
    /// empty without a change of sign.
    [[nodiscard]] std::optional<Point2> bulge(Point2 a, Point2 b) const {
        const Vec2 way = b - a, normal = 0.5 * perpendicular(way);
        const Point2 middle = a + 0.5 * way, left = middle + normal, right = middle - normal;
        const double at_left = valueAt(left), at_right = valueAt(right);
        if (!(at_left >= 0 && at_right < 0)) return std::nullopt;
        return root(left, at_left, right, at_right);
    }

    /// Appends arcs from a to b, points of the boundary.
    void follow(Point2 a, Point2 b, int depth, Curve& curve) const {
        const auto middle = bulge(a, b);
        if (!middle) {
            curve.push_back({a, b});
            return;
        }
        const CurveEdge edge = arcThrough(a, *middle, b);
        const auto first = bulge(a, *middle), second = bulge(*middle, b);
        const bool is_near = first && second &&
                             std::max(distanceFrom(edge, *middle, *first),
                                      distanceFrom(edge, *middle, *second)) <= kConicError;
        if (is_near || depth == 0 || distance(a, b) < kConicError) {
            curve.push_back(edge);
            return;
        }
        follow(a, *middle, depth - 1, curve);
        follow(*middle, b, depth - 1, curve);
    }

    /// Appends arcs through points of the boundary, from roots[first] to roots[last].
    void join(const std::vector<Point2>& roots, std::size_t first, std::size_t last,
              Curve& curve) const {
        constexpr std::size_t kEnough = 4;  // pieces, so that points lie between those of the arc
        if (last - first == 1) return follow(roots[first], roots[last], kMaxDepth, curve);
        const std::size_t middle = first + (last - first) / 2;
        if (last - first >= kEnough) {
            const CurveEdge edge = arcThrough(roots[first], roots[middle], roots[last]);
            bool is_near = true;
            for (std::size_t i = first + 1; i < last; ++i)
                is_near = is_near && distanceFrom(edge, roots[middle], roots[i]) <= kConicError;
            if (is_near) {
                curve.push_back(edge);
                return;
            }
        }
        join(roots, first, middle, curve);
        join(roots, middle, last, curve);
    }

    const LevelFunction& function_;
    const Box2& box_;
    int side_;
    Box2 inner_;                               ///< where the area may lie
    std::map<std::size_t, Point2> roots_;      // by side
    std::map<std::size_t, std::size_t> next_;  // from side to side
};

}  // namespace

Point2 levelPlace(const Box2& box, int side, int column, int row) {
    return {box.low.x + box.width() * column / (side - 1),
            box.low.y + box.depth() * row / (side - 1)};
}

std::vector<Curve> levelSet(const LevelFunction& function, const Box2& box, int side) {
    if (box.empty()) return {};
    return LevelTracer(function, box, side).run();
}

std::vector<Curve> levelSet(const std::function<double(Point2)>& value, const Box2& box, int side) {
    const auto sample = [&](int column, int row) {
        return value(levelPlace(box, side, column, row));
    };
    return levelSet({value, sample,
                     [](const Box2&) {
                         return Interval{-HUGE_VAL, HUGE_VAL};
                     }},
                    box, side);
}

}  // namespace ispace
