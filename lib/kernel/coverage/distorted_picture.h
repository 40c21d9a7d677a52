// SPDX-License-Identifier: GPL-3.0-or-later
// Decides for boxes of the plane at depth 1, x right and y down, whether a distorting pinhole sees
// all or no part of them; HeldViews tests whole cells of a floor by it. Lenses that distort by the
// angle to the axis alone have PictureTable.
//
//     const Interval inside = DistortedPicture(camera).margin({-0.1, 0.1}, {0.2, 0.4});
//     if (inside.low > 0) addAll(box);  // else if (inside.high >= 0) split it
#pragma once

#include <algorithm>
#include <array>

#include "scene/sensor/camera.h"
#include "scene/sensor/plumb_bob.h"

namespace ispace {

/// The picture of a pinhole with distortion (the model of D. C. Brown, Decentering distortion of
/// lenses, 1966, as OpenCV has it), in its plane at depth 1. Bounds whole boxes of that plane by
/// interval arithmetic: a box with margin above 0 lies in the picture, one below 0 outside, others
/// are split or tested point by point. Bounds are wider than the truth, never narrower but for
/// rounding. O(1)
class DistortedPicture {
  public:
    explicit DistortedPicture(const Camera& camera)
        : distortion_(camera.distortion),
          low_{(-0.5 - camera.cx) / camera.fx, (-0.5 - camera.cy) / camera.fy},
          high_{(camera.columns - 0.5 - camera.cx) / camera.fx,
                (camera.rows - 0.5 - camera.cy) / camera.fy},
          steepest_(squareOf(tan(camera.widest))) {}

    /// Bounds a function that is at least 0 at points inside and negative outside, over a box.
    [[nodiscard]] Interval margin(Interval x, Interval y) const {
        const auto [u, v] = plumbBob(distortion_, x, y);
        const Interval s = squareOf(x) + squareOf(y);
        return {std::min({u.low - low_.x, high_.x - u.high, v.low - low_.y, high_.y - v.high,
                          steepest_ - s.high}),
                std::min({u.high - low_.x, high_.x - u.low, v.high - low_.y, high_.y - v.low,
                          steepest_ - s.low})};
    }

  private:
    std::array<double, 5> distortion_;
    Vec2 low_, high_;  // the picture's bounds, in focal lengths from its centre
    double steepest_;  // squared tangent at which the lens ends
};

}  // namespace ispace
