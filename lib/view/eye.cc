// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/eye.h"

#include <cmath>
#include <numbers>

namespace ispace {

namespace {

class CameraEye final : public Eye {
  public:
    CameraEye(const Camera& camera, const Pose3& pose)
        : view_(camera, pose), frame_(pose), by_axis_(camera.lens == Lens::Pinhole) {}
    [[nodiscard]] const Viewpoint& viewpoint() const override { return view_; }
    [[nodiscard]] std::optional<Sighting> find(Point3 place) const override {
        const auto pixel = view_.project(place);
        if (!pixel) return std::nullopt;
        const Vec3 local = frame_.toLocal(place);
        return Sighting{*pixel, by_axis_ ? local.x : length(local)};
    }

  private:
    CameraView view_;
    Frame3 frame_;
    bool by_axis_;
};

class ParallelEye final : public Eye {
  public:
    ParallelEye(const Pose3& pose, double width, int columns, int rows)
        : view_(pose, width, columns, rows), frame_(pose) {}
    [[nodiscard]] const Viewpoint& viewpoint() const override { return view_; }
    [[nodiscard]] std::optional<Sighting> find(Point3 place) const override {
        return Sighting{view_.project(place), frame_.toLocal(place).x};
    }

  private:
    OrthographicView view_;
    Frame3 frame_;
};

class Panorama final : public Viewpoint, public Eye {
  public:
    Panorama(const Pose3& pose, int columns, int rows)
        : Viewpoint(columns, rows),
          frame_(pose),
          step_across_(2 * std::numbers::pi / columns),
          step_down_(std::numbers::pi / rows) {}
    [[nodiscard]] const Viewpoint& viewpoint() const override { return *this; }
    [[nodiscard]] std::optional<SightLine> sightLine(PixelPoint place) const override {
        const double bearing = std::numbers::pi - (place.column + 0.5) * step_across_;
        const double elevation = std::numbers::pi / 2 - (place.row + 0.5) * step_down_;
        const double level = std::cos(elevation);
        const Vec3 local{level * std::cos(bearing), level * std::sin(bearing), std::sin(elevation)};
        return SightLine{frame_.origin, frame_ * local};
    }
    [[nodiscard]] std::optional<Sighting> find(Point3 place) const override {
        const Vec3 local = frame_.toLocal(place);
        const double bearing = std::atan2(local.y, local.x);
        const double elevation = std::atan2(local.z, std::hypot(local.x, local.y));
        return Sighting{{(std::numbers::pi - bearing) / step_across_ - 0.5,
                         (std::numbers::pi / 2 - elevation) / step_down_ - 0.5},
                        length(local)};
    }

  private:
    Frame3 frame_;
    double step_across_, step_down_;  // radians a pixel
};

}  // namespace

std::unique_ptr<Eye> cameraEye(const Camera& camera, const Pose3& pose) {
    return std::make_unique<CameraEye>(camera, pose);
}

std::unique_ptr<Eye> parallelEye(const Pose3& pose, double width, int columns, int rows) {
    return std::make_unique<ParallelEye>(pose, width, columns, rows);
}

std::unique_ptr<Eye> panoramaEye(const Pose3& pose, int columns, int rows) {
    return std::make_unique<Panorama>(pose, columns, rows);
}

}  // namespace ispace
