// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "geom/curve.h"

namespace ispace {

/// Lines this near to a viewpoint do not stop its sight, in metres, nor does what continues them: a
/// viewpoint on a wall sees both of its sides. The same as a ray's.
constexpr double kRayEpsilon = 1e-4;

/// What ends sight over an interval of directions: the piece of a line, or an arc at the greatest
/// range.
struct SightEdge {
    static constexpr std::uint32_t kArc = std::numeric_limits<std::uint32_t>::max();
    Point2 from, to;  ///< counter-clockwise as seen from the viewpoint; never the same
                      ///< direction
    /// Index of a line that stops sight there (one of those that do), or kArc. Round bodies are
    /// numbered after the lines; of them `from` and `to` may lie beside the curve, see
    /// VisibilityMap.
    std::uint32_t line = kArc;
};

/// All that a viewpoint sees, up to its greatest range: a star-shaped region. Where one end stops
/// and the next begins farther or nearer, the boundary runs along the line of sight between them.
/// What has no area (a slit of no width, a line along a line of sight) is left out.
struct VisibleRegion {
    Point2 viewpoint;
    double max_range = 0;
    /// Whole turn: the last end stops in the direction in which the first begins, and the viewpoint
    /// is inside. Else the region is a sector with the viewpoint at its tip.
    bool is_whole = true;
    /// Counter-clockwise, without gap or overlap of directions; each spans less than a half turn,
    /// arcs at most a quarter. Empty if nothing is seen.
    std::vector<SightEdge> edges;
};

/// In closed form. O(edges)
double area(const VisibleRegion& region);
/// The boundary, lines of sight included; empty if nothing is seen. O(edges)
Curve outlineOf(const VisibleRegion& region);
/// The part in directions from `first` counter-clockwise over `span`: the whole turn for a span of
/// 360 degrees or more, nothing for one of 0 or less. \pre region.is_whole
VisibleRegion sectorOf(const VisibleRegion& region, Angle first, Angle span);
/// True if p lies in the region; on its boundary, rounding decides. O(edges)
bool holds(const VisibleRegion& region, Point2 p);

/// Finds what can be seen between lines from anywhere in the plane.
///
/// Lines are closed sets without thickness that stop sight; they may cross, overlap, dangle and
/// have no length. Beyond all lines sight is free. Triangular expansion (Bungiu et al., 2014) over
/// a constrained triangulation of all lines: the view passes from triangle to triangle through
/// edges that are no line. What is left and right of a line of sight is decided exactly; ends of
/// sight are rounded once. Where lines cross, or touch but for rounding (some 64 units in the last
/// place of the largest coordinate), they meet in one point.
///
/// Round bodies are closed sets. What they hide begins at the true tangents, in closed form; where
/// one is seen sight ends at the edges of outlineOf(), whose area is the body's. From inside,
/// farther than kRayEpsilon from the curve, nothing is seen; within that sight passes into the
/// body, to its far side. Errors of areas stay below 1e-6 m2 for bodies of up to 1 m radius.
///
/// Memory: some 200 bytes a line. Thread-safe. Coordinates and ranges are cut off at 1e75 m.
class VisibilityMap {
  public:
    /// O(n log n + crossings) \throws FormatError (without a place) for lines that cross by the
    /// million
    explicit VisibilityMap(std::span<const Segment2> lines, std::span<const Ellipse> rounds = {});
    VisibilityMap(VisibilityMap&&) noexcept;
    VisibilityMap& operator=(VisibilityMap&&) noexcept;
    ~VisibilityMap();

    /// Sets `region` to what is seen from a viewpoint up to max_range, in any direction. The memory
    /// of `region` is used again. Every viewpoint has an answer: one on a line (within
    /// kRayEpsilon, then moved onto it), on an end point, on a crossing, outside of everything.
    /// Typically O(what is seen + log n), and O(what is seen) for each round body within range.
    /// \pre max_range >= 0; 0 gives an empty region. +infinity is for where lines enclose the
    ///      viewpoint: free sight then ends at some distance beyond all lines, which
    ///      region.max_range tells
    void query(Point2 viewpoint, double max_range, VisibleRegion& region) const;
    [[nodiscard]] VisibleRegion query(Point2 viewpoint, double max_range) const;

  private:
    struct Data;
    void queryLines(Point2 viewpoint, double max_range, VisibleRegion& region) const;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
