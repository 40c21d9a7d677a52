// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/point_cloud.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "geom/rotation.h"

namespace ispace {

namespace {

/// Fills a cloud point by point.
class Filler {
  public:
    Filler(PointCloud& cloud, std::size_t width, std::size_t height) {
        cloud.width = width;
        cloud.height = height;
        cloud.xyz.resize(3 * cloud.size());
        next_ = cloud.xyz.data();
    }
    void add(Point3 p) {
        *next_++ = static_cast<float>(p.x);
        *next_++ = static_cast<float>(p.y);
        *next_++ = static_cast<float>(p.z);
    }
    void addMissing() {
        for (int i = 0; i < 3; ++i) *next_++ = std::numeric_limits<float>::quiet_NaN();
    }

  private:
    float* next_;
};

/// The rays of all pixels: those of a column share a part, and so do those of a row.
struct PixelRays {
    std::vector<Vec3> columns;  ///< with z 0
    std::vector<Vec2> rows;     ///< what a column's ray is multiplied by, and its z

    explicit PixelRays(const Ranger& ranger) {
        const bool spherical = ranger.projection == Projection::Spherical;
        columns.reserve(static_cast<std::size_t>(ranger.columns));
        for (int column = 0; column < ranger.columns; ++column) {
            Vec3 ray = ranger.ray(column, ranger.cy());
            ray.z = 0;
            columns.push_back(spherical ? 1 / length(ray) * ray : ray);
        }
        rows.reserve(static_cast<std::size_t>(ranger.rows));
        for (int row = 0; row < ranger.rows; ++row) {
            const Vec3 ray = ranger.ray(ranger.cx(), row);
            rows.push_back({spherical ? std::hypot(ray.x, ray.y) : 1, ray.z});
        }
    }
};

/// Directions of a laser's beams in its frame. What one thread computed last is kept, as most
/// clouds are those of one laser, or of lasers alike; valid until the next call.
const std::vector<Vec2>& beamsOf(const Laser& laser) {
    struct Known {
        Angle first, step;
        std::vector<Vec2> beams;
    };
    thread_local Known known;
    const auto count = static_cast<std::size_t>(laser.beams);
    if (known.beams.size() == count && known.first == laser.first && known.step == laser.step)
        return known.beams;
    known.first = laser.first;
    known.step = laser.step;
    known.beams.resize(count);
    for (std::size_t k = 0; k < count; ++k)
        known.beams[k] = unitVector(laser.bearing(static_cast<int>(k)));
    return known.beams;
}

}  // namespace

PointCloud cloudOf(const Ranger& ranger, const DepthFrame& frame, Coordinates in) {
    PointCloud cloud;
    Filler filler(cloud, static_cast<std::size_t>(ranger.columns),
                  static_cast<std::size_t>(ranger.rows));
    const Frame3 world = in == Coordinates::World ? Frame3(frame.pose) : Frame3();
    if (in == Coordinates::Sensor) cloud.viewpoint = frame.pose;
    const PixelRays rays(ranger);
    const float* depth = frame.depths.data();
    for (const auto [across, z] : rays.rows) {
        for (const Vec3& column : rays.columns) {
            const double range = *depth++;
            if (std::isfinite(range)) {
                filler.add(world.origin +
                           world * (range * Vec3{across * column.x, across * column.y, z}));
            } else {
                filler.addMissing();
            }
        }
    }
    return cloud;
}

PointCloud cloudOf(const Laser& laser, std::span<const Scan> scans, Coordinates in) {
    PointCloud cloud;
    Filler filler(cloud, static_cast<std::size_t>(laser.beams), scans.size());
    if (scans.empty()) return cloud;
    const std::vector<Vec2>& beams = beamsOf(laser);
    const Pose3& first = scans.front().pose;
    if (in == Coordinates::Sensor) cloud.viewpoint = first;
    const Frame3 target = in == Coordinates::Sensor ? Frame3(first) : Frame3();

    for (const Scan& scan : scans) {
        const bool at_home =
            in == Coordinates::Sensor && scan.beam_poses.empty() && scan.pose == first;
        Frame3 world(scan.pose);
        for (std::size_t k = 0; k < beams.size(); ++k) {
            const double range = scan.ranges[k];
            if (!std::isfinite(range)) {
                filler.addMissing();
                continue;
            }
            const Vec3 local{range * beams[k].x, range * beams[k].y, 0};
            if (!scan.beam_poses.empty()) world = Frame3(scan.beam_poses[k]);
            if (at_home) {
                filler.add({local.x, local.y, 0});
            } else {
                filler.add(Point3{} + target.toLocal(world.origin + world * local));
            }
        }
    }
    return cloud;
}

}  // namespace ispace
