// SPDX-License-Identifier: GPL-3.0-or-later
// How fixed lasers stand to each other, by people or robots that pass them: no plan, no marks.
//
// Poses are in the frame of the layout, of which the first laser's pose is taken as true;
// covariances are those of x and y along the axes of the room (metres) and of the heading
// (radians), at the scatter of the residuals. Heights, tilts and rolls are not estimated. At most
// 64 lasers. Random draws have a fixed seed: equal scans give equal poses.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "extensions/calibration/plan_fit.h"
#include "scene/sensor/sensor.h"

namespace ispace::calibration {

/// A fixed level laser and its scans in the order of time.
struct WatchingLaser {
    Sensor sensor;
    std::vector<double> times;  ///< seconds, of the first beam of each scan
    std::vector<std::vector<float>> scans;
};

/// What moves before the lasers: its level cut is one disc, or two legs of people.
struct BodyTarget {
    double radius = 0;  ///< of a robot, roughly; metres. 0: people
    [[nodiscard]] bool isPerson() const { return radius == 0; }
};

/// Poses of lasers to each other, by the bodies that they see.
struct BodyFit {
    std::vector<Pose3> poses;  ///< of each laser; that of the first one stays
    /// Of each pose relative to the first one; zero for that one.
    std::vector<PlanCovariance> covariances;
    double radius = 0, radius_sigma = 0;  ///< of the disc; metres
    double height = 0, height_sigma = 0;  ///< of people, by the radius of their legs; metres
    std::size_t moments = 0;              ///< at which two or more lasers see one leg
    std::vector<std::size_t> legs;        ///< discs seen by each laser, and by another one
    double scatter = 0;  ///< residuals by their standard deviations: 1 if the model holds
};

/// Estimates how fixed lasers stand to each other, without a plan, by people walking through their
/// fields of view, or by round robots that drive there: by maximum likelihood over the outline of
/// the body that this library simulates (humanParts(): the level cut of a leg is a disc); its size
/// is estimated as well.
///
/// A beam is on a person if it is clearly shorter than the densest half of its ranges. A disc is
/// fitted to the beams on a leg, and its likelihood is taken as normal about the best centre; where
/// the leg really stood is eliminated. The legs are moved to one time by their speed if the lasers
/// measure at different times. The start needs no pose: it is the rigid motion on which most of the
/// ways agree (RANSAC). Lasers at different heights are compared by the middle of both legs, as
/// legs are slanted while people walk; a robot stands upright.
/// \throws FormatError without a file: fewer than two lasers, a laser above the hips of people or
///         not level, lasers that see no common person, ways that do not determine a pose
BodyFit fitToBodies(std::span<const WatchingLaser> lasers, BodyTarget target = {});

/// Where a laser saw the middle of both legs of a person, in the room.
struct SeenPerson {
    double time = 0;  ///< seconds
    Point2 place;
};
/// Returns what lasers at known poses saw, in the order of time. \param height of the people
/// \throws FormatError as fitToBodies() for a laser that sees no legs
std::vector<SeenPerson> peopleSeen(std::span<const WatchingLaser> lasers, double height);
/// Returns where people were at a time: where they were seen shortly before and after it, each
/// person once, by a line through these points.
std::vector<Point2> peopleAt(std::span<const SeenPerson> seen, double time);

}  // namespace ispace::calibration
