// SPDX-License-Identifier: GPL-3.0-or-later
// Private to MovingBodies: where rays that leave near each other meet bodies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "trace/body_rays.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// A few rays that follow one another, with an origin each, whose ranges bodies shorten. Bodies
/// beside them all, or behind what they meet already, are passed over eight at a time.
class BodyPencil {
  public:
    static constexpr std::size_t kMost = 64;  ///< rays

    /// Rays begin to before end of these. \pre begin < end
    BodyPencil(std::span<const Point3> origins, const Directions& directions, std::size_t begin,
               std::size_t end, double max_range, const ShortenedRanges& ranges);

    /// Bodies outside this part of the floor are not met.
    [[nodiscard]] const Box2& box() const { return box_; }
    /// Meets those of the table from `begin` to before `end`, but not those of `own`.
    void meet(const BodyTable& table, std::size_t begin, std::size_t end, std::uint32_t own,
              std::span<const MovingBody> bodies, std::span<const BodyExtent> extents);

    /// What holds all of the rays: a cone on the floor, about a circle of origins, and two heights.
    struct Hull {
        double x = 0, y = 0, spread = 0;                          // middle and radius of the circle
        double right_x = 0, right_y = 0, left_x = 0, left_y = 0;  // unit vectors along the sides
        bool is_cone = false;  // of less than half a turn; else it has no sides
        double low = 0, high = 0;
        double far = 0;  // beyond the ends of all
    };

  private:
    void setSides();
    /// A body in the way: the circle about it at the heights of the rays, and how near it is.
    struct Ahead {
        const MovingBody& body;
        CosSin axes;
        Point2 center;
        double radius, nearest;
    };
    void meetBody(const Ahead& ahead);

    std::span<const Point3> origins_;
    const Directions& directions_;
    std::size_t begin_, end_;
    ShortenedRanges ranges_;
    Hull hull_;
    Box2 box_;
};

}  // namespace ispace
