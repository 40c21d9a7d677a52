// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trace/body_ray.h"

namespace ispace {

/// A fan of rays from one place, and the ranges that bodies shorten.
class BodyFan {
  public:
    BodyFan(Point3 origin, const Directions& directions, double max_range,
            const ShortenedRanges& ranges);

    /// All that may be met lies on this part of the floor.
    [[nodiscard]] Box2 box() const;
    void meet(const MovingBody& body, const BodyExtent& extent);

  private:
    void meetArc(const MovingBody& body, const BodyExtent& extent);
    void meetAll(const BodyFrom& body);
    [[nodiscard]] bool approach(const MovingBody& body, const BodyExtent& extent);
    void meetBetween(const BodyFrom& body, double middle, double half);
    void meetBeams(const BodyFrom& body, std::size_t begin, std::size_t end);

    Point3 origin_;
    const Directions& directions_;
    double far_;
    ShortenedRanges ranges_;
    double first_ = 0, step_ = 0;  // of an arc, degrees
    Vec2 ahead_;  // no beam points away from it; null if there is no such direction
    // Of the body at hand, on the floor.
    Vec2 way_;
    double distance_ = 0, reach_ = 0;
};

}  // namespace ispace
