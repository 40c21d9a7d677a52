// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geom/pose.h"
#include "sim/floor_sensors.h"
#include "sim/sim_time.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Where robots and people are, in the order of the scene.
struct Places {
    std::vector<Pose2> robots, people;
    std::vector<Angle> swings;  ///< of the people's limbs

    Places() = default;
    explicit Places(const Movers& movers);
};

/// Where robots and people were in the last steps, for scans that take longer than one. Before the
/// first of these everything counts as having stood.
///
/// From step to step a carrier goes along an arc and turns evenly, which is how robots move at
/// constant speeds. A trail has a place for each step, or fewer where memory would run out: some
/// 2^19 bodies are kept.
class Trail {
  public:
    /// \param length of the longest scan, 0: nothing is kept
    explicit Trail(SimTime length = SimTime(0)) : length_(length) {}

    [[nodiscard]] bool isKept() const { return length_ > SimTime(0); }
    /// After a step, or once more after it. \param moved false: all are where they were at the last
    /// call
    void add(SimTime time, const Movers& movers, bool moved, const MovingBodies& bodies);
    /// Nothing is known of the steps before the next one.
    void clear() { entries_.clear(); }
    /// Goes on from that of another scene. `robots` and `people` have for each of this scene's its
    /// index in the other one, or nothing: then it counts as having stood where it is now.
    using Indices = std::span<const std::optional<std::size_t>>;
    using SetBodies = std::function<void(const Places& places, MovingBodies& bodies)>;
    void goOn(const Trail& before, Indices robots, Indices people, const Places& now,
              const SetBodies& set_bodies);

    /// Moments kept.
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    /// True if nobody has moved since.
    [[nodiscard]] bool isStillSince(SimTime time) const;

    /// Looks at moments one after another, from a beginning on.
    class Walk {
      public:
        Walk(const Trail& trail, SimTime begin);
        /// Goes to some seconds after the beginning. \pre not before those of the last call
        void to(double later);
        [[nodiscard]] Pose2 robot(std::size_t index) const;
        [[nodiscard]] Pose2 person(std::size_t index) const;
        /// The bodies of the nearest step. \pre the trail is not empty
        [[nodiscard]] const MovingBodies& bodies() const;

      private:
        [[nodiscard]] double secondsTo(std::size_t entry) const;

        const Trail* trail_;
        SimTime begin_;
        std::size_t before_ = 0, after_ = 0;  // entries
        double share_ = 0;                    // of the way between them
    };

  private:
    struct Moment {
        Places places;
        MovingBodies bodies;
    };
    struct Entry {
        SimTime time;
        std::shared_ptr<const Moment> moment;  // the same until somebody moves
    };

    SimTime length_;
    std::deque<Entry> entries_;
};

/// A share of the way from one pose to another, along an arc.
Pose2 poseBetween(const Pose2& from, const Pose2& to, double share);

}  // namespace ispace
