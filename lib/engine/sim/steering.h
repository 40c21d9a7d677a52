// SPDX-License-Identifier: GPL-3.0-or-later
// Free headings for autonomous movers.
//
// Eleven headings about the desired one are tested, right before left. Other movers are circles
// that keep their velocities (P. Fiorini, Z. Shiller, Motion planning in dynamic environments using
// velocity obstacles, 1998); obstacles are lines. A choice avoids most collisions; World cancels
// the moves that still collide.
//
// Tests by lanes of vectors, strips and memories of earlier choices come first and decide only
// where rounding cannot matter; in doubt the exact test follows. They save time and change no
// choice.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/collision.h"
#include "sim/motion.h"
#include "sim/mover.h"
#include "sim/sim_time.h"

namespace ispace {

/// The movers of a small world, which one thread steps: traffic is only built if some are near each
/// other.
class FewMovers {
  public:
    /// \pre all outlive the queries
    void set(Traffic& traffic, std::span<const Mover> movers, std::span<const Motion> motions);
    /// Returns the traffic, built, if two of the movers are within `reach` of p; else null.
    [[nodiscard]] const Traffic* about(Point2 p, double reach);
    /// Returns upper bounds of their speeds and radii.
    [[nodiscard]] double fastest() const { return fastest_; }
    [[nodiscard]] double widest() const { return widest_; }

  private:
    Traffic* traffic_ = nullptr;
    std::span<const Motion> motions_;
    bool is_built_ = false;
    double fastest_ = 0, widest_ = 0;
    std::vector<double> x_, y_;  // in lanes
};

/// All movers at one moment, and the obstacles around them.
struct Surroundings {
    std::span<const Mover> movers;
    std::span<const Motion> motions;
    const Traffic* traffic = nullptr;  ///< built for that moment; not used with `few`
    FewMovers* few = nullptr;
};

/// An index of obstacles for worlds that look at the same ones often. Results do not depend on it.
class ObstacleIndex {
  public:
    ObstacleIndex() = default;
    ObstacleIndex(const ObstacleIndex&) = default;
    ObstacleIndex& operator=(const ObstacleIndex&) = default;
    virtual ~ObstacleIndex() = default;
    enum class Outlook { Clear, Blocked, Unknown };
    /// Returns Clear only if no obstacle comes nearer to the way than `reach`, and Blocked only if
    /// one does although none is as near to its beginning.
    [[nodiscard]] virtual Outlook look(const Segment2& way, double reach) const = 0;
    /// Replaces `lines` by those whose bounds meet the box, and possibly others, some repeated.
    virtual void findIn(const Box2& box, std::vector<Segment2>& lines) const = 0;

    /// An obstacle as numbers that many tests need.
    struct Line {
        Point2 begin;
        Vec2 along;
        double per_square = 0;  ///< inverse of the squared length, 0 without one
    };
    /// Some of the lines, by index.
    struct Some {
        std::span<const Line> all;
        std::span<const std::uint32_t> which;
    };
    /// Lines nearer than this, metres, are those of near().
    static constexpr double kNear = 1;
    /// Returns the lines nearer to p than kNear, once each, and possibly others; empty if unknown.
    [[nodiscard]] virtual std::optional<Some> near(Point2 p) const = 0;
    /// Returns a distance that no obstacle is nearer to p than; 0 if unknown.
    [[nodiscard]] virtual double least(Point2 p) const = 0;
    /// Returns a distance from p within which an obstacle lies; infinite if unknown.
    [[nodiscard]] virtual double most(Point2 p) const = 0;
};

/// A straight strip of the floor in which the centre of a mover is farther from all obstacles than
/// they are passed.
struct FreeStrip {
    /// Metres that the mover's circle keeps from obstacles there.
    static constexpr double kGap = 0.05;

    Point2 begin;
    Vec2 along{1, 0};    ///< unit vector
    double length = -1;  ///< none: below 0
    double half_width = 0;

    [[nodiscard]] bool contains(Point2 p) const {
        const Vec2 way = p - begin;
        const double ahead = dot(along, way);
        return ahead >= -kEnd && ahead <= length && std::abs(cross(along, way)) <= half_width;
    }
    [[nodiscard]] bool contains(const Segment2& way) const {
        return contains(way.a) && contains(way.b);
    }
    /// The beginning lies in the strip, rounded in any way.
    static constexpr double kEnd = 1e-7;
};

/// Findings of the last choices of a mover among the same obstacles, by which the next ones take
/// less time. Results do not depend on it.
struct SteeringMemory {
    FreeStrip strip;
    ObstacleIndex::Line wall;  ///< that blocked the way ahead
    bool has_wall = false;
    Angle heading;       ///< that was desired
    Vec2 forward{1, 0};  ///< along it
    double nearest = 0;  ///< no obstacle is nearer to where the mover stands; 0 if unknown
};

/// Pose and surroundings of a mover that is steered.
struct SteeringState {
    const Surroundings* around = nullptr;
    const Obstacles* obstacles = nullptr;
    Vicinity* vicinity = nullptr;  ///< of the mover, among these obstacles
    std::size_t mover = 0;
    double clearance = 0;  ///< no obstacle is nearer to the mover's circle
    SimTime time{}, step{};
    const ObstacleIndex* index = nullptr;  ///< of the obstacles; may be null
    SteeringMemory* memory = nullptr;      ///< of the mover, for an index; may be null
};

/// Lines relative to a mover, in lanes of equal length.
struct LineLanes {
    static constexpr std::size_t kLanes = 8, kMost = 6 * kLanes;
    using Lane = std::array<double, kMost>;

    Lane ax, ay, dx, dy;    ///< beginning and extent
    Lane per_square;        ///< inverse of the squared length
    Lane reach_square;      ///< of the distance at which a way comes near
    std::size_t count = 0;  ///< a multiple of kLanes: the last ones are points far away
};

/// A direction, and the seconds for which it is free.
struct FreeHeading {
    Angle direction;
    double time = 0;
};

/// Finds free headings for one mover at one moment: obstacles stand still, other movers keep their
/// velocities (velocity obstacles; Fiorini and Shiller, Motion Planning in Dynamic Environments
/// Using Velocity Obstacles, 1998). An obstacle or mover that is already closer than allowed blocks
/// only headings that lead nearer to it.
class Steering {
  public:
    /// Computes the free headings as far as the mover gets in `horizon` seconds at `speed`.
    /// \pre the state outlives it
    Steering(const SteeringState& helm, double speed, double horizon);

    /// Returns the seconds until an obstacle or a mover blocks the direction, at most `horizon`;
    /// for obstacles in steps of a half, a quarter, an eighth of it.
    [[nodiscard]] double freeTime(Angle direction) const;
    /// Returns the desired direction if it is free for `needed` seconds; else the nearest one that
    /// is, up to slightly more than 90 degrees; else the one that is free longest, with a penalty
    /// for its angle. A mover that turns aside to pass another turns back in time: obstacles count
    /// for a quarter of the horizon there. Of left and right it chooses right, so that two movers
    /// that meet pass each other.
    [[nodiscard]] FreeHeading choose(Angle desired, double needed) const;
    /// Returns true if obstacles and movers, as they stand now, leave a straight way free up to its
    /// end, which may be nearer to obstacles than others are passed. \pre it is not longer than the
    /// way of the horizon
    [[nodiscard]] bool isFree(Vec2 way) const;

  private:
    struct Neighbour {
        double x, y;  // offset
        double x_velocity, y_velocity;
        double reach;  // of both circles and the gap
    };
    struct Line {
        Segment2 line;
        double reach;
    };
    /// A heading, and its velocity.
    struct Course {
        Angle direction;
        Vec2 velocity;
        bool is_exact = true;  // else it deviates by rounding
    };
    /// Usual number of neighbours.
    static constexpr std::size_t kUsualNeighbours = 16;

    void findNeighbours(const Surroundings& around, std::size_t mover);
    [[nodiscard]] std::span<const Neighbour> neighbours() const {
        return many_.empty() ? std::span(few_).first(count_) : std::span(many_);
    }
    [[nodiscard]] Course courseTo(Angle direction) const;
    [[nodiscard]] Course courseTo(Angle desired, Vec2 forward, std::size_t turn) const;
    [[nodiscard]] Vec2 forwardOf(Angle desired) const;
    void findLines() const;
    [[nodiscard]] double usualReach() const;
    [[nodiscard]] bool isApart() const;
    [[nodiscard]] std::optional<double> fillAt(Point2 p, LineLanes& lanes) const;
    [[nodiscard]] bool fillHere() const;
    [[nodiscard]] double freeAhead(Vec2 along, double most) const;
    [[nodiscard]] std::optional<bool> isFreeByMemory(Vec2 way, double share) const;
    [[nodiscard]] std::optional<bool> isFreeByLanes(Vec2 way, double share) const;
    [[nodiscard]] double untilNeighbour(Vec2 velocity) const;
    [[nodiscard]] double untilLine(const Course& course, double most, double needed) const;
    [[nodiscard]] bool isFreeOfLines(const Course& course, double share) const;
    [[nodiscard]] bool isFreeByIndex(const Segment2& way) const;

    Point2 place_;
    double radius_, speed_, horizon_;
    std::array<Neighbour, kUsualNeighbours> few_;
    std::size_t count_ = 0;        // of these
    std::vector<Neighbour> many_;  // all of them, if they are more
    const SteeringState* helm_;
    mutable std::vector<Line> lines_;
    mutable bool has_lines_ = false;        // lines_ are found
    mutable std::vector<Segment2> nearby_;  // of an index, for one way
    mutable bool has_lanes_ = false;        // fillHere() was called
    mutable bool are_in_lanes_ = false;     // its result
    mutable double known_ = 0;              // nearer lines are in the lanes
    mutable double nearest_ = -1;           // no line is nearer; unknown below 0
    mutable LineLanes lanes_;
};

}  // namespace ispace
