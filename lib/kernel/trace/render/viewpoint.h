// SPDX-License-Identifier: GPL-3.0-or-later
// Projections of pictures: cameras with their lenses, and parallel views such as plans. Pixel
// centres are whole numbers, (0, 0) the upper left one; columns count to the right, rows down.
//
//     const Pose3 above{{4, 3, 10}, Angle::degrees(90), Angle::degrees(-90), {}};
//     const OrthographicView plan(above, 8, 800, 600);      // 8 m wide, 1 cm a pixel
//     const PixelPoint at = plan.project({4, 3, 0});        // the centre: (399.5, 299.5)
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geom/pose.h"
#include "scene/sensor/camera.h"

namespace ispace {

/// The ray of a point in a picture, in the world: the picture shows its first surface. Depths are
/// multiples of `direction`, not necessarily of unit length.
struct PixelRay {
    Point3 origin;
    Vec3 direction;
};

/// Lines of sight that are linear in the picture position: (column, row) has origin + column *
/// origin_right + row * origin_down, and likewise its direction.
struct EvenPixelRays {
    Point3 origin;
    Vec3 origin_right, origin_down;
    Vec3 direction, right, down;

    [[nodiscard]] PixelRay at(PixelPoint place) const {
        return {origin + place.column * origin_right + place.row * origin_down,
                {direction.x + place.column * right.x + place.row * down.x,
                 direction.y + place.column * right.y + place.row * down.y,
                 direction.z + place.column * right.z + place.row * down.z}};
    }
};

/// Projection of a picture. Pixel centres are whole numbers, as in PixelPoint. Thread-safe.
class Viewpoint {
  public:
    Viewpoint(int columns, int rows) : columns_(columns), rows_(rows) {}
    virtual ~Viewpoint() = default;

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    /// Returns the line of sight of a position; empty where the picture is black. Smooth except at
    /// the rim of the black part: treated as linear within a pixel.
    [[nodiscard]] virtual std::optional<PixelRay> sightLine(PixelPoint place) const = 0;
    /// Returns all lines of sight at once if they are linear: much faster.
    [[nodiscard]] virtual std::optional<EvenPixelRays> evenPixelRays() const {
        return std::nullopt;
    }

  protected:
    Viewpoint(const Viewpoint&) = default;
    Viewpoint& operator=(const Viewpoint&) = default;

  private:
    int columns_, rows_;
};

/// A camera at a pose. Depth is along the axis for pinholes, distance for the other lenses. The
/// rays of lenses with distortion are computed once: reuse one view for many pictures, and move it.
class CameraView : public Viewpoint {
  public:
    CameraView(const Camera& camera, const Pose3& pose);

    /// Returns the same camera at another pose.
    [[nodiscard]] CameraView at(const Pose3& pose) const;
    [[nodiscard]] std::optional<PixelRay> sightLine(PixelPoint place) const override;
    [[nodiscard]] std::optional<EvenPixelRays> evenPixelRays() const override;
    /// Projects a point of the world, possibly outside the picture.
    [[nodiscard]] std::optional<PixelPoint> project(Point3 place) const;

  private:
    [[nodiscard]] std::optional<Vec3> localRay(PixelPoint place) const;

    Camera camera_;
    Frame3 world_from_camera_;
    /// Rays of the pixel centres, row by row, in the camera's frame; null vectors for black pixels.
    /// Null for straight cameras.
    std::shared_ptr<const std::vector<Vec3>> rays_;
};

/// Parallel lines of sight along the pose's x axis, through a rectangle of this width about its
/// position; the height follows from square pixels. Depth is measured from that rectangle. A plan
/// view looks down: tilt -90 degrees; heading 90 degrees then has north up.
class OrthographicView : public Viewpoint {
  public:
    OrthographicView(const Pose3& pose, double width, int columns, int rows);

    [[nodiscard]] std::optional<PixelRay> sightLine(PixelPoint place) const override;
    [[nodiscard]] std::optional<EvenPixelRays> evenPixelRays() const override { return lines_; }
    /// Projects a point of the world, possibly outside the picture.
    [[nodiscard]] PixelPoint project(Point3 place) const;

  private:
    Frame3 frame_;
    double pixel_;  ///< metres per pixel
    EvenPixelRays lines_;
};

}  // namespace ispace
