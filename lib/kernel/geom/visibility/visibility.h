// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/geom/visibility: the regions that points see, and the rays that bound them.
//
//     const VisibilityMap map(walls);                          // once for a room
//     VisibleRegion region;
//     map.query({2, 1}, 8, region);                            // all around, up to 8 m
//     const double seen = area(sectorOf(region, Angle::degrees(-45), Angle::degrees(90)));
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "geom/curve.h"

namespace ispace {

/// Lines within this distance of a viewpoint, in metres, do not block its view, nor do lines that
/// continue them: a viewpoint on a wall sees both sides. Rays use the same value.
constexpr double kRayEpsilon = 1e-4;

/// An edge of a visibility polygon: a piece of a line, or an arc at the maximum range.
struct VisibilityEdge {
    static constexpr std::uint32_t kArc = std::numeric_limits<std::uint32_t>::max();
    Point2 from, to;  ///< counter-clockwise seen from the viewpoint, in different directions
    /// Index of a line that blocks the view there, or kArc. Round bodies are numbered after the
    /// lines; their `from` and `to` may lie off the curve, see VisibilityMap.
    std::uint32_t line = kArc;
};

/// The visibility polygon of a viewpoint, up to a maximum range: a star-shaped region. Between
/// consecutive edges at different ranges the boundary runs along the line of sight. Parts without
/// area (a slit of no width, a line seen end-on) are removed.
struct VisibleRegion {
    Point2 viewpoint;
    double max_range = 0;
    /// Whole turn: the last edge ends in the direction in which the first begins, and the viewpoint
    /// is inside. Otherwise the region is a sector with the viewpoint at its apex.
    bool is_whole = true;
    /// Counter-clockwise, without gaps or overlaps in direction; each spans less than a half turn,
    /// arcs at most a quarter. Empty if the viewpoint sees no area.
    std::vector<VisibilityEdge> edges;
};

/// Area of the region, m2, in closed form: triangles and sectors of the circle. O(edges)
double area(const VisibleRegion& region);
/// Builds the boundary, including lines of sight; empty for an empty region. O(edges)
Curve outlineOf(const VisibleRegion& region);
/// Clips the region to directions from `first` counter-clockwise over `span`: the whole turn for a
/// span of 360 degrees or more, an empty region for 0 or less. \pre region.is_whole
VisibleRegion sectorOf(const VisibleRegion& region, Angle first, Angle span);
/// True if p lies in the region; on the boundary rounding decides. O(edges)
bool holds(const VisibleRegion& region, Point2 p);

/// Answers visibility queries among lines, from anywhere in the plane.
///
/// Lines are closed, infinitely thin and block the view; they may cross, overlap, dangle and have
/// zero length. Beyond all lines the view is free. Triangular expansion (F. Bungiu et al.,
/// Efficient computation of visibility polygons, 2014) over a constrained triangulation: the view
/// passes from triangle to triangle through edges that are not part of a line. Left and right of a
/// line of sight are decided exactly; the ends of edges are rounded once. Lines that cross, or
/// touch to within noded()'s rounding, meet in one point.
///
/// Round bodies are closed sets. Their shadows begin at the true tangents, in closed form; their
/// visible sides are edges of outlineOf(), which has the body's area. From inside, deeper than
/// kRayEpsilon, the region is empty; within that depth the view passes into the body, up to its far
/// side. Areas err by less than 1e-6 m2 for bodies of up to 1 m radius.
///
/// The region depends on lines, bodies, viewpoint and range alone: the same bytes for any number of
/// threads, whichever mesh of a large plan serves the view, and whichever queries came before. A
/// query takes a fraction of a microsecond in a small plan and 2 us in a building of 8 000 walls
/// (visibility_bench). Memory: 200 to 600 bytes a line. Thread-safe. Coordinates and ranges are
/// clamped to 1e75 m.
class VisibilityMap {
  public:
    /// O(n log n + crossings) \throws FormatError (without a line number) for lines that cross by
    /// the million
    explicit VisibilityMap(std::span<const Segment2> lines, std::span<const Ellipse> rounds = {});
    VisibilityMap(VisibilityMap&&) noexcept;
    VisibilityMap& operator=(VisibilityMap&&) noexcept;
    ~VisibilityMap();

    /// Computes the region visible from a viewpoint up to max_range, all around, and stores it in
    /// `region`, whose memory is reused. Any viewpoint is allowed: on a line (within kRayEpsilon it
    /// is moved onto it), on an end point or a crossing, or outside all lines. Typically O(edges +
    /// log n), and O(edges) for each round body within range.
    /// \pre max_range >= 0; 0 gives an empty region. Use +infinity where lines enclose the
    ///      viewpoint: if the view is free after all, it ends beyond all lines, at region.max_range
    /// \param reach of the farthest view that the caller asks for: in a large plan, an index of
    ///     parts serves short views, where few of them pay for their surroundings alone; the first
    ///     one in a part builds its index. The view is the same
    void query(Point2 viewpoint, double max_range, VisibleRegion& region,
               double reach = std::numeric_limits<double>::infinity()) const;
    [[nodiscard]] VisibleRegion query(Point2 viewpoint, double max_range) const;

  private:
    struct Data;
    void queryLines(Point2 viewpoint, double max_range, double reach, VisibleRegion& region) const;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
