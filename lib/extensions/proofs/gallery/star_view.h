// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/gallery: the floor, and regions seen from points of it, with tests
// of points that err to one side.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "geom/visibility/visibility.h"

namespace ispace::proofs::gallery {

/// The floor is scaled by a power of two so that its largest coordinate is about this: then
/// kRayEpsilon, within which walls do not block the view, is 1e-10 of it.
constexpr double kScaledExtent = 0x1p20;
/// Bounds the errors of points, distances and lines of sight, in scaled units: 128 roundings of the
/// largest coordinate.
constexpr double kRounding = 0x1p-26;
/// Bounds the distance of a window, or of a computed point on a wall, from the true line: 16
/// roundings.
constexpr double kOffLine = 0x1p-29;
/// Two windows this near, in distance and direction, count as one line where they overlap. All
/// other windows that cross the one there cross the other: so a point at which the two meet sees no
/// more than the next vertex along them, if errors of vertices include this distance.
constexpr double kOneLine = 4 * kRounding;
/// Least distance of a witness from walls, and of the end of a line of sight from ends of walls.
constexpr double kClearance = 0x1p-9;

/// A line of sight that bounds the region seen from a witness: from the end of a wall, which it
/// passes, to the wall behind.
struct Window {
    Point2 near, far;
    double error = 0;  ///< bounds the distance of `far` from the true end, along the wall
};

/// The region seen from a point.
class StarView {
  public:
    StarView(const VisibleRegion& region, std::span<const Segment2> walls);

    [[nodiscard]] Point2 viewpoint() const { return viewpoint_; }
    /// Without parts that no wall bounds, outside of the floor.
    [[nodiscard]] const Polygon& outline() const { return outline_; }
    /// False only if p is farther than `margin` from the region. O(log edges) \pre margin >= 0
    [[nodiscard]] bool mayHold(Point2 p, double margin) const;

  private:
    /// The part between the directions of `from` and `to`, up to a wall.
    struct Wedge {
        Vec2 from, to;  // unit vectors
        Vec2 normal;    // of the wall, towards the viewpoint
        double depth;   // distance of the viewpoint from the wall's line
    };

    Point2 viewpoint_;
    Polygon outline_;
    Box2 box_;
    std::vector<double> turns_;  // pseudo-angles of `from`, ascending
    std::vector<Wedge> wedges_;
};

/// An end of two walls, with the floor on the left of both.
struct Corner {
    Point2 at, before, next;
    bool is_convex = false;   ///< less than a half turn of floor
    bool is_rounded = false;  ///< a point on a wall
};

/// The floor and its walls, in scaled units.
class Floor {
  public:
    explicit Floor(std::span<const Region> regions);

    [[nodiscard]] double scale() const { return scale_; }
    [[nodiscard]] double area() const { return area_; }
    [[nodiscard]] const std::vector<Region>& regions() const { return regions_; }
    [[nodiscard]] std::span<const Segment2> walls() const { return walls_; }
    /// Returns the corner at this point, unless several curves meet there; for a point on a wall,
    /// up to rounding and clear of its ends, the corner of a half turn.
    [[nodiscard]] std::optional<Corner> cornerAt(Point2 p) const;

    /// Computes the region that a point of the floor sees; from a corner, its part between the two
    /// walls that meet there.
    [[nodiscard]] VisibleRegion viewFrom(Point2 p) const;
    /// Returns the windows of a view; nullopt unless the viewpoint is generic: on the boundary or
    /// clear of walls, and without a line of sight that passes one wall on the left and ends at the
    /// end of another on the right, beyond which it might see a needle without area.
    [[nodiscard]] std::optional<std::vector<Window>> windowsOf(const VisibleRegion& region) const;

  private:
    [[nodiscard]] std::optional<Window> windowBetween(Point2 from, const VisibilityEdge& edge,
                                                      const VisibilityEdge& next) const;
    /// Returns the window along a wall that ends at the corner `near`, and goes on to `far`.
    [[nodiscard]] const Corner* exactCornerAt(Point2 p) const;
    [[nodiscard]] bool isConvexAt(Point2 p) const {
        const Corner* corner = exactCornerAt(p);
        return corner != nullptr && corner->is_convex;
    }
    [[nodiscard]] std::optional<Window> windowTo(Point2 from, Point2 near, Point2 far,
                                                 std::uint32_t hit) const;

    double scale_ = 1, area_ = 0;
    std::vector<Region> regions_;
    std::vector<Segment2> walls_;
    std::vector<Corner> corners_;  // by position
    VisibilityMap map_;
};

}  // namespace ispace::proofs::gallery
