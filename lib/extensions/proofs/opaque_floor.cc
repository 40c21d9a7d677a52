// SPDX-License-Identifier: GPL-3.0-or-later
// Compares sight in a scene with sight within the outlines of its floor. Proofs are about the
// outlines alone, so each edge of the floor must be a wall, and no sheet may stand within it.
#include "extensions/proofs/opaque_floor.h"

#include <algorithm>
#include <utility>

#include "base/number.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"
#include "geom/tolerance.h"

namespace ispace::proofs {

namespace {

using Interval = std::pair<double, double>;  // along a line, from its beginning, metres

/// Finds lines that coincide with or cross another.
class LineIndex {
  public:
    explicit LineIndex(std::vector<Segment2> lines)
        : lines_(std::move(lines)), grid_(lines_, kCornerTolerance) {}

    /// Calls visit(line) for each line that may meet the segment, once.
    template <typename Visit>
    void along(const Segment2& segment, Visit visit) const {
        std::vector<std::uint32_t> found;
        grid_.searchAlong(segment, [&](std::span<const std::uint32_t> indices) {
            found.insert(found.end(), indices.begin(), indices.end());
        });
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        for (const std::uint32_t index : found) visit(lines_[index]);
    }

  private:
    std::vector<Segment2> lines_;
    SegmentGrid grid_;
};

/// A line with a direction of unit length.
struct EdgeAxis {
    explicit EdgeAxis(const Segment2& line)
        : from(line.a), size(distance(line.a, line.b)), way((1 / size) * (line.b - line.a)) {}
    [[nodiscard]] double along(Point2 p) const { return dot(way, p - from); }
    [[nodiscard]] double beside(Point2 p) const { return cross(way, p - from); }
    [[nodiscard]] Point2 at(double reach) const { return from + reach * way; }

    Point2 from;
    double size;
    Vec2 way;
};

/// Returns the parts of an edge that no line covers.
std::vector<Interval> openParts(const Segment2& edge, const LineIndex& walls) {
    const EdgeAxis axis(edge);
    std::vector<Interval> covered;
    walls.along(edge, [&](const Segment2& wall) {
        if (std::abs(axis.beside(wall.a)) > kCornerTolerance ||
            std::abs(axis.beside(wall.b)) > kCornerTolerance)
            return;
        covered.push_back(std::minmax({axis.along(wall.a), axis.along(wall.b)}));
    });
    covered.emplace_back(axis.size, axis.size);
    std::sort(covered.begin(), covered.end());
    std::vector<Interval> open;
    double reached = 0;
    for (const auto& [begin, end] : covered) {
        const double until = std::min(begin, axis.size);
        if (until - reached > 2 * kCornerTolerance) open.emplace_back(reached, until);
        reached = std::max(reached, end);
    }
    return open;
}

/// Returns true if the point lies inside the floor, off its edges.
bool isWithin(Point2 p, const std::vector<Region>& floor) {
    return std::any_of(floor.begin(), floor.end(), [p](const Region& region) {
        if (region.locate(p) != Side::Inside) return false;
        bool is_clear = true;
        region.forEachEdge([&](const Segment2& edge) {
            is_clear = is_clear && distance(p, edge) > kCornerTolerance;
        });
        return is_clear;
    });
}

/// Returns true if some part of the line, between edges of the floor, lies inside.
bool runsWithin(const Segment2& line, const std::vector<Region>& floor, const LineIndex& edges) {
    const EdgeAxis axis(line);
    std::vector<double> cuts = {0, axis.size};
    edges.along(line, [&](const Segment2& edge) {
        const double a = axis.beside(edge.a), b = axis.beside(edge.b);
        const double from = axis.along(edge.a), to = axis.along(edge.b);
        if (std::abs(a) <= kCornerTolerance) cuts.push_back(from);
        if (std::abs(b) <= kCornerTolerance) cuts.push_back(to);
        if ((a < 0) != (b < 0)) cuts.push_back(from + a / (a - b) * (to - from));
    });
    for (double& cut : cuts) cut = std::clamp(cut, 0.0, axis.size);
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 1; i < cuts.size(); ++i)
        if (cuts[i] - cuts[i - 1] > 2 * kCornerTolerance &&
            isWithin(axis.at((cuts[i - 1] + cuts[i]) / 2), floor))
            return true;
    return false;
}

}  // namespace

std::string whyNotOpaque(const Level& level, const std::vector<Region>& floor,
                         const std::vector<Element>& elements) {
    const Slice& slice = level.slice();
    if (!slice.rounds.empty())
        return "round bodies stand at the height of the lasers (" +
               elements[slice.solid_owners[slice.rounds.front().solid]].id + ")";
    std::vector<Segment2> edges;
    for (const Region& region : floor)
        region.forEachEdge([&](const Segment2& edge) {
            if (distance(edge.a, edge.b) > kCornerTolerance) edges.push_back(edge);
        });
    const LineIndex bounds(edges);
    for (const Segment2& sheet : slice.sheets)
        if (distance(sheet.a, sheet.b) > kCornerTolerance && runsWithin(sheet, floor, bounds))
            return "a wall without thickness stands in the room, with floor on both sides";
    const LineIndex walls(slice.lines());
    std::size_t open = 0;
    for (const Segment2& edge : edges) {
        const std::vector<Interval> parts = openParts(edge, walls);
        open += parts.size();
        if (open < 2 || parts.empty()) continue;
        const Point2 at = EdgeAxis(edge).at((parts.back().first + parts.back().second) / 2);
        return "lasers see through the edge of the floor at " + formatFixed(at.x, 2) + ',' +
               formatFixed(at.y, 2) + ", as through a window or over a low wall";
    }
    return "";
}

}  // namespace ispace::proofs
