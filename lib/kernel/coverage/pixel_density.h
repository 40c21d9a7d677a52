// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/coverage: metrics of cameras on a plane, one by one and together.
//
// Pixels a metre at a point are pixels a radian of the lens there over the distance; for a straight
// pinhole focal length over depth. The floor with at least a density is then a half plane, for an
// equidistant fisheye a disc, both exact; other lenses are traced (dense_floor.h).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "coverage/coverage.h"
#include "coverage/dense_floor.h"
#include "coverage/metrics.h"
#include "scene/sensor/camera.h"
#include "scene/sensor/lens_resolution.h"

namespace ispace {

/// Pixels a metre of a camera on a level plane, see LensResolution.
class FloorDensity {
  public:
    FloorDensity(const Camera& camera, const Pose3& pose, double plane);

    /// Returns the density at a point of the plane; +infinity at the camera and, of a pinhole
    /// without distortion, beside it.
    [[nodiscard]] double at(Point2 place) const;
    /// Returns the part of `box` with at least this density: of a pinhole without distortion a half
    /// plane, of an equidistant fisheye a disc about the foot, of other lenses a DenseFloor.
    /// Empty curves if it is lower everywhere.
    [[nodiscard]] std::vector<Curve> least(double pixels_per_metre, const Box2& box) const;
    /// Returns the parts of `box`, for many densities. \pre !isEven()
    [[nodiscard]] DenseFloor denseFloor(const Box2& box) const;
    /// Returns the point of the plane below or above the camera.
    [[nodiscard]] Point2 foot() const { return foot_; }
    /// Returns true if the density falls with depth or distance alone.
    [[nodiscard]] bool isEven() const { return !lens_; }
    /// Integrates the density over the area of curves, in pixels times metres. Chords replace arcs.
    [[nodiscard]] double integral(std::span<const Curve> curves) const;

  private:
    [[nodiscard]] double alongAxis(Point2 a, Point2 b) const;
    [[nodiscard]] double around(Point2 a, Point2 b) const;
    [[nodiscard]] double byLens(Point2 a, Point2 b) const;
    [[nodiscard]] Vec3 localOf(Vec2 way) const {
        return frame_.toLocal(frame_.origin + Vec3{way.x, way.y, drop_});
    }

    double focal_, drop_;
    bool is_by_depth_;
    Point2 foot_;
    Frame3 frame_;
    Vec3 axis_;
    double slope_;                        ///< change of depth per metre along the plane
    std::optional<LensResolution> lens_;  ///< of lenses that are not even
};

/// Returns the views of cameras.
std::vector<const SensorView*> camerasOf(const Coverage& coverage);

/// Returns the parts of a view with the pixels of each of densityClasses(). \param view at density
/// 0, so that `region` and `cells` contain the parts of any density
std::vector<CoveredSet> classesOf(const FloorDensity& density, const Grid& grid,
                                  const CoveredSet& view);

/// Computes the picture metrics. \pre view.classes is set
PictureMetrics pictureMetricsOf(const FloorDensity& density, const Grid& grid, Point2 foot,
                                const SensorView& view);

/// Sets report.densities, those of its zones, and the overlays. Does not change a report without
/// cameras. \param is_whole see CoverageOptions::whole_densities
void addDensities(Coverage& coverage, const Environment& environment,
                  const std::vector<Region>& free_floor, const std::vector<Zone>& zones,
                  bool is_whole);

/// Sets report.parallax and its coverage. Exact for up to 60 cameras with known regions.
void addParallax(Coverage& coverage, const Environment& environment, const ParallaxChoice& choice);

}  // namespace ispace
