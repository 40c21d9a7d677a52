// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/dilution.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scene/sensor/sensor_keys.h"

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

SpaceInformation informationOf(const SensorModel& model, Point3 at, Point3 spot) {
    const Vec3 way = spot - at;
    // At the sensor itself the direction is undefined; there it errs as at the least distance.
    const double range = std::max(length(way), kMinSigma);
    SpaceInformation information;
    const SensorKind& kind = kindOf(model);
    if (kind.sight_errors == nullptr) return information;
    const SightErrors errors = kind.sight_errors(model, range);
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
