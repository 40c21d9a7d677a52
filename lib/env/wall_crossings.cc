// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <tuple>

#include "env/environment.h"
#include "env/walls.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

/// Of one element as many times `most` crossings are looked at before they are put in order: one
/// that runs through heaps of others is told well enough by them.
constexpr std::size_t kHeap = 16;

struct Meeting {
    Point2 place;
    bool overlap;
};

bool apart(const Segment2& s, const Segment2& t) {
    return std::max(s.a.x, s.b.x) < std::min(t.a.x, t.b.x) - kWeldDistance ||
           std::max(t.a.x, t.b.x) < std::min(s.a.x, s.b.x) - kWeldDistance ||
           std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) - kWeldDistance ||
           std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y) - kWeldDistance;
}

/// The ends of the stretch where one line lies on the other, if it is longer than the weld.
std::optional<Meeting> overlapOf(const Segment2& s, const Segment2& t) {
    Point2 from = s.a, to = s.a;
    bool any = false;
    const auto take = [&](Point2 p) {
        if (!any) from = p;
        // At most four points on one line: keep the two farthest from each other.
        if (!any || distance(from, p) > distance(from, to)) to = p;
        any = true;
    };
    for (const Point2 p : {s.a, s.b})
        if (distance(p, t) <= kWeldDistance) take(p);
    for (const Point2 p : {t.a, t.b})
        if (distance(p, s) <= kWeldDistance) take(p);
    if (!any || distance(from, to) <= 2 * kWeldDistance) return std::nullopt;
    return Meeting{from + 0.5 * (to - from), true};
}

/// Where two lines run through each other, if they do.
std::optional<Meeting> meetingOf(const Segment2& s, const Segment2& t) {
    if (apart(s, t)) return std::nullopt;
    if (const auto overlap = overlapOf(s, t)) return overlap;
    if (!intersects(s, t)) return std::nullopt;
    // An end on the other line is no crossing, nor one that pokes out on its far side by rounding.
    for (const Point2 p : {s.a, s.b})
        if (distance(p, t) <= kWeldDistance) return std::nullopt;
    for (const Point2 p : {t.a, t.b})
        if (distance(p, s) <= kWeldDistance) return std::nullopt;
    const Vec2 along = s.b - s.a, other = t.b - t.a;
    return Meeting{s.a + cross(t.a - s.a, other) / cross(along, other) * along, false};
}

bool less(const WallCrossing& c, const WallCrossing& d) {
    return std::tuple(c.a, c.b, c.place.x, c.place.y) < std::tuple(d.a, d.b, d.place.x, d.place.y);
}

bool same(const WallCrossing& c, const WallCrossing& d) {
    return c.a == d.a && c.b == d.b && c.place == d.place;
}

/// The crossings of one plan, found line by line.
class CrossingFinder {
  public:
    explicit CrossingFinder(std::span<const Element> elements) : elements_(elements) {
        Diagnostics ignored;  // elements are made of records without findings
        for (std::size_t i = 0; i < elements.size(); ++i) {
            for (const WallLine& wall : wallLinesOf(elements[i].record, ignored))
                plan_.add(wall, i);
        }
    }

    /// Those of the first elements, at most `most`.
    [[nodiscard]] std::vector<WallCrossing> find(std::size_t most) const {
        const SegmentTree tree(plan_.lines);
        std::vector<WallCrossing> found;
        std::vector<std::size_t> later;
        std::size_t sorted = 0;  // crossings of elements before the one of this line
        for (std::size_t i = 0; i < plan_.lines.size(); ++i) {
            if (i > 0 && plan_.owner[i] != plan_.owner[i - 1]) sortFrom(sorted, found);
            if (found.size() >= most && (found.size() == sorted || found.size() / kHeap >= most))
                break;
            later.clear();
            tree.search(plan_.lines[i], kWeldDistance, [&](std::size_t k) {
                if (k > i && mayCross(i, k)) later.push_back(k);
            });
            std::sort(later.begin(), later.end());
            for (const std::size_t k : later) add(i, k, found);
        }
        sortFrom(sorted, found);
        found.resize(std::min(found.size(), most));
        return found;
    }

  private:
    [[nodiscard]] bool areRooms(std::size_t i, std::size_t k) const {
        const auto is_room = [&](std::size_t line) {
            return elements_[plan_.owner[line]].record.keyword() == "ispace";
        };
        return is_room(i) && is_room(k);
    }

    /// False for lines of one element, and for the walls of heaps of equal rooms.
    [[nodiscard]] bool mayCross(std::size_t i, std::size_t k) const {
        return plan_.owner[i] != plan_.owner[k] &&
               !(plan_.lines[i] == plan_.lines[k] && areRooms(i, k));
    }

    void add(std::size_t i, std::size_t k, std::vector<WallCrossing>& found) const {
        const auto meeting = meetingOf(plan_.lines[i], plan_.lines[k]);
        if (!meeting || (meeting->overlap && areRooms(i, k))) return;
        found.push_back({plan_.owner[i], plan_.owner[k], meeting->place, meeting->overlap});
    }

    /// Puts what was found since into order, each crossing once.
    static void sortFrom(std::size_t& sorted, std::vector<WallCrossing>& found) {
        const auto first = found.begin() + static_cast<std::ptrdiff_t>(sorted);
        std::sort(first, found.end(), less);
        found.erase(std::unique(first, found.end(), same), found.end());
        sorted = found.size();
    }

    std::span<const Element> elements_;
    WallPlan plan_;
};

}  // namespace

std::vector<WallCrossing> wallCrossings(std::span<const Element> elements, std::size_t most) {
    return CrossingFinder(elements).find(most);
}

}  // namespace ispace
