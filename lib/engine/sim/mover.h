// SPDX-License-Identifier: GPL-3.0-or-later
// Movers: robots and people, which are modelled as robots, and the trail of their poses.
//
// A scan of a spinning laser takes longer than a step, so the poses of all movers are kept for as
// long as the longest scan lasts.
//
//     const std::vector<Mover> movers = moversOf(scene);
//     PoseHistory trail(std::chrono::milliseconds(100));
//     trail.add(time, where, true);                     // Movers after a step
//     PoseHistory::Walk walk(trail, time - std::chrono::milliseconds(25));
//     walk.to(0.01);                                    // 10 ms later: walk.from(), walk.to()
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"
#include "scene/robot.h"
#include "scene/scene.h"
#include "sim/robot_sensors.h"
#include "sim/sim_time.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Poses of robots and people, in the order of the scene.
struct MoverPoses {
    std::vector<Pose2> robots, people;
    std::vector<Angle> swings;  ///< of the people's limbs

    MoverPoses() = default;
    explicit MoverPoses(const Movers& movers);
};

/// Poses of robots and people in the last steps, for scans that take longer than one step. Before
/// the first of these all movers count as having stood still.
///
/// Between steps a carrier follows an arc and turns at a constant rate, which is how robots move at
/// constant speeds. A trail holds a moment for each step, or fewer to bound memory: about 2^19
/// bodies are kept.
class PoseHistory {
  public:
    /// \param length of the longest scan; 0: no poses are stored
    explicit PoseHistory(SimTime length = SimTime(0)) : length_(length) {}

    [[nodiscard]] bool isKept() const { return length_ > SimTime(0); }
    /// Stores the poses after a step; may be repeated after the same step. \param moved false: no
    /// mover has moved since the last call
    void add(SimTime time, const Movers& movers, bool moved);
    /// Removes all moments.
    void clear() { entries_.clear(); }
    /// Continues the trail of another scene. `robots` and `people` map each mover of this scene to
    /// its index in the other one; an empty index counts as having stood at its current pose.
    using Indices = std::span<const std::optional<std::size_t>>;
    void goOn(const PoseHistory& before, Indices robots, Indices people, const MoverPoses& now);

    using SetBodies = std::function<void(const MoverPoses& places, MovingBodies& bodies)>;
    /// Builds the bodies that a walk from this time on requires, in parallel.
    void makeBodies(SimTime since, const SetBodies& set_bodies);

    /// Returns the number of stored moments.
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    /// Returns true if no mover has moved since.
    [[nodiscard]] bool isStillSince(SimTime time) const;

    /// Iterates over the moments after a beginning: a leg begins at one and ends at the next. After
    /// the last moment there is one more leg, without end; there, and before the first moment, all
    /// movers stand still.
    class Walk {
      public:
        /// \pre the trail is not empty
        Walk(const PoseHistory& trail, SimTime begin);
        /// Advances to the leg that holds this time, in seconds after the beginning. \pre not
        /// before that of the last call
        void to(double later);
        /// Returns the end of the leg in seconds after the beginning.
        [[nodiscard]] double end() const;
        /// Maps seconds after the beginning to the share of the leg that is over: first + later *
        /// rate.
        struct Share {
            double first = 0, rate = 0;
            [[nodiscard]] double at(double later) const { return first + later * rate; }
        };
        [[nodiscard]] Share share() const;
        /// Poses at the start and the end of the leg.
        [[nodiscard]] const MoverPoses& from() const { return placesAt(before_); }
        [[nodiscard]] const MoverPoses& to() const { return placesAt(last()); }
        /// Returns the bodies of the moment nearest to a share of the leg. \pre makeBodies() built
        /// them
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
        std::size_t before_ = 0, after_ = 0;  // indices of entries
    };

  private:
    struct Moment {
        MoverPoses places;
        MovingBodies bodies = {};
        bool has_bodies = false;
    };
    struct Entry {
        SimTime time;
        std::shared_ptr<Moment> moment;  // the same until a mover moves
    };

    SimTime length_;
    std::deque<Entry> entries_;
};

/// A robot of a scene, or a person, modelled as a robot.
struct Mover {
    std::string id;
    RobotModel model;
    Pose2 pose;  ///< at the start
    MotionPlan course;
    SourcePosition place;  ///< of the record, for messages
    bool is_person = false;
    std::shared_ptr<const PersonFigure> figure = {};  ///< of a person, null for the usual one

    /// Returns the reason why a person does not walk, "sits"; "" if it does.
    [[nodiscard]] std::string_view rest() const;
};

/// Returns the robots of a scene in its order, followed by its people.
std::vector<Mover> moversOf(const Scene& scene);

/// Returns the robot model of a person; its radius is humanRadius().
///
/// A person reaches her speed in half a second and goes at most 1.3 times as fast (relaxation time
/// and limit of Helbing and Molnar, Social Force Model for Pedestrian Dynamics, 1995); she turns
/// about within a second and a half, and steps sideways at half her speed.
RobotModel modelOf(const PlacedPerson& person);

/// A person's gait. The limbs swing by up to kMaxSwingDegrees to either side, and by less below 0.5
/// m/s, so that steps get shorter and not slower. A stride is as long as its two steps.
class Gait {
  public:
    /// Share of the stride in [0, 1); the left leg is ahead in its first half.
    double phase = 0;

    /// Returns the angle of the left leg ahead of the vertical at a speed, as humanParts takes it.
    [[nodiscard]] Angle swing(double speed) const;
    /// Advances the phase by a way in metres, forward or back, at this speed.
    void walk(double height, double way, double speed);
};

}  // namespace ispace
