// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "env/walls.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Order of the sweep: by x, then by y, as if vertical edges leaned a little to the right.
bool comesBefore(Point2 p, Point2 q) { return std::tie(p.x, p.y) < std::tie(q.x, q.y); }

/// Returns true if each segment has its ends strictly on both sides of the other.
bool crosses(const Segment2& s, const Segment2& t) {
    const auto parts = [](const Segment2& line, const Segment2& other) {
        const Turn a = orientation(line.a, line.b, other.a);
        const Turn b = orientation(line.a, line.b, other.b);
        return a != Turn::Straight && b != Turn::Straight && a != b;
    };
    return parts(s, t) && parts(t, s);
}

Point2 crossingPoint(const Segment2& s, const Segment2& t) {
    const Vec2 along = s.b - s.a, other = t.b - t.a;
    return s.a + cross(t.a - s.a, other) / cross(along, other) * along;
}

/// Sweeps over edges, which stand from below upwards at each position, and compares neighbours
/// alone (Shamos and Hoey, 1976). Until a crossing is reached the order of two edges stays: edges
/// that touch or overlap may do so, and exact predicates order them.
class CrossingSweep {
  public:
    explicit CrossingSweep(const Polygon& polygon) {
        edges_.reserve(polygon.size());
        forEachEdge(polygon, [this](const Segment2& edge) {
            if (edge.a == edge.b) return;
            edges_.push_back(comesBefore(edge.a, edge.b) ? edge : Segment2{edge.b, edge.a});
        });
    }

    std::optional<Point2> find() {
        positions_.assign(edges_.size(), open_.end());
        for (const Event& event : events()) {
            const auto found = event.begins ? begin(event.edge) : end(event.edge);
            if (found) return found;
        }
        return std::nullopt;
    }

  private:
    struct Event {
        Point2 at;
        bool begins;
        std::uint32_t edge;
    };
    struct Below {
        const std::vector<Segment2>* edges;

        bool operator()(std::uint32_t i, std::uint32_t k) const {
            if (i == k) return false;
            const Segment2 &s = (*edges)[i], &t = (*edges)[k];
            const bool is_first = comesBefore(s.a, t.a);  // of the two, s begins first
            const Segment2 &line = is_first ? s : t, &other = is_first ? t : s;
            Turn side = orientation(line.a, line.b, other.a);
            if (side == Turn::Straight) side = orientation(line.a, line.b, other.b);
            if (side == Turn::Straight) return i < k;
            return (side == Turn::Left) == is_first;
        }
    };
    using Open = std::set<std::uint32_t, Below>;

    /// Ends before beginnings at each point, so that edges that meet there are no neighbours.
    [[nodiscard]] std::vector<Event> events() const {
        std::vector<Event> events;
        events.reserve(2 * edges_.size());
        for (std::uint32_t i = 0; i < edges_.size(); ++i) {
            events.push_back({edges_[i].a, true, i});
            events.push_back({edges_[i].b, false, i});
        }
        std::sort(events.begin(), events.end(), [](const Event& e, const Event& f) {
            return std::tie(e.at.x, e.at.y, e.begins, e.edge) <
                   std::tie(f.at.x, f.at.y, f.begins, f.edge);
        });
        return events;
    }

    std::optional<Point2> begin(std::uint32_t edge) {
        const auto at = open_.insert(edge).first;
        positions_[edge] = at;
        const auto above = std::next(at);
        if (at != open_.begin())
            if (const auto found = compare(*std::prev(at), edge)) return found;
        return above == open_.end() ? std::nullopt : compare(edge, *above);
    }

    std::optional<Point2> end(std::uint32_t edge) {
        const auto above = open_.erase(positions_[edge]);
        if (above == open_.begin() || above == open_.end()) return std::nullopt;
        return compare(*std::prev(above), *above);
    }

    [[nodiscard]] std::optional<Point2> compare(std::uint32_t i, std::uint32_t k) const {
        const auto [first, second] = std::minmax(i, k);
        if (!crosses(edges_[first], edges_[second])) return std::nullopt;
        return crossingPoint(edges_[first], edges_[second]);
    }

    std::vector<Segment2> edges_;  // each from its first point to its last in the sweep
    Open open_{Below{&edges_}};    // edges at the position of the sweep, from below
    std::vector<Open::iterator> positions_;
};

}  // namespace

std::optional<Point2> selfCrossing(const Polygon& polygon) { return CrossingSweep(polygon).find(); }

}  // namespace ispace
