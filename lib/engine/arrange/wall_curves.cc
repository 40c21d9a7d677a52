// SPDX-License-Identifier: GPL-3.0-or-later
// Follows walls: the boundary of the floor, and sheets that stand in it, as closed curves with the
// floor on their left.
//
// Lines that share ends form a planar graph, of which each line is walked in both directions. At
// the end of a line the walk turns to the next line clockwise, so it goes around one face (as in a
// doubly connected edge list; M. de Berg, O. Cheong, M. van Kreveld, M. Overmars, Computational
// geometry, 2008, section 2.2). Directions are compared by exact orientation, without angles.
// Invariant: either all steps of a curve have the floor on their left, or a sheet crosses a
// boundary, and then all sheets become curves by themselves.
#include "arrange/dense_sites.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "env/level.h"
#include "env/point_location.h"
#include "env/walls.h"
#include "geom/planar_map.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

Slice wallSlice(const Environment& environment, double height) {
    const auto level = environment.level(height);
    const Slice& slice = level->slice();
    const auto is_wall = [&](std::size_t owner) {
        const Record& record = environment.elements()[owner].record;
        return isWall(record) || record.keyword() == "door" || record.keyword() == "window";
    };
    Slice walls;
    for (std::size_t i = 0; i < slice.sheets.size(); ++i)
        if (is_wall(slice.sheet_owners[i])) walls.sheets.push_back(slice.sheets[i]);
    for (std::size_t i = 0; i < slice.solids.size(); ++i)
        if (is_wall(slice.solid_owners[i])) walls.solids.push_back(slice.solids[i]);
    return walls;
}

namespace {

/// Lines, each walked in both directions. At the end of a line the walk takes the next line
/// clockwise, so that the same face stays on the left.
class Walk {
  public:
    /// An edge with the floor on its left.
    void addEdge(const Segment2& line) { add(line, false); }
    /// A line with the floor on both sides.
    void addSheet(const Segment2& line) { add(line, true); }

    /// Builds the curves with the floor on the left of every step; returns false if a curve has it
    /// on the left of some steps only.
    [[nodiscard]] bool trace(std::vector<Polygon>& curves) {
        sortByDirection();
        std::vector<char> is_done(steps_.size());
        for (std::size_t begin = 0; begin < steps_.size(); ++begin) {
            if (is_done[begin] != 0) continue;
            Polygon curve;
            std::size_t along_floor = 0;
            for (std::size_t at = begin; is_done[at] == 0; at = next(at)) {
                is_done[at] = 1;
                curve.push_back(steps_[at].from);
                along_floor += steps_[at].has_floor ? 1 : 0;
            }
            if (along_floor == 0) continue;
            if (along_floor < curve.size()) return false;
            curves.push_back(std::move(curve));
        }
        return true;
    }

  private:
    struct Step {
        Point2 from, to;
        std::size_t line = 0;
        bool is_back = false;    // from the end of the line to its beginning
        bool has_floor = false;  // on the left
        std::size_t around = 0;  // its index in order_
    };

    void add(const Segment2& line, bool is_sheet) {
        const std::size_t number = steps_.size() / 2;
        steps_.push_back({line.a, line.b, number, false, true});
        steps_.push_back({line.b, line.a, number, true, is_sheet});
    }

    /// Sorts by start point, then counter-clockwise from +x.
    [[nodiscard]] static bool isBefore(const Step& a, const Step& b) {
        if (a.from != b.from) return lexLess(a.from, b.from);
        const auto is_low = [](const Step& step) {
            const Point2 from = step.from, to = step.to;
            return to.y < from.y || (to.y == from.y && to.x < from.x);
        };
        if (is_low(a) != is_low(b)) return is_low(b);
        const Turn turn = orientation(a.from, a.to, b.to);
        if (turn != Turn::Straight) return turn == Turn::Left;
        return std::pair(a.line, a.is_back) < std::pair(b.line, b.is_back);
    }

    void sortByDirection() {
        order_.resize(steps_.size());
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::sort(order_.begin(), order_.end(),
                  [this](std::size_t a, std::size_t b) { return isBefore(steps_[a], steps_[b]); });
        for (std::size_t i = 0; i < order_.size(); ++i) steps_[order_[i]].around = i;
    }

    /// Returns the step that follows: from the way back, the next one clockwise.
    [[nodiscard]] std::size_t next(std::size_t at) const {
        const std::size_t back = at ^ 1U, around = steps_[back].around;
        const Point2 vertex = steps_[back].from;
        if (around > 0 && steps_[order_[around - 1]].from == vertex) return order_[around - 1];
        std::size_t last = around;
        while (last + 1 < order_.size() && steps_[order_[last + 1]].from == vertex) ++last;
        return order_[last];
    }

    std::vector<Step> steps_;  // steps 2i and 2i + 1 belong to line i
    std::vector<std::size_t> order_;
};

/// Finds the sheets that stand in the floor, not on its boundary, by their midpoints.
std::vector<Segment2> sheetsWithin(const std::vector<Region>& floor,
                                   std::span<const Segment2> edges,
                                   std::span<const Segment2> sheets) {
    const RegionIndex index(floor);
    const SegmentTree boundary(edges);
    std::vector<Segment2> within;
    for (const Segment2& sheet : sheets) {
        const Point2 middle = sheet.a + 0.5 * (sheet.b - sheet.a);
        bool is_free = index.locate(middle) == Side::Inside;
        if (!is_free) continue;
        boundary.search({middle, middle}, kWeldDistance, [&](std::size_t i) {
            is_free = is_free && distance(middle, edges[i]) > kWeldDistance;
        });
        if (is_free) within.push_back(sheet);
    }
    return within;
}

/// Removes duplicate lines, in either direction.
void dropDoubles(std::vector<Segment2>& lines) {
    const auto key = [](const Segment2& line) {
        const bool is_turned = lexLess(line.b, line.a);
        const Point2 a = is_turned ? line.b : line.a, b = is_turned ? line.a : line.b;
        return std::tuple(a.x, a.y, b.x, b.y);
    };
    std::sort(lines.begin(), lines.end(),
              [&](const Segment2& a, const Segment2& b) { return key(a) < key(b); });
    lines.erase(std::unique(lines.begin(), lines.end(),
                            [&](const Segment2& a, const Segment2& b) { return key(a) == key(b); }),
                lines.end());
}

}  // namespace

std::vector<Polygon> wallCurves(const std::vector<Region>& floor,
                                std::span<const Segment2> sheets) {
    std::vector<Polygon> boundaries = curvesOf(floor);
    if (sheets.empty()) return boundaries;
    std::vector<Segment2> lines;
    for (const Polygon& curve : boundaries)
        forEachEdge(curve, [&lines](const Segment2& edge) { lines.push_back(edge); });
    std::vector<Segment2> within = sheetsWithin(floor, lines, sheets);
    if (within.empty()) return boundaries;

    const std::size_t edges = lines.size();
    lines.insert(lines.end(), within.begin(), within.end());
    const WeldedLines welded = weld(lines);
    Walk walk;
    within.clear();
    for (std::size_t i = 0; i < welded.pieces.size(); ++i) {
        if (welded.source[i] < edges)
            walk.addEdge(welded.pieces[i]);
        else
            within.push_back(welded.pieces[i]);
    }
    dropDoubles(within);
    for (const Segment2& sheet : within) walk.addSheet(sheet);
    std::vector<Polygon> curves;
    if (walk.trace(curves)) return curves;
    // Sheets that cross a boundary become separate curves.
    for (const Segment2& sheet : within) boundaries.push_back({sheet.a, sheet.b});
    return boundaries;
}

namespace {

/// Vertices of a closed curve, by numbers that go on beyond its end.
class Around {
  public:
    explicit Around(const Polygon& curve) : curve_(curve) {}

    [[nodiscard]] Point2 at(std::size_t i) const { return curve_[i % curve_.size()]; }
    /// Returns true if all vertices between the two lie near the line that joins them, and in
    /// order.
    [[nodiscard]] bool isStraight(std::size_t from, std::size_t to) const {
        const Segment2 line{at(from), at(to)};
        const Vec2 along = line.b - line.a;
        for (std::size_t i = from; i < to; ++i) {
            if (i > from && distance(at(i), line) > kWeldDistance) return false;
            if (!(dot(at(i + 1) - at(i), along) > 0)) return false;
        }
        return true;
    }

  private:
    const Polygon& curve_;
};

}  // namespace

Polygon wallCorners(const Polygon& curve) {
    Polygon distinct = curve;
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    while (distinct.size() > 1 && distinct.front() == distinct.back()) distinct.pop_back();
    const std::size_t n = distinct.size();
    if (n < 3) return distinct;

    const Around around(distinct);
    std::size_t first = 0;
    while (first + 1 < n && around.isStraight(first + n - 1, first + n + 1)) ++first;
    std::size_t last = first;
    Polygon corners{around.at(first)};
    for (std::size_t i = first + 1; i < first + n; ++i) {
        if (around.isStraight(last, i + 1)) continue;
        corners.push_back(around.at(i));
        last = i;
    }
    return corners;
}

}  // namespace ispace
