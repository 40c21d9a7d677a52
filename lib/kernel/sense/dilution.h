// SPDX-License-Identifier: GPL-3.0-or-later
// How errors of measurements become errors of a position: dilution of precision. Information of
// independent measurements adds up; its inverse is the least covariance of an unbiased estimate (C.
// R. Rao, Information and the accuracy attainable in the estimation of statistical parameters,
// 1945). Pure functions, O(1).
//
//     FloorInformation spot;
//     for (const Sensor& sensor : scene.sensors)
//         spot += atKnownHeight(informationOf(sensor.model, sensor.pose.position, {4, 3, 0}));
//     const double metres = spot.error();  // root mean square
#pragma once

#include "geom/point.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// The information of independent measurements about a position in space: the inverse of the
/// covariance of its errors, 1/m2.
struct SpaceInformation {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// Adds a measurement of the coordinate along a unit vector. \pre sigma > 0, metres
    void add(Vec3 along, double sigma);
    SpaceInformation& operator+=(const SpaceInformation& other);
};

/// Returns the variances of the three coordinates, m2: the diagonal of the inverse; +infinity along
/// directions that are not determined.
Vec3 variancesOf(const SpaceInformation& information);

/// The information about a position on a level plane, 1/m2.
struct FloorInformation {
    double xx = 0, xy = 0, yy = 0;

    FloorInformation& operator+=(const FloorInformation& other);
    [[nodiscard]] double trace() const { return xx + yy; }
    /// Returns the root mean square distance between measured and true position, metres: at least
    /// 2 / sqrt(trace()), which is reached if the errors are the same in all directions. +infinity
    /// if some direction is not determined.
    [[nodiscard]] double error() const;
};

/// Returns the information about x and y if the height is known.
FloorInformation atKnownHeight(const SpaceInformation& information);
/// Returns the same if the height has to be measured, too.
FloorInformation atAnyHeight(const SpaceInformation& information);

/// Returns the information of one reading about a point that the sensor sees, by the errors of its
/// kind (SensorKind::sight_errors):
/// - lasers, rangers: a distance, by their noise, and the direction;
/// - cameras: the direction;
/// - receivers of tags: the distance.
///
/// Rounding counts as uniform. The depth of a depth camera counts as a distance. Zero for kinds
/// that measure no position.
/// \param at position of the sensor; its heading does not matter
SpaceInformation informationOf(const SensorModel& model, Point3 at, Point3 spot);

}  // namespace ispace
