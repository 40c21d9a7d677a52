// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "extensions/calibration/plan_fit.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// A fixed level laser and its scans in the order of time.
struct WatchingLaser {
    Sensor sensor;
    std::vector<double> times;  ///< seconds, of the first beam of each scan
    std::vector<std::vector<float>> scans;
};

/// Poses of lasers to each other, by the people that they see.
struct BodyFit {
    std::vector<Pose3> poses;  ///< of each laser; that of the first one stays
    /// Of each pose relative to the first one; zero for that one.
    std::vector<PlanCovariance> covariances;
    double height = 0, height_sigma = 0;  ///< of the people, by the radius of their legs; metres
    std::size_t moments = 0;              ///< at which two or more lasers see one leg
    std::vector<std::size_t> legs;        ///< seen by each laser, and by another one
    double scatter = 0;  ///< residuals by their standard deviations: 1 if the model holds
};

/// Estimates how fixed lasers stand to each other, without a plan, by people walking through their
/// fields of view: by maximum likelihood over the outline of the body that this library simulates
/// (humanParts(): the level cut of a leg is a disc); its size is estimated as well.
///
/// A beam is on a person if it is clearly shorter than the densest half of its ranges. A disc is
/// fitted to the beams on a leg, and its likelihood is taken as normal about the best centre; where
/// the leg really stood is eliminated. The legs are moved to one time by their speed if the lasers
/// measure at different times. The start needs no pose: it is the rigid motion on which most of the
/// ways agree (RANSAC). Lasers at different heights are compared by the middle of both legs, as
/// legs are slanted while people walk.
/// \throws FormatError without a file: fewer than two lasers, a laser above the hips of people or
///         not level, lasers that see no common person, ways that do not determine a pose
BodyFit fitToBodies(std::span<const WatchingLaser> lasers);

}  // namespace ispace
