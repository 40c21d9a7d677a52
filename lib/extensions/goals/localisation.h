// SPDX-License-Identifier: GPL-3.0-or-later
// The error with which sensors localise a tag or a person.
//
// Each sensor that sees a spot adds its Fisher information about the position (receivers of a tag
// and anchors only if enough of them hear it, see SpotInformation); the inverse of the
// sum bounds the covariance of any unbiased estimate (the Cramer-Rao bound: S. M. Kay, Fundamentals
// of Statistical Signal Processing: Estimation Theory, 1993). The error is the root of the trace,
// metres. It assumes independent errors of readings, by the noise of each model.
//
//     const Localisation result = localise(scene, coverage, 0.5);
//     const double half = result.median.value_or(0.5);  // not exceeded on half of the floor
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "coverage/coverage.h"
#include "scene/scene.h"
#include "sense/dilution.h"

namespace ispace::goals {

/// The information of all sensors about one spot of the floor.
struct SpotInformation {
    FloorInformation seen;   ///< of sensors that know the height of the plane
    SpaceInformation heard;  ///< of receivers of a tag at any height
    std::size_t receivers = 0;
    FloorInformation ranged;  ///< of anchors, which locate a tag on the plane together
    std::size_t anchors = 0;
    std::size_t needed_anchors = 0;  ///< SensorKind::locates_together; 0 without anchors

    /// Adds a sensor that sees the spot. \param information informationOf() of it and the spot
    void add(const Sensor& sensor, const SpaceInformation& information);
    /// Returns the root mean square error of the position, metres; +infinity if it is not
    /// determined. Receivers count from kMinReceivers on, anchors from needed_anchors on, as in
    /// readings.
    [[nodiscard]] double error() const;
};

/// Returns the point of which a sensor measures the position: in its slice for a laser that scans
/// one, else on the plane.
Point3 spotFor(const Sensor& sensor, Point2 at, double plane);

/// Limits of the error that counts at most, metres.
constexpr double kMinErrorLimit = 0.001, kMaxErrorLimit = 1000;

/// Errors of positions over the indoor floor, by cells.
struct Localisation {
    double within = 0;  ///< metres: larger errors, and spots without a position, count as this
    std::vector<double> errors = {};  ///< by cell, metres; +infinity: no position
    /// Shares of the floor with a position, and with one to `within`; empty without cells.
    std::optional<double> localised = {}, share_within = {};
    std::optional<double> mean = {};  ///< of the errors, none above `within`
    /// Error that half, and 95 %, of the floor do not exceed; empty if fewer have a position.
    std::optional<double> median = {}, most = {};
};

/// Computes the errors at the cells' centres from the sensors that see them: the inverse of the sum
/// of their information (the Cramer-Rao bound of unbiased estimates), one reading of each. Bodies
/// have no extent. Sensors of other storeys, whose views have no sensor in `scene`, do not count.
/// Deterministic for any number of threads. O(cells seen)
Localisation localise(const Scene& scene, const Coverage& coverage, double within);
/// Returns the figures over the indoor floor of several rooms, each cell by its area; without
/// errors by cell. \param rooms results of localise() with the same limit \pre as many coverages
Localisation localisedOver(std::span<const Localisation> rooms,
                           std::span<const Coverage> coverages);

}  // namespace ispace::goals
