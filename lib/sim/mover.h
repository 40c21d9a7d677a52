// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "scene/robot.h"
#include "scene/scene.h"
#include "sim/robot_sensors.h"
#include "sim/sim_time.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Where robots and people are, in the order of the scene.
struct MoverPoses {
    std::vector<Pose2> robots, people;
    std::vector<Angle> swings;  ///< of the people's limbs

    MoverPoses() = default;
    explicit MoverPoses(const Movers& movers);
};

/// Where robots and people were in the last steps, for scans that take longer than one. Before the
/// first of these everything counts as having stood.
///
/// From step to step a carrier goes along an arc and turns evenly, which is how robots move at
/// constant speeds. A trail has a moment for each step, or fewer where memory would run out: some
/// 2^19 bodies are kept.
class PoseHistory {
  public:
    /// \param length of the longest scan, 0: nothing is kept
    explicit PoseHistory(SimTime length = SimTime(0)) : length_(length) {}

    [[nodiscard]] bool isKept() const { return length_ > SimTime(0); }
    /// After a step, or once more after it. \param moved false: all are where they were at the last
    /// call
    void add(SimTime time, const Movers& movers, bool moved);
    /// Nothing is known of the steps before the next one.
    void clear() { entries_.clear(); }
    /// Goes on from that of another scene. `robots` and `people` have for each of this scene's its
    /// index in the other one, or nothing: then it counts as having stood where it is now.
    using Indices = std::span<const std::optional<std::size_t>>;
    void goOn(const PoseHistory& before, Indices robots, Indices people, const MoverPoses& now);

    using SetBodies = std::function<void(const MoverPoses& places, MovingBodies& bodies)>;
    /// Makes the bodies that a walk from this time on asks for, in parallel.
    void makeBodies(SimTime since, const SetBodies& set_bodies);

    /// Moments kept.
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    /// True if nobody has moved since.
    [[nodiscard]] bool isStillSince(SimTime time) const;

    /// Goes from moment to moment, from a beginning on: a leg begins behind one, and ends with the
    /// next one. Behind the last moment there is one leg more, without end; who looks there, or
    /// before the first moment, finds all standing.
    class Walk {
      public:
        /// \pre the trail is not empty
        Walk(const PoseHistory& trail, SimTime begin);
        /// Goes on to the leg of some seconds after the beginning. \pre not before those of the
        /// last call
        void to(double later);
        /// Seconds after the beginning when the leg ends.
        [[nodiscard]] double end() const;
        /// The share of the leg that is over some seconds after the beginning: first + later *
        /// rate.
        struct Share {
            double first = 0, rate = 0;
            [[nodiscard]] double at(double later) const { return first + later * rate; }
        };
        [[nodiscard]] Share share() const;
        /// Where the leg begins and ends.
        [[nodiscard]] const MoverPoses& from() const { return placesAt(before_); }
        [[nodiscard]] const MoverPoses& to() const { return placesAt(last()); }
        /// The bodies of the nearest moment, for a share of the leg. \pre they are made
        [[nodiscard]] const MovingBodies& bodies(double share) const;

      private:
        [[nodiscard]] double secondsTo(std::size_t entry) const;
        [[nodiscard]] const MoverPoses& placesAt(std::size_t entry) const {
            return trail_->entries_[entry].moment->places;
        }
        [[nodiscard]] std::size_t last() const {
            return after_ < trail_->entries_.size() ? after_ : before_;
        }

        const PoseHistory* trail_;
        SimTime begin_;
        std::size_t before_ = 0, after_ = 0;  // entries
    };

  private:
    struct Moment {
        MoverPoses places;
        MovingBodies bodies = {};
        bool has_bodies = false;
    };
    struct Entry {
        SimTime time;
        std::shared_ptr<Moment> moment;  // the same until somebody moves
    };

    SimTime length_;
    std::deque<Entry> entries_;
};

/// Somebody in a scene that moves: a robot, or a person, who moves as a robot does.
struct Mover {
    std::string id;
    RobotModel model;
    Pose2 pose;  ///< at the start
    MotionPlan course;
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
