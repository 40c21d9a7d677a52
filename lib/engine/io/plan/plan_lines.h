// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of a drawing as paths: welding, joining, simplifying. All functions keep the order of paths
// and their lines in the file, by which messages name them; results depend on input order alone.
//
//     std::vector<PlanPath> walls = normalisedLines(std::move(drawn), kDefaultSnap, work);
//     walls = simplifiedPaths(joinedAtEnds(std::move(walls)), 0.01, work);
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/budget.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

/// Finds segments near a point, however unevenly they are spread. O(n log n) to build. Queries take
/// a unit of work for so many segments that they find: those of crowds find all of them each time.
class NearSegments {
  public:
    static constexpr std::size_t kFoundPerUnit = 64;

    /// \param work of the reader, which outlives this object
    NearSegments(std::span<const Segment2> segments, Budget& work);

    /// Returns ascending indices of segments, among them all those within `reach` of p.
    /// \throws FormatError (without file and line) if the work is used up
    [[nodiscard]] std::vector<std::size_t> near(Point2 p, double reach) const;
    /// Returns the same for the segments within `reach` of the box.
    [[nodiscard]] std::vector<std::size_t> near(const Box2& box, double reach) const;

  private:
    BoxTree tree_;
    Budget& work_;
    mutable std::size_t unpaid_ = 0;  // segments found, less than a unit
};

/// A drawn line of straight pieces, in metres.
struct PlanPath {
    Polygon points;        ///< two or more; a closed path does not repeat its first point
    bool closed = false;   ///< the last point joins the first
    int line = 0;          ///< in the file it was read from; 0: unknown
    double thickness = 0;  ///< of the wall, as drawn; 0: the line is a face, or unknown

    [[nodiscard]] std::size_t pieceCount() const { return points.size() - (closed ? 0 : 1); }
    [[nodiscard]] Segment2 piece(std::size_t i) const {
        return {points[i], points[i + 1 == points.size() ? 0 : i + 1]};
    }
    friend bool operator==(const PlanPath&, const PlanPath&) = default;
};

/// Points of drawings closer than this are merged, in metres, unless ImportOptions::snap says
/// otherwise.
constexpr double kDefaultSnap = 0.005;

/// Rounds metres to whole micrometres, which keeps text short.
double wholeMicrometres(double metres);
inline Point2 wholeMicrometres(Point2 p) { return {wholeMicrometres(p.x), wholeMicrometres(p.y)}; }

Box2 boundsOf(std::span<const Segment2> lines);

/// Points by x, then y, in maps.
struct LexLess {
    bool operator()(Point2 a, Point2 b) const { return lexLess(a, b); }
};

/// Rounds points to whole micrometres and joins near ones: points within `snap` of an earlier one
/// move onto it, then ends of open paths within `snap` of another path onto that. Equal neighbours
/// are merged, and paths without two different points dropped. Below a micrometre `snap` joins only
/// equal points. O(n log n) unless most lines crowd around one point.
std::vector<PlanPath> snapped(std::vector<PlanPath> paths, double snap, Budget& work);

/// Returns the paths, followed by a short one from each loose end to the nearest point of another
/// line within `reach`. Points do not move, and bridges cross no line. O(n log n).
std::vector<PlanPath> bridged(std::vector<PlanPath> paths, double reach);

/// Converts hand-drawn lines to walls: points within 5 mm (or `snap`, if less) become one, loose
/// ends are bridged within `snap`, and repeated pieces dropped.
std::vector<PlanPath> normalisedLines(std::vector<PlanPath> paths, double snap, Budget& work);

/// Returns all pieces of all paths, in order.
std::vector<Segment2> pathPieces(const std::vector<PlanPath>& paths);

/// Returns the paths without the pieces whose `keep` is false (in the order of pathPieces()); one
/// path may become several.
std::vector<PlanPath> withPieces(std::vector<PlanPath> paths, const std::vector<bool>& keep);

/// Removes pieces that repeat an earlier one, in either direction.
std::vector<PlanPath> withoutRepeats(std::vector<PlanPath> paths);

/// Joins open paths of one thickness where exactly two ends meet, so that a room drawn line by line
/// is one closed path, at the index and with the `line` of its first part. O(n log n).
std::vector<PlanPath> joinedAtEnds(std::vector<PlanPath> paths);

/// Joins open paths as above, and drops corners where a path runs straight on and no other has
/// a corner, in the boxes of which `places` are diagonals. \return std::nullopt if there are none.
/// O(n log n)
std::optional<std::vector<PlanPath>> withoutJoints(const std::vector<PlanPath>& paths,
                                                   std::span<const Segment2> places, Budget& work);

/// Simplifies paths by at most `tolerance` metres, between joints by Douglas and Peucker. Joints
/// stay: ends of open paths, points that paths share, both ends of a piece that another one meets,
/// and of pieces in `fixed`. No new crossings appear, no path changes sides, and closed paths keep
/// three corners. \param fixed indices of pieces as in pathPieces
std::vector<PlanPath> simplifiedPaths(const std::vector<PlanPath>& paths, double tolerance,
                                      Budget& work, std::span<const std::size_t> fixed = {});

}  // namespace ispace
