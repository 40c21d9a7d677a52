// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/dilution.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

namespace ispace {

void SpaceInformation::add(Vec3 along, double sigma) {
    const double weight = 1 / (sigma * sigma);
    *this += {weight * along.x * along.x, weight * along.x * along.y, weight * along.x * along.z,
              weight * along.y * along.y, weight * along.y * along.z, weight * along.z * along.z};
}

SpaceInformation& SpaceInformation::operator+=(const SpaceInformation& other) {
    xx += other.xx;
    xy += other.xy;
    xz += other.xz;
    yy += other.yy;
    yz += other.yz;
    zz += other.zz;
    return *this;
}

Vec3 variancesOf(const SpaceInformation& information) {
    constexpr double kOpen = 1e-14;
    const auto& [xx, xy, xz, yy, yz, zz] = information;
    Eigen::Matrix3d matrix;
    matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    std::array<double, 3> result{};
    for (int k = 0; k < 3; ++k) {
        const double value = solver.eigenvalues()[k];
        const bool is_open = value <= kOpen * solver.eigenvalues()[2];
        for (int axis = 0; axis < 3; ++axis) {
            const double share = solver.eigenvectors()(axis, k) * solver.eigenvectors()(axis, k);
            if (!is_open)
                result[static_cast<std::size_t>(axis)] += share / value;
            else if (share > 1e-9)
                result[static_cast<std::size_t>(axis)] = std::numeric_limits<double>::infinity();
        }
    }
    return {result[0], result[1], result[2]};
}

FloorInformation& FloorInformation::operator+=(const FloorInformation& other) {
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
}

double FloorInformation::error() const {
    constexpr double kOpen = 1e-12;  // of the least eigenvalue, as a share of the greatest
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > kOpen * trace() * trace())) return std::numeric_limits<double>::infinity();
    return std::sqrt(trace() / determinant);
}

FloorInformation atKnownHeight(const SpaceInformation& information) {
    return {information.xx, information.xy, information.yy};
}

FloorInformation atAnyHeight(const SpaceInformation& information) {
    const auto& [xx, xy, xz, yy, yz, zz] = information;
    if (!(zz > 0)) return {xx, xy, yy};  // all measurements are level
    return {std::max(0.0, xx - xz * xz / zz), xy - xz * yz / zz, std::max(0.0, yy - yz * yz / zz)};
}

namespace {

/// Standard deviation of an error that is uniform over a width.
double uniformSigma(double width) { return width / std::sqrt(12.0); }

double distanceSigma(const RangeNoise& noise, double range) {
    const auto [s0, s1, s2] = noise.sigma;
    const double sigma = std::max(0.0, s0 + range * (s1 + range * s2));
    return std::max(kMinSigma, std::hypot(sigma, uniformSigma(noise.resolution)));
}

/// Errors of one measurement of a point: of its distance, metres, and of its direction, radians; 0:
/// not measured.
struct SightErrors {
    double distance = 0, direction = 0;
};

double directionSigma(const RangeNoise& noise, double step) {
    return std::hypot(noise.angle_sigma.radians(), uniformSigma(step));
}

SightErrors errorsOf(const Laser& laser, double range) {
    return {distanceSigma(laser.noise, range), directionSigma(laser.noise, laser.step.radians())};
}

SightErrors errorsOf(const Ranger& ranger, double range) {
    const bool is_pinhole = ranger.projection == Projection::Pinhole;
    const double pixel = is_pinhole ? 1 / ranger.fx() : ranger.fov_x.radians() / ranger.columns;
    return {distanceSigma(ranger.noise, range), directionSigma(ranger.noise, pixel)};
}

SightErrors errorsOf(const Radar& radar, double range) {
    return {distanceSigma(radar.noise, range), std::max(directionSigma(radar.noise, 0), kMinSigma)};
}

SightErrors errorsOf(const Camera& camera, double /*range*/) {
    return {0, uniformSigma(1 / camera.fx)};
}

SightErrors errorsOf(const Receiver& receiver, double range) {
    return {distanceSigma(receiver.noise, range), 0};
}

SightErrors errorsOf(const Uwb& uwb, double range) { return {distanceSigma(uwb.noise, range), 0}; }

template <typename Model>
SightErrors errorsOf(const Model& /*model*/, double /*range*/) {
    return {};
}

}  // namespace

SpaceInformation informationOf(const SensorModel& model, Point3 at, Point3 spot) {
    const Vec3 way = spot - at;
    // At the sensor itself the direction is undefined; there it errs as at the least distance.
    const double range = std::max(length(way), kMinSigma);
    const SightErrors errors =
        std::visit([range](const auto& one) { return errorsOf(one, range); }, model);
    SpaceInformation information;
    const Vec3 along = length(way) > 0 ? (1 / length(way)) * way : Vec3{0, 0, -1};
    if (errors.distance > 0) information.add(along, errors.distance);
    if (errors.direction > 0) {
        const double weight = 1 / (range * errors.direction * range * errors.direction);
        const auto& [x, y, z] = along;
        information += {weight * (1 - x * x), -weight * x * y, -weight * x * z,
                        weight * (1 - y * y), -weight * y * z, weight * (1 - z * z)};
    }
    return information;
}

}  // namespace ispace
