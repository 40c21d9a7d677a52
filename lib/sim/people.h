// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geom/pose.h"
#include "layout/robot.h"
#include "layout/scene.h"

namespace ispace {

/// Somebody in a scene that moves: a robot, or a person, who moves as a robot does.
struct Mover {
    std::string id;
    RobotModel model;
    Pose2 pose;  ///< at the start
    Course course;
    Place place;  ///< of the record, for messages
    bool is_person = false;
};

/// The robots of a scene in its order, and its people behind them.
std::vector<Mover> moversOf(const Scene& scene);

/// What a person can do as a robot would: the circle of humanRadius() about her is kept clear.
///
/// She reaches her speed in half a second and goes at most 1.3 times as fast (relaxation time and
/// limit of Helbing and Molnar, Social Force Model for Pedestrian Dynamics, 1995); she turns about
/// within a second and a half, and takes a step sideways at half her speed.
RobotModel modelOf(const PlacedPerson& person);

/// A person's gait. The limbs swing by up to kMaxSwingDegrees to either side; below half a metre a
/// second by less, so that steps get shorter and not slower. A stride is as long as its two steps.
class Gait {
  public:
    /// Share of the stride in [0, 1); the left leg is ahead in its first half.
    double phase = 0;

    /// Angle of the left leg ahead of the vertical at a speed, as humanParts takes it.
    [[nodiscard]] Angle swing(double speed) const;
    /// Goes on by a way in metres, forward or back, at this speed.
    void walk(double height, double way, double speed);
};

}  // namespace ispace
