// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trace/body_ray.h"

namespace ispace {

/// The pixels [left, right) x [top, bottom) of a picture.
struct PixelBox {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// A picture whose ranges bodies shorten.
class BodyPicture {
  public:
    BodyPicture(Point3 origin, const RayGrid& grid, double most, const ShortenedRanges& ranges);

    /// All that may be met lies on this part of the floor.
    [[nodiscard]] Box2 box() const;
    void meet(const MovingBody& body, const BodyExtent& extent);

    /// Pixels whose rays may meet the body: all if it holds the origin.
    [[nodiscard]] PixelBox pixelsOf(const MovingBody& body, const BodyExtent& extent) const;

  private:
    /// A place as the picture has it: multiples of right, down and corner that lead to it.
    [[nodiscard]] Vec3 projected(Vec3 way) const {
        return {dot(to_right_, way), dot(to_down_, way), dot(to_corner_, way)};
    }

    Point3 origin_;
    const RayGrid& grid_;
    double far_;  // metres
    ShortenedRanges ranges_;
    bool is_plane_ = false;  // else its rays lie in a plane through the origin
    Vec3 to_right_, to_down_, to_corner_;
};

}  // namespace ispace
