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

using Value = std::function<double(Point2)>;

/// Finds the root between a point with a value of 0 or more and one with a negative value, by
/// regula falsi (Illinois).
Point2 rootBetween(const Value& value, Point2 inside, double at_inside, Point2 outside,
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
    LevelTracer(const Value& value, const Box2& box) : value_(value), box_(box) {
        samples_.reserve(static_cast<std::size_t>(kSide) * kSide);
        for (int row = 0; row < kSide; ++row)
            for (int column = 0; column < kSide; ++column)
                samples_.push_back(value_(place(column, row)));
    }

    std::vector<Curve> run() {
        for (int row = 0; row + 1 < kSide; ++row)
            for (int column = 0; column + 1 < kSide; ++column) crossCell(column, row);
        std::vector<Curve> curves;
        while (!next_.empty()) {
            Curve curve;
            const std::size_t first = next_.begin()->first;
            std::size_t from = first;
            while (true) {
                const auto step = next_.find(from);
                if (step == next_.end()) break;
                const std::size_t to = step->second;
                next_.erase(step);
                follow(roots_.at(from), roots_.at(to), kDeepest, curve);
                from = to;
            }
            std::erase_if(curve, [](const CurveEdge& edge) { return edge.from == edge.to; });
            if (from == first && curve.size() > 1) curves.push_back(std::move(curve));
        }
        return curves;
    }

  private:
    static constexpr int kSide = kLevelSamples;
    static constexpr int kDeepest = 8;

    [[nodiscard]] Point2 place(int column, int row) const {
        return {box_.low.x + box_.width() * column / (kSide - 1),
                box_.low.y + box_.depth() * row / (kSide - 1)};
    }
    [[nodiscard]] double sample(int column, int row) const {
        return samples_[static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column)];
    }
    /// Returns the number of the side of a cell: 0 its lower one, then counter-clockwise. Cells
    /// share their sides.
    static std::size_t sideOf(int column, int row, int side) {
        const bool is_upright = side == 1 || side == 3;
        const int c = column + (side == 1 ? 1 : 0), r = row + (side == 2 ? 1 : 0);
        return 2 * (static_cast<std::size_t>(r) * kSide + static_cast<std::size_t>(c)) +
               (is_upright ? 1 : 0);
    }

    /// Adds the pieces of the boundary in a cell, each with the area on its left: counter-clockwise
    /// around the cell, a piece ends where the border enters the area and begins where it leaves.
    void crossCell(int column, int row) {
        constexpr std::array<std::pair<int, int>, 5> kCorners = {
            {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
        std::array<std::optional<bool>, 4> leaves;  // at each side; empty: not crossed
        int crossed = 0;
        for (std::size_t side = 0; side < 4; ++side) {
            const auto [ax, ay] = kCorners[side];
            const auto [bx, by] = kCorners[side + 1];
            const double a = sample(column + ax, row + ay), b = sample(column + bx, row + by);
            if ((a >= 0) == (b >= 0)) continue;
            leaves[side] = a >= 0;
            ++crossed;
            const std::size_t key = sideOf(column, row, static_cast<int>(side));
            if (roots_.count(key) != 0) continue;
            const Point2 p = place(column + ax, row + ay), q = place(column + bx, row + by);
            roots_.emplace(
                key, a >= 0 ? rootBetween(value_, p, a, q, b) : rootBetween(value_, q, b, p, a));
        }
        if (crossed == 0) return;
        const Point2 low = place(column, row), high = place(column + 1, row + 1);
        const bool joins = crossed == 4 && value_(low + 0.5 * (high - low)) >= 0;
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
        const double at_left = value_(left), at_right = value_(right);
        if (!(at_left >= 0 && at_right < 0)) return std::nullopt;
        return rootBetween(value_, left, at_left, right, at_right);
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

    const Value& value_;
    const Box2& box_;
    std::vector<double> samples_;
    std::map<std::size_t, Point2> roots_;      // by side
    std::map<std::size_t, std::size_t> next_;  // from side to side
};

}  // namespace

std::vector<Curve> levelSet(const std::function<double(Point2)>& value, const Box2& box) {
    if (box.empty()) return {};
    return LevelTracer(value, box).run();
}

}  // namespace ispace
