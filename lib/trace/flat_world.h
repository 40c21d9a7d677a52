// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>

#include "geom/curve.h"
#include "geom/polygon.h"
#include "trace/rays.h"

namespace ispace {

/// The lines and round bodies of a slice, for level rays: exact to rounding of doubles, and faster
/// than a general ray tracer.
///
/// A scan is drawn like a picture with one row: a bounding volume hierarchy is traversed front to
/// back, boxes behind the farthest range they could shorten are skipped, and each remaining line is
/// drawn into the beams between its ends. A beam meets a line if it crosses it or passes one of its
/// ends within a nanometre (less if it sees the line almost edge-on, see flat_kernels.h), decided
/// in doubles per beam and line: no beam slips between lines with a common end, and one that just
/// touches a corner meets it.
///
/// Lines nearer to the origin than `ray_epsilon` stop nothing, nor do those that continue them
/// within it; a round body that near is met at its far side only. Nor does a line seen exactly
/// edge-on (its straight continuation passes the origin within a nanometre). Thread-safe; results
/// depend only on the lines and the ray, not on the order of lines, the scan a ray is part of, or
/// the processor.
class FlatWorld {
  public:
    explicit FlatWorld(std::span<const Segment2> lines, std::span<const Ellipse> rounds = {});
    FlatWorld(FlatWorld&&) noexcept;
    FlatWorld& operator=(FlatWorld&&) noexcept;
    ~FlatWorld();

    /// Distance of the first line or round body along each direction (x and y count), up to
    /// max_range inclusive; +infinity if there is none. Fastest for directions with an arc, fast
    /// for neighbours alike. `cosines`, if not empty: |cosine| of the angle between ray and normal,
    /// 1 without return; the larger where two lines are met at once. \pre ranges.size() ==
    /// directions.size(), cosines.size() as well or 0
    void cast(Point2 origin, const Directions& directions, double max_range, double ray_epsilon,
              std::span<float> ranges, std::span<float> cosines) const;
    /// The same with an origin for each ray.
    void cast(std::span<const Point2> origins, const Directions& directions, double max_range,
              double ray_epsilon, std::span<float> ranges, std::span<float> cosines) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
