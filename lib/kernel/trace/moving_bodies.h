// SPDX-License-Identifier: GPL-3.0-or-later
// Robots and people as rays meet them: boxes, cylinders and balls on the floor, found by a grid.
//
// Ranges are shortened in place after the walls were met, in doubles, exact up to rounding; bodies
// are closed sets. Results depend on the bodies and the ray alone, not on the order of bodies, the
// grid or the number of threads. Const members are thread-safe; rebuild() is not, and costs O(n).
//
//     MovingBodies bodies;
//     bodies.rebuild(now);                                  // after each motion
//     world.cast(origin, beams, 8, ranges);
//     bodies.shorten(origin, beams, 8, own_owner, ranges);  // its own body is not met
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/point.h"
#include "geom/pose.h"
#include "scene/bodies.h"
#include "trace/rays.h"

namespace ispace {

/// A box, ball or cylinder, upright or slanted, that moves on the floor: the geometry of robots and
/// people for rays.
struct MovingBody {
    Pose2 pose;                              ///< of the level cut at middle()
    double half_length = 0, half_width = 0;  ///< of a box, along and across the heading
    double radius = 0;                       ///< of a cylinder or ball; 0: a box
    double bottom = 0, top = 0;              ///< heights, both included
    std::uint32_t owner = 0;                 ///< owner; its own sensors ignore the body
    double lean = 0;          ///< of a slanted cylinder, along the heading, see BodyPart
    bool is_ball = false;     ///< of `radius`
    bool faces_down = false;  ///< see BodyPart

    [[nodiscard]] double middle() const { return 0.5 * (bottom + top); }
    /// Radius of the smallest circle that encloses each of its level cuts, about the cut's middle.
    [[nodiscard]] double reach() const;
    /// Maximum displacement of its level cuts from its middle.
    [[nodiscard]] double sway() const;
    /// Returns an upright body with the same level cut at a height. \pre bottom <= z <= top
    [[nodiscard]] MovingBody cutAt(double z) const;
    /// Returns the outward unit normal at a point of its surface.
    [[nodiscard]] Vec3 normalAt(Point3 place) const;
    /// Computes the distance along the ray to the surface, +infinity if it misses; from inside, to
    /// the exit. \pre direction is a unit vector
    [[nodiscard]] double meet(Point3 origin, Vec3 direction) const;
    friend bool operator==(const MovingBody&, const MovingBody&) = default;
};

/// Converts a part of a body with this pose. \param axes of the pose's heading
MovingBody movingBody(const BodyPart& part, const Pose2& pose, CosSin axes, std::uint32_t owner);

/// Values of a body shared by all rays.
struct BodyExtent {
    CosSin axes;              ///< of its heading
    double reach = 0;         ///< MovingBody::reach()
    double whole = 0;         ///< radius of a circle about its middle that contains all level cuts
    std::uint32_t mover = 0;  ///< number of the mover, whose bodies follow one another
};

/// Finds neighbours on the floor: a uniform grid over the positions of movers, rebuilt by counting
/// sort, O(n + cells), after each motion. It has at most 2 n + 1 cells, none smaller than the
/// widest mover.
class FloorGrid {
  public:
    /// \param reach maximum extent of a mover from its position \pre positions are finite
    void rebuild(std::span<const Point2> places, double reach);
    /// Calls visit(index) once for each mover that may extend into the box, in a fixed order.
    template <typename Visit>
    void forEachNear(const Box2& box, Visit visit) const;
    /// The same in runs of order(), excluding the cells of another box: calls visit(begin, end).
    template <typename Visit>
    void forEachRun(const Box2& box, const Box2& without, Visit visit) const;
    /// Returns true if `is_met(index)` does for a mover that may meet the segment. Calls it for
    /// those in the cells along the segment only, roughly from `a` on, until it returns true.
    template <typename IsMet>
    [[nodiscard]] bool anyAlong(Point2 a, Point2 b, IsMet is_met) const;
    /// Side of a cell.
    [[nodiscard]] double cellSize() const { return size_; }
    [[nodiscard]] bool empty() const { return indices_.empty(); }
    /// Indices of all movers, grouped by cell.
    [[nodiscard]] std::span<const std::uint32_t> order() const { return indices_; }

  private:
    /// Cells from low to high, inclusive; empty if `right` is less than `left`.
    struct Cells {
        std::size_t left = 1, right = 0, low = 1, high = 0;
    };
    [[nodiscard]] Cells cellsAbout(const Box2& box) const;
    /// Returns the box of the part of a segment that movers in a row of cells may meet; empty
    /// without one.
    [[nodiscard]] Box2 partInRow(Point2 a, Point2 b, std::size_t row) const;
    [[nodiscard]] std::size_t cellOf(double offset, std::size_t count) const;

    Box2 box_;
    double size_ = 1, reach_ = 0;
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<std::uint32_t> first_ = {0, 0}, indices_;
};

/// The moving bodies at one time. Moving them does not change the ray worlds of the environment.
class MovingBodies {
  public:
    static constexpr std::uint32_t kNoOwner = std::numeric_limits<std::uint32_t>::max();

    MovingBodies() = default;
    explicit MovingBodies(std::vector<MovingBody> bodies);
    /// Replaces the bodies. \pre `bodies` does not alias bodies()
    void rebuild(std::span<const MovingBody> bodies);
    [[nodiscard]] std::span<const MovingBody> bodies() const { return bodies_; }

    /// Shortens the ranges of rays from the sensor's position that meet bodies, except those owned
    /// by `own`. `cosines`, if not empty, are updated at the bodies met, as in RayWorld::cast.
    /// Level directions with an arc are fastest.
    /// \pre directions.size() == ranges.size()
    void shorten(Point3 origin, const Directions& directions, double max_range, std::uint32_t own,
                 std::span<float> ranges, std::span<float> cosines = {}) const;
    /// The same with an origin for each ray, for rays `begin` to before `end` only. Fastest for
    /// neighbours with nearby origins.
    void shorten(std::span<const Point3> origins, const Directions& directions, std::size_t begin,
                 std::size_t end, double max_range, std::uint32_t own, std::span<float> ranges,
                 std::span<float> cosines = {}) const;
    /// The same for a picture with ranges in multiples of its rays' vectors; visits only pixels
    /// near a body.
    void shorten(Point3 origin, const RayGrid& grid, double most, std::uint32_t own,
                 std::span<float> multiples, std::span<float> cosines = {}) const;
    /// True if a body separates two points or contains one of them, ends included. \pre they differ
    [[nodiscard]] bool between(Point3 a, Point3 b, std::uint32_t own) const;
    /// Returns true if `is_met(i)` does for bodies()[i], a body that may meet the segment. Visits
    /// only bodies near the segment, until it returns true.
    template <typename IsMet>
    [[nodiscard]] bool anyAlong(Point3 a, Point3 b, IsMet is_met) const {
        return clipToHeights(a, b) && grid_.anyAlong(a.onFloor(), b.onFloor(), is_met);
    }
    /// Returns the numbers, ascending, of all bodies that may lie less than `reach` from a point in
    /// plan, and others near them.
    [[nodiscard]] std::vector<std::uint32_t> bodiesNear(Point2 place, double reach) const;
    /// Returns bodies()[i].meet(), without the trigonometry.
    [[nodiscard]] double meet(std::size_t i, Point3 origin, Vec3 direction) const;
    /// Returns the number of the mover of bodies()[i]: bodies of one owner that follow one another
    /// are of one mover.
    [[nodiscard]] std::size_t moverOf(std::size_t i) const { return extents_[i].mover; }

  private:
    void index();
    /// Cuts a segment to the heights of all bodies. Returns false if it passes over or under them.
    [[nodiscard]] bool clipToHeights(Point3& a, Point3& b) const;
    void shortenInBlocks(std::span<const Point3> origins, const Directions& directions,
                         std::size_t begin, std::size_t end, double max_range, std::uint32_t own,
                         std::span<float> ranges, std::span<float> cosines) const;

    std::vector<MovingBody> bodies_;
    std::vector<BodyExtent> extents_;
    std::vector<Point2> places_;   // of the bodies; kept to reuse its memory
    double bottom_ = 0, top_ = 0;  // of all bodies, with a margin
    FloorGrid grid_;
};

template <typename Visit>
void FloorGrid::forEachNear(const Box2& box, Visit visit) const {
    forEachRun(box, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) visit(std::size_t{indices_[i]});
    });
}

template <typename Visit>
void FloorGrid::forEachRun(const Box2& box, const Box2& without, Visit visit) const {
    if (indices_.empty() || box.empty()) return;
    const Cells cells = cellsAbout(box), done = cellsAbout(without);
    // The cells of a row are contiguous.
    const auto run = [&](std::size_t row, std::size_t from, std::size_t to) {
        const std::size_t begin = first_[row * columns_ + from], end = first_[row * columns_ + to];
        if (begin < end) visit(begin, end);
    };
    for (std::size_t row = cells.low; row <= cells.high; ++row) {
        if (row < done.low || row > done.high) {
            run(row, cells.left, cells.right + 1);
        } else {
            if (cells.left < done.left) run(row, cells.left, std::min(cells.right + 1, done.left));
            if (cells.right > done.right)
                run(row, std::max(cells.left, done.right + 1), cells.right + 1);
        }
    }
}

template <typename IsMet>
bool FloorGrid::anyAlong(Point2 a, Point2 b, IsMet is_met) const {
    if (indices_.empty()) return false;
    Box2 whole;
    whole.add(a);
    whole.add(b);
    const Cells rows = cellsAbout(whole);
    const bool is_up = a.y <= b.y, is_right = a.x <= b.x;
    for (std::size_t k = rows.low; k <= rows.high; ++k) {
        const std::size_t row = is_up ? k : rows.high - (k - rows.low);
        const Box2 part = partInRow(a, b, row);
        if (part.empty()) continue;
        const Cells cells = cellsAbout(part);
        const std::size_t begin = first_[row * columns_ + cells.left],
                          end = first_[row * columns_ + cells.right + 1];
        for (std::size_t i = begin; i < end; ++i)
            if (is_met(std::size_t{indices_[is_right ? i : end - 1 - (i - begin)]})) return true;
    }
    return false;
}

}  // namespace ispace
