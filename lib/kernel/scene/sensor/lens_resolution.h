// SPDX-License-Identifier: GPL-3.0-or-later
// How finely a camera's lens resolves each direction, in pixels a radian and pixels a metre; bounds
// of it by interval arithmetic, for regions of a floor. Pure functions of the camera: thread-safe,
// at() is O(1).
//
//     const LensResolution lens(camera);
//     const double at_five_metres = lens.at({1, 0, 0}) / 5;  // pixels a metre, straight ahead
#pragma once

#include <array>

#include "geom/interval.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "scene/sensor/camera.h"

namespace ispace {

/// Pixels that a flat target gets in the picture of a lens, by direction. The target faces the
/// camera; of its lines the one along which the picture has fewest pixels counts: along or across
/// the direction to the centre of the picture, or, with tangential distortion, between them. The
/// pixels count as squares of the larger side.
///
/// Pixels a metre are at() divided by the distance. For a pinhole that is the focal length
/// divided by depth, for an equidistant fisheye the focal length divided by distance.
class LensResolution {
  public:
    explicit LensResolution(const Camera& camera);

    /// Returns true for lenses with the closed form above: the density follows from depth or
    /// distance alone.
    [[nodiscard]] static bool isEven(const Camera& camera);

    /// Returns pixels a radian in a direction of the camera's frame, of any length but 0. Beyond
    /// the picture's greatest angle off the axis they are those at this angle.
    [[nodiscard]] double at(Vec3 direction) const;
    /// Returns pixels a metre at a point of the camera's frame; +infinity at the camera.
    [[nodiscard]] double densityAt(Vec3 local) const;
    /// Returns an upper bound of the distance, of a pinhole of the depth, at which the picture has
    /// this many pixels a metre.
    [[nodiscard]] double farthest(double pixels_per_metre) const;
    /// Returns an upper bound of at().
    [[nodiscard]] double most() const;
    /// Returns bounds of at() for all points of the camera's frame within `radius` of one.
    [[nodiscard]] Interval around(Vec3 center, double radius) const;

  private:
    /// Directions of the camera's frame: the cells of the bounds.
    struct Cell {
        Interval angle, bearing;  ///< off the axis, and in the picture; radians
    };
    /// Returns bounds of at() in a cell, for a focal length of 1.
    [[nodiscard]] Interval unitIn(const Cell& cell) const;
    /// Returns an upper bound of at() in the picture, or of its product with the cosine of the
    /// angle off the axis.
    [[nodiscard]] double largest(bool is_along_axis) const;
    /// Returns at() for a focal length of 1: `along` and `across` are the cosine and sine of the
    /// angle off the axis, (u, v) the unit vector of its bearing in the picture.
    [[nodiscard]] double unitAt(double along, double across, double u, double v) const;
    /// Returns the derivatives of a pinhole's picture by the direction, in the frame of the bearing
    /// (u, v): of its row and column, by a radian along the bearing and one across it.
    template <typename Number>
    [[nodiscard]] std::array<Number, 4> stretch(Number tangent, Number u, Number v) const;

    Lens lens_;
    double focal_, mirror_;
    std::array<double, 5> distortion_;
    double widest_;  ///< angle off the axis, radians
    double cos_widest_, sin_widest_;
    bool is_lopsided_;
};

}  // namespace ispace
