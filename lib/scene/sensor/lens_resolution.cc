// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/lens_resolution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/sensor/plumb_bob.h"

namespace ispace {

namespace {

/// The smaller singular value of a matrix with these rows.
double leastStretch(Vec2 a, Vec2 b) {
    const double sum = dot(a, a) + dot(b, b), det = a.x * b.y - a.y * b.x;
    const double apart = std::sqrt(std::max(0.0, sum * sum - 4 * det * det));
    return std::fabs(det) / std::sqrt(std::max((sum + apart) / 2, 1e-300));
}

}  // namespace

LensResolution::LensResolution(const Camera& camera)
    : lens_(camera.lens),
      focal_(std::min(camera.fx, camera.fy)),
      mirror_(camera.mirror),
      distortion_(camera.distortion),
      widest_(camera.widestInPicture().radians()),
      cos_widest_(std::cos(widest_)),
      sin_widest_(std::sin(widest_)),
      is_lopsided_(camera.isLopsided()) {}

bool LensResolution::isEven(const Camera& camera) {
    return camera.isStraight() || (camera.lens == Lens::Fisheye && !camera.isDistorted());
}

/// The pixel (u, v) of the point (p, q) = t (u, v) of the plane at depth 1 moves by the Jacobian of
/// `plumb_bob`. A radian along the bearing moves the point by 1 + t^2, one across it by the square
/// root of that.
double LensResolution::unitPinhole(double tangent, double u, double v) const {
    const PlumbBobSlope slope(distortion_, {tangent * u, tangent * v});
    const Vec2 across_row{slope.xx, slope.xy}, upright_row{slope.xy, slope.yy};
    const double s = tangent * tangent;
    const double far = 1 + s, near = std::sqrt(far);
    const auto turned = [&](Vec2 row) {
        return Vec2{far * (row.x * u + row.y * v), near * (row.y * u - row.x * v)};
    };
    return leastStretch(turned(across_row), turned(upright_row));
}

double LensResolution::unitAt(double along, double across, double u, double v) const {
    constexpr double kSmall = 1e-9;
    if (lens_ == Lens::Pinhole) return unitPinhole(across / along, u, v);
    if (lens_ == Lens::Mirror) {
        const double depth = along + mirror_;
        return std::min(1 / depth, (1 + mirror_ * along) / (depth * depth));
    }
    const auto& d = distortion_;
    const double angle = std::atan2(across, along), s = angle * angle;
    const double radial = 1 + s * (d[0] + s * (d[1] + s * (d[2] + s * d[3])));
    const double slope = 1 + s * (3 * d[0] + s * (5 * d[1] + s * (7 * d[2] + s * 9 * d[3])));
    return std::min(std::fabs(slope), across > kSmall ? angle * radial / across : radial);
}

double LensResolution::at(Vec3 direction) const {
    const double squared = direction.y * direction.y + direction.z * direction.z;
    const double across = std::sqrt(squared);
    const double far = std::sqrt(direction.x * direction.x + squared);
    double u = 1, v = 0;
    if (across > 0) {
        u = -direction.y / across;
        v = -direction.z / across;
    }
    if (direction.x <= cos_widest_ * far) return focal_ * unitAt(cos_widest_, sin_widest_, u, v);
    return focal_ * unitAt(direction.x / far, across / far, u, v);
}

double LensResolution::densityAt(Vec3 local) const {
    const double far = std::sqrt(dot(local, local));
    return far > 0 ? at(local) / far : std::numeric_limits<double>::infinity();
}

namespace {

/// Largest value of a smooth function of the directions up to `widest` off the axis, with a margin
/// for those between the samples.
template <typename Function>
double largestOver(double widest, bool is_lopsided, Function function) {
    constexpr int kRings = 256, kBearings = 64;
    constexpr double kMargin = 1.001;
    const int bearings = is_lopsided ? kBearings : 1;
    double largest = 0;
    for (int i = 0; i <= kRings; ++i) {
        const double angle = widest * i / kRings;
        for (int k = 0; k < bearings; ++k) {
            const double bearing = 2 * std::numbers::pi * k / bearings;
            const double sine = std::sin(angle);
            largest = std::max(largest, function(Vec3{std::cos(angle), -sine * std::cos(bearing),
                                                      -sine * std::sin(bearing)}));
        }
    }
    return kMargin * largest;
}

}  // namespace

double LensResolution::farthest(double pixels_per_metre) const {
    return largestOver(
               widest_, is_lopsided_,
               [this](Vec3 way) { return at(way) * (lens_ == Lens::Pinhole ? way.x : 1); }) /
           pixels_per_metre;
}

double LensResolution::most() const {
    return largestOver(widest_, is_lopsided_, [this](Vec3 way) { return at(way); });
}

}  // namespace ispace
