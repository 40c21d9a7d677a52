// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

/// Finds segments near a place, however unevenly they are spread: one line far out does not make
/// the search slow for the others. O(n log n) to build.
class NearSegments {
  public:
    explicit NearSegments(std::span<const Segment2> segments);

    /// Ascending indices of segments, among them all those within `reach` of p.
    [[nodiscard]] std::vector<std::size_t> near(Point2 p, double reach) const;
    /// The same for all those within `reach` of the box.
    [[nodiscard]] std::vector<std::size_t> near(const Box2& box, double reach) const;

  private:
    BoxTree tree_;
};

/// A drawn line of straight pieces, in metres.
struct PlanPath {
    Polygon points;       ///< two or more; a closed path does not repeat its first point
    bool closed = false;  ///< the last point joins the first
    int line = 0;         ///< in the file it was read from; 0: unknown

    [[nodiscard]] std::size_t pieceCount() const { return points.size() - (closed ? 0 : 1); }
    [[nodiscard]] Segment2 piece(std::size_t i) const {
        return {points[i], points[i + 1 == points.size() ? 0 : i + 1]};
    }
    friend bool operator==(const PlanPath&, const PlanPath&) = default;
};

/// What drawings of lines are joined by, in metres, unless ImportOptions::snap says otherwise.
constexpr double kDefaultSnap = 0.005;

/// Metres on whole micrometres, which keeps the text short and moves nothing visibly.
double wholeMicrometres(double metres);
inline Point2 wholeMicrometres(Point2 p) { return {wholeMicrometres(p.x), wholeMicrometres(p.y)}; }

Box2 boundsOf(std::span<const Segment2> lines);

/// Points by x, then y, in maps.
struct LexLess {
    bool operator()(Point2 a, Point2 b) const { return lexLess(a, b); }
};

/// Puts points on whole micrometres and joins what was meant to meet: points within `snap` of an
/// earlier one move onto it, then ends of open paths within `snap` of another path onto that.
/// Points that fall together are one; paths without two different points are dropped. With less
/// than a micrometre only equal points are one. O(n log n) unless most lines lie in one place.
std::vector<PlanPath> snapped(const std::vector<PlanPath>& paths, double snap);

/// The paths, and behind them a short one from each loose end of a line to the nearest point of
/// another within `reach`: nothing moves, and nothing new crosses. O(n log n).
std::vector<PlanPath> bridged(std::vector<PlanPath> paths, double reach);

/// Lines as people draw them, ready to be walls: points within 5 mm (or `snap`, if that is less)
/// are one, loose ends are bridged within `snap`, and nothing is there twice.
std::vector<PlanPath> normalisedLines(const std::vector<PlanPath>& paths, double snap);

/// All pieces of all paths, in order.
std::vector<Segment2> pathPieces(const std::vector<PlanPath>& paths);

/// The paths less the pieces whose `keep` is false, in the order of pathPieces: what is left of a
/// path may be several.
std::vector<PlanPath> withPieces(const std::vector<PlanPath>& paths, const std::vector<bool>& keep);

/// Without pieces that an earlier one repeats, in either direction.
std::vector<PlanPath> withoutRepeats(const std::vector<PlanPath>& paths);

/// Open paths made one where exactly two of their ends meet, so that a room drawn line by line is
/// one closed path; it stands where its first part stood, and has that one's `line`. O(n log n).
std::vector<PlanPath> joinedAtEnds(const std::vector<PlanPath>& paths);

/// The paths with fewer points, and moved by no more than `tolerance` metres: between
/// joints by Douglas and Peucker. Joints stay: ends of open paths, points that several paths share,
/// both ends of a piece that another one meets, and those of the pieces in `fixed`. No path crosses
/// another, or itself, that did not before, and none changes sides; a closed path keeps three
/// corners. \param fixed indices of pieces as in pathPieces
std::vector<PlanPath> simplifiedPaths(const std::vector<PlanPath>& paths, double tolerance,
                                      std::span<const std::size_t> fixed = {});

}  // namespace ispace
