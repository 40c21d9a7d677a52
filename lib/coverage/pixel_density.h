// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/coverage only: what cameras make of the plane, one by one and together.
#pragma once

#include <span>
#include <vector>

#include "coverage/coverage.h"
#include "coverage/metrics.h"
#include "scene/sensor/camera.h"

namespace ispace {

/// How many pixels a metre a camera has on a level plane, see rangeOf(): its focal length over
/// depth or distance.
class FloorDensity {
  public:
    FloorDensity(const Camera& camera, const Pose3& pose, double plane);

    /// At a place of the plane; +infinity at the camera and, of a pinhole, beside it.
    [[nodiscard]] double at(Point2 place) const;
    /// What of `box` has at least so many; of a fisheye or mirror all around the foot. No curves:
    /// nothing has.
    [[nodiscard]] std::vector<Curve> least(double pixels_per_metre, const Box2& box) const;
    /// Integral over what curves hold, in pixels times metres. Chords stand for arcs.
    [[nodiscard]] double integral(std::span<const Curve> curves) const;

  private:
    [[nodiscard]] double alongAxis(Point2 a, Point2 b) const;
    [[nodiscard]] double around(Point2 a, Point2 b) const;

    double focal_, drop_;
    bool is_by_depth_;
    Point2 foot_;
    Vec3 axis_;
    double slope_;  ///< of depth, along the plane
};

/// What of its view has the pixels of each of pixelDensities(). \param view all that it sees, so
/// that `region` and `cells` have no less than they have at any density
std::vector<CoveredSet> classesOf(const FloorDensity& density, const Grid& grid,
                                  const CoveredSet& view);

/// \pre view.classes are there
PictureMetrics pictureMetricsOf(const FloorDensity& density, const Grid& grid, Point2 foot,
                                const SensorView& view);

/// Sets report.densities, those of its zones, and the overlays behind them. Nothing without
/// cameras.
void addDensities(Coverage& coverage, const Environment& environment,
                  const std::vector<Region>& free_floor, const std::vector<Zone>& zones);

/// Sets report.parallax and its coverage. Exact for up to 60 cameras whose regions are known.
void addParallax(Coverage& coverage, const Environment& environment, const ParallaxChoice& choice);

}  // namespace ispace
