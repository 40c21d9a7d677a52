// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/coverage: the floor on which a lens that is not even has enough pixels a
// metre.
//
// A level set (level_set.h) of pixels a radian over the density less the distance, which is 0 at
// the density and has no pole at the camera. Bounds by interval arithmetic skip boxes of one sign,
// so that most samples near the boundary alone are taken. Accuracy is that of levelSet().
#pragma once

#include <optional>
#include <vector>

#include "geom/curve.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "scene/sensor/lens_resolution.h"

namespace ispace {

/// The part of a level plane, `drop` above a camera, with at least some density. Samples the lens
/// in a box of the plane, once for as many densities as have parts of about this size. Coordinates
/// are relative to the foot.
class DenseFloor {
  public:
    /// \param box bounds of the plane that counts, for instance of that in view
    DenseFloor(const LensResolution& lens, const Frame3& frame, double drop, const Box2& box);

    /// Returns the part with this density: exact in the box, beyond it closing edges are arbitrary.
    /// Takes least time if densities rise from call to call.
    [[nodiscard]] std::vector<Curve> least(double pixels_per_metre);
    /// Likewise from few samples, for views with this density alone. \param box bounds of floor
    /// near enough to the camera
    [[nodiscard]] static std::vector<Curve> alone(const LensResolution& lens, const Frame3& frame,
                                                  double drop, const Box2& box,
                                                  double pixels_per_metre);

    /// Returns bounds of the density in a part of the plane.
    [[nodiscard]] Interval densitiesIn(const std::vector<Curve>& part) const;

  private:
    /// Bounds of pixels a radian and of the distance in a box.
    struct Bounds {
        Interval pixels, distance;
    };
    /// Pixels a radian and distance at a point.
    struct Sample {
        double pixels = 0, distance = 0;
        /// 0 at a density, and linear in the distance: without a pole at the camera.
        [[nodiscard]] double over(double pixels_per_metre) const {
            return pixels / pixels_per_metre - distance;
        }
    };
    [[nodiscard]] Sample sampleAt(Point2 place) const;
    /// Prepares samples in a box, which traced() evaluates once.
    void sampleIn(const Box2& box, int side);
    [[nodiscard]] std::vector<Curve> traced(double pixels_per_metre);
    [[nodiscard]] Bounds boundsIn(const Box2& box) const;

    const LensResolution& lens_;
    const Frame3& frame_;
    double drop_;
    Box2 box_;                                    ///< with a margin
    std::optional<double> most_;                  ///< pixels a radian of the lens, once known
    Box2 sampled_;                                ///< the box of the samples
    int side_ = 0;                                ///< samples in a row of the box
    std::vector<std::optional<Sample>> samples_;  ///< those evaluated
};

}  // namespace ispace
