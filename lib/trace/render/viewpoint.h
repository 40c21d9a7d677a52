// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geom/pose.h"
#include "scene/sensor/camera.h"

namespace ispace {

/// What a place in a picture shows: the first surface on this ray, in the world. Depths are
/// multiples of `direction`, which need not be of unit length.
struct PixelRay {
    Point3 origin;
    Vec3 direction;
};

/// Lines of sight that are the same function of the place in the whole picture: (column, row) has
/// origin + column * origin_right + row * origin_down, and likewise its direction.
struct EvenSightLines {
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

/// From where, and how, a picture is taken. Pixel centres are whole numbers, as in PixelPoint.
/// Thread-safe.
class Viewpoint {
  public:
    Viewpoint(int columns, int rows) : columns_(columns), rows_(rows) {}
    virtual ~Viewpoint() = default;

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    /// The line of sight of a place; nothing where the picture is black. Smooth in the place but at
    /// the rim of what is black: within a pixel it is taken as even.
    [[nodiscard]] virtual std::optional<PixelRay> sightLine(PixelPoint place) const = 0;
    /// All of them at once, where they are even: much faster.
    [[nodiscard]] virtual std::optional<EvenSightLines> evenSightLines() const {
        return std::nullopt;
    }

  protected:
    Viewpoint(const Viewpoint&) = default;
    Viewpoint& operator=(const Viewpoint&) = default;

  private:
    int columns_, rows_;
};

/// A camera at a pose. Depth is along the axis for pinholes, distance for the other lenses. The
/// rays of lenses that bend them are computed once: keep one for many pictures, and move it.
class CameraView : public Viewpoint {
  public:
    CameraView(const Camera& camera, const Pose3& pose);

    /// The same camera at another pose.
    [[nodiscard]] CameraView at(const Pose3& pose) const;
    [[nodiscard]] std::optional<PixelRay> sightLine(PixelPoint place) const override;
    [[nodiscard]] std::optional<EvenSightLines> evenSightLines() const override;
    /// Where a place in the world is in the picture, or beside it.
    [[nodiscard]] std::optional<PixelPoint> project(Point3 place) const;

  private:
    [[nodiscard]] std::optional<Vec3> localRay(PixelPoint place) const;

    Camera camera_;
    Frame3 world_from_camera_;
    /// Rays of the pixel centres, row by row, in the camera's frame; null vectors where it has
    /// none. Null for straight cameras.
    std::shared_ptr<const std::vector<Vec3>> rays_;
};

/// Parallel lines of sight along the pose's x axis, through a rectangle of this width about its
/// position; the height follows from square pixels. Depth is from that rectangle. A plan as seen
/// from above looks down: tilt -90 degrees; heading 90 degrees then has north up.
class OrthographicView : public Viewpoint {
  public:
    OrthographicView(const Pose3& pose, double width, int columns, int rows);

    [[nodiscard]] std::optional<PixelRay> sightLine(PixelPoint place) const override;
    [[nodiscard]] std::optional<EvenSightLines> evenSightLines() const override { return lines_; }
    /// Where a place in the world is in the picture, or beside it.
    [[nodiscard]] PixelPoint project(Point3 place) const;

  private:
    Frame3 frame_;
    double pixel_;  ///< metres a pixel
    EvenSightLines lines_;
};

}  // namespace ispace
