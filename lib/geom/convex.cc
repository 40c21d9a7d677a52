// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/convex.h"

#include <vector>

namespace ispace {

namespace {

/// A direction that turned by more than this (the cosine) is not walked to: on the far side of a
/// polygon rounding could end the walk at once.
constexpr double kTurned = 0.7;

/// The part of a convex polygon that is left after cuts along lines that go once round.
///
/// Its corners are a ring of links. A cut walks from the last one to the corner that lies furthest
/// behind the line, and takes out the corners about it: each is taken out once.
class Remainder {
  public:
    explicit Remainder(const Polygon& polygon) {
        const std::size_t n = polygon.size();
        links_.reserve(2 * n);
        for (std::size_t i = 0; i < n; ++i)
            links_.push_back({polygon[i], i == 0 ? n - 1 : i - 1, i + 1 == n ? 0 : i + 1});
        count_ = n;
    }

    /// Keeps what is on the line or to its left.
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
