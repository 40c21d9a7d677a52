// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <tuple>

#include "env/environment.h"
#include "env/walls.h"
#include "geom/predicates.h"
#include "geom/segment_grid.h"

namespace ispace {

namespace {

/// Pairs of lines that are looked at, per line and besides: heaps of walls in one place are told
/// well enough by the first of them.
constexpr std::size_t kPairsPerLine = 256, kPairsAnyway = 1U << 22;
/// How often one crossing may be found, in cells that the lines share.
constexpr std::size_t kFoundTwice = 16;

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

}  // namespace

std::vector<WallCrossing> wallCrossings(std::span<const Element> elements, std::size_t most) {
    std::vector<Segment2> lines;
    std::vector<std::size_t> owner;
    Diagnostics ignored;  // elements are made of records without findings
    for (std::size_t i = 0; i < elements.size(); ++i) {
        for (const WallLine& wall : wallLinesOf(elements[i].record, ignored)) {
            lines.push_back(wall.line);
            owner.push_back(i);
        }
    }
    const auto is_room = [&](std::size_t i) { return elements[i].record.keyword() == "ispace"; };
    std::vector<WallCrossing> found;
    std::size_t pairs_left = kPairsAnyway + kPairsPerLine * lines.size();
    const auto enough = [&] { return pairs_left == 0 || found.size() >= kFoundTwice * most; };
    SegmentGrid(lines, kWeldDistance).forEachCell([&](std::span<const std::uint32_t> cell) {
        for (std::size_t i = 0; i < cell.size(); ++i) {
            for (std::size_t k = i + 1; k < cell.size() && !enough(); ++k, --pairs_left) {
                const std::size_t a = owner[cell[i]], b = owner[cell[k]];
                if (a == b) continue;
                const auto meeting = meetingOf(lines[cell[i]], lines[cell[k]]);
                if (!meeting || (meeting->overlap && is_room(a) && is_room(b))) continue;
                found.push_back({a, b, meeting->place, meeting->overlap});
            }
        }
    });
    std::sort(found.begin(), found.end(), less);
    found.erase(std::unique(found.begin(), found.end(), same), found.end());
    found.resize(std::min(found.size(), most));
    return found;
}

}  // namespace ispace
