// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "base/number.h"
#include "scene/sensor/lens_resolution.h"
#include "scene/sensor/plumb_bob.h"

namespace ispace {

namespace {

/// A pinhole's picture plane ends here.
constexpr double kMaxPinhole = 89.9 * std::numbers::pi / 180;

/// Maps an angle off the axis, in radians, to the distance from the centre of the picture plane
/// over the focal length; radial distortion alone.
double radiusOf(const Camera& camera, double angle) {
    const auto& d = camera.distortion;
    const double square = angle * angle;
    switch (camera.lens) {
        case Lens::Pinhole: {
            const double r = std::tan(angle), s = r * r;
            return r * (1 + s * (d[0] + s * (d[1] + s * d[4])));
        }
        case Lens::Fisheye:
            return angle *
                   (1 + square * (d[0] + square * (d[1] + square * (d[2] + square * d[3]))));
        case Lens::Mirror:
            return std::sin(angle) / (std::cos(angle) + camera.mirror);
    }
    return 0;
}

/// Finds the angle, in radians, beyond which the picture of a ray moves back towards the centre.
double turningAngle(const Camera& camera) {
    double end = std::numbers::pi;
    if (camera.lens == Lens::Pinhole) end = kMaxPinhole;
    if (camera.lens == Lens::Mirror)
        // The sphere's ray leaves the plane, or touches the sphere.
        end = std::acos(-std::min(camera.mirror, 1 / std::max(camera.mirror, 1e-9))) - 1e-6;
    constexpr int kSteps = 2048;
    const auto rises = [&](double angle) {
        constexpr double kSmall = 1e-7;
        return radiusOf(camera, angle + kSmall) > radiusOf(camera, angle);
    };
    for (int i = 1; i < kSteps; ++i) {
        if (rises(end * i / kSteps)) continue;
        double low = end * (i - 1) / kSteps, high = end * i / kSteps;
        for (int halving = 0; halving < 30; ++halving) {
            const double middle = (low + high) / 2;
            (rises(middle) ? low : high) = middle;
        }
        return low;
    }
    return end;
}

/// Finds the angle off the axis, in radians, of a radius: of a mirror in closed form (C. Mei,
/// P. Rives, Single view point omnidirectional camera calibration from planar grids, 2007), else by
/// Newton's method in a bracket, which halves where a step leaves it. \pre radius is 0 or more
std::optional<double> angleOf(const Camera& camera, double radius) {
    double low = 0, high = camera.widest.radians();
    if (radius > radiusOf(camera, high)) return std::nullopt;
    if (camera.lens == Lens::Mirror) {
        const double square = radius * radius, xi = camera.mirror;
        const double scale = (xi + std::sqrt(1 + (1 - xi * xi) * square)) / (1 + square);
        return std::atan2(scale * radius, scale - xi);
    }
    // Newton's method, within a shrinking bracket.
    double angle = std::min(radius, high);
    for (int i = 0; i < 60; ++i) {
        const double value = radiusOf(camera, angle) - radius;
        if (value == 0) return angle;
        (value > 0 ? high : low) = angle;
        constexpr double kSmall = 1e-6;
        const double slope =
            (radiusOf(camera, angle + kSmall) - radiusOf(camera, angle - kSmall)) / (2 * kSmall);
        double next = angle - value / slope;
        if (!(next > low && next < high)) next = (low + high) / 2;
        if (std::fabs(next - angle) <= 1e-16 * (1 + angle)) return next;
        angle = next;
    }
    return angle;
}

/// Applies `plumb_bob` to a point of the plane x = 1.
Vec2 bent(const std::array<double, 5>& d, Vec2 p) {
    const auto [x, y] = plumbBob(d, p.x, p.y);
    return {x, y};
}

/// Inverts bent() by Newton's method with the exact derivatives, to 1e-14 of the radius, or in 50
/// steps to 1e-9; empty if it does not converge, or beyond a radius of `most`.
std::optional<Vec2> unbent(const std::array<double, 5>& d, Vec2 to, double most) {
    Vec2 p = to;
    const double radius = std::hypot(p.x, p.y);
    if (radius > most) p = (most / radius) * p;
    for (int i = 0; i < 50; ++i) {
        const Vec2 off = bent(d, p) - to;
        if (std::hypot(off.x, off.y) < 1e-14 * (1 + radius))
            return std::hypot(p.x, p.y) <= most * (1 + 1e-9) ? std::optional(p) : std::nullopt;
        const PlumbBobSlope slope(d, p);
        const double det = slope.xx * slope.yy - slope.xy * slope.xy;
        if (!(std::fabs(det) > 1e-12)) return std::nullopt;
        Vec2 step = {(off.x * slope.yy - off.y * slope.xy) / det,
                     (slope.xx * off.y - slope.xy * off.x) / det};
        const double size = std::hypot(step.x, step.y), bound = 0.5 * (1 + std::hypot(p.x, p.y));
        if (size > bound) step = (bound / size) * step;
        p = p - step;
    }
    const Vec2 off = bent(d, p) - to;
    const bool there = std::hypot(off.x, off.y) < 1e-9 && std::hypot(p.x, p.y) <= most;
    return there ? std::optional(p) : std::nullopt;
}

}  // namespace

Camera::Camera() {
    fx = fy = focalFor(columns, Angle::degrees(45));
    center();
    widest = Angle::radians(kMaxPinhole);
}

void Camera::center() {
    cx = (columns - 1) / 2.0;
    cy = (rows - 1) / 2.0;
}

double Camera::focalFor(double side, Angle fov) const {
    return side / 2 / radiusOf(*this, fov.radians() / 2);
}

Angle Camera::turningAngle() const { return Angle::radians(ispace::turningAngle(*this)); }

std::optional<Vec3> Camera::ray(PixelPoint place) const {
    const Vec2 p{(place.column - cx) / fx, (place.row - cy) / fy};
    if (lens == Lens::Pinhole) {
        const double most = tan(widest);
        const auto flat = isDistorted() ? unbent(distortion, p, most) : std::optional(p);
        if (!flat || std::hypot(flat->x, flat->y) > most) return std::nullopt;
        return (1 / std::sqrt(1 + flat->x * flat->x + flat->y * flat->y)) *
               Vec3{1, -flat->x, -flat->y};
    }
    const double radius = std::hypot(p.x, p.y);
    if (radius == 0) return Vec3{1, 0, 0};
    const auto angle = angleOf(*this, radius);
    if (!angle) return std::nullopt;
    const double s = std::sin(*angle) / radius;
    return Vec3{std::cos(*angle), -s * p.x, -s * p.y};
}

namespace {

/// Returns true for directions at most `widest` off the axis of a pinhole, without their angle.
bool isWithinPinhole(Angle widest, Vec3 direction) {
    if (!(direction.x > 0)) return false;
    constexpr Angle kDiagonal = Angle::degrees(45);
    const double across = direction.y * direction.y + direction.z * direction.z;
    const double along = direction.x * direction.x;
    if (across <= along && widest >= kDiagonal) return true;
    const double steepest = tan(widest);
    return across <= steepest * steepest * along;
}

}  // namespace

std::optional<PixelPoint> Camera::project(Vec3 direction) const {
    if (direction.y == 0 && direction.z == 0)
        return direction.x >= 0 ? std::optional(PixelPoint{cx, cy}) : std::nullopt;
    Vec2 p;
    if (lens == Lens::Pinhole) {
        if (!isWithinPinhole(widest, direction)) return std::nullopt;
        p = {-direction.y / direction.x, -direction.z / direction.x};
        if (isDistorted()) p = bent(distortion, p);
    } else {
        const double across = std::hypot(direction.y, direction.z);
        const double angle = std::atan2(across, direction.x);
        if (angle > widest.radians()) return std::nullopt;
        const double s = radiusOf(*this, angle) / across;
        p = {-s * direction.y, -s * direction.z};
    }
    return PixelPoint{cx + fx * p.x, cy + fy * p.y};
}

namespace {

Angle angleBetween(const Camera& camera, PixelPoint a, PixelPoint b) {
    const auto off = [&](PixelPoint p) {
        const auto ray = camera.ray(p);
        return ray ? std::atan2(std::hypot(ray->y, ray->z), ray->x) : camera.widest.radians();
    };
    return Angle::radians(off(a) + off(b));
}

}  // namespace

Angle Camera::fovX() const { return angleBetween(*this, {-0.5, cy}, {columns - 0.5, cy}); }
Angle Camera::fovY() const { return angleBetween(*this, {cx, -0.5}, {cx, rows - 0.5}); }

Angle Camera::widestInPicture() const {
    // The farthest point is a corner, except for the tangential terms of distortion.
    constexpr double kSlack = 1.01;
    double most = 0;
    for (const double column : {-0.5, columns - 0.5})
        for (const double row : {-0.5, rows - 0.5}) {
            const auto corner = ray({column, row});
            if (!corner) return widest;
            most = std::max(most, std::hypot(corner->y, corner->z) / corner->x);
            if (!(corner->x > 0)) return widest;
        }
    return std::min(widest, Angle::radians(std::atan(kSlack * most)));
}

bool Camera::fillsPicture() const {
    constexpr int kSteps = 256;
    for (int i = 0; i <= kSteps; ++i) {
        const double share = static_cast<double>(i) / kSteps;
        const double column = share * columns - 0.5, row = share * rows - 0.5;
        for (const PixelPoint place :
             {PixelPoint{column, -0.5}, {column, rows - 0.5}, {-0.5, row}, {columns - 0.5, row}})
            if (!ray(place)) return false;
    }
    return true;
}

bool Camera::isOmnidirectional(const Pose3& mount) const {
    if (lens == Lens::Pinhole || fx != fy) return false;
    const double radius = fx * radiusOf(*this, widest.radians()) * (1 - 1e-9);
    const bool whole = holds({cx - radius, cy}) && holds({cx + radius, cy}) &&
                       holds({cx, cy - radius}) && holds({cx, cy + radius});
    return whole && std::fabs(mount.tilt.degrees()) == 90;
}
std::span<const PixelDensity> pixelDensities() {
    static constexpr std::array<PixelDensity, 6> kClasses = {{{"monitor", 12.5},
                                                              {"detect", 25},
                                                              {"observe", 62.5},
                                                              {"recognise", 125},
                                                              {"identify", 250},
                                                              {"inspect", 1000}}};
    return kClasses;
}

std::span<const PixelDensity> pixelLevels() {
    static constexpr std::array<PixelDensity, 7> kLevels = {{{"overview", 20},
                                                             {"outline", 40},
                                                             {"discern", 80},
                                                             {"perceive", 125},
                                                             {"characterise", 250},
                                                             {"validate", 500},
                                                             {"scrutinise", 1500}}};
    return kLevels;
}

std::optional<double> pixelDensityOf(std::string_view text) {
    const std::string name = text.ends_with("ize")
                                 ? std::string(text.substr(0, text.size() - 3)) + "ise"
                                 : std::string(text);
    for (const auto& names : {pixelDensities(), pixelLevels()})
        for (const PixelDensity& density : names)
            if (density.name == name) return density.pixels_per_metre;
    const auto number = parseDouble(text);
    return number && *number > 0 && std::isfinite(*number) ? number : std::nullopt;
}

Camera withDensity(Camera camera, double pixels_per_metre) {
    if (!(pixels_per_metre > 0)) return camera;
    if (LensResolution::isEven(camera)) {
        const double focal = std::min(camera.fx, camera.fy);
        camera.max_range = std::min(camera.max_range, focal / pixels_per_metre);
        return camera;
    }
    camera.least_density = std::max(camera.least_density, pixels_per_metre);
    camera.max_range =
        std::min(camera.max_range, LensResolution(camera).farthest(pixels_per_metre));
    return camera;
}

FieldOfView fieldOfView(const Camera& camera, const Pose3& pose) {
    if (!camera.isStraight()) return FieldOfView::picture(pose, camera);
    const double left = (camera.cx + 0.5) / camera.fx, up = (camera.cy + 0.5) / camera.fy;
    return FieldOfView::pyramid(
        pose, {left, camera.columns / camera.fx - left, up, camera.rows / camera.fy - up},
        camera.max_range, true);
}

}  // namespace ispace
