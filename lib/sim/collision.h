// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/sim only.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "env/slice.h"
#include "geom/spatial_index.h"
#include "layout/robot.h"
#include "layout/scene.h"
#include "sim/motion.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Somebody who stands in the way: a circle on the floor that no robot may reach into.
struct Person {
    std::string_view id;
    Point2 place;
    double radius = 0;  ///< humanRadius
};

/// The people of a scene, in its order. The scene must outlive them.
std::vector<Person> peopleOf(const Scene& scene);

/// Metres by which circles may reach into things: touching is allowed, and this much is rounding.
constexpr double kTouch = 1e-9;

/// Least distance of two closed segments, 0 if they share a point; rounds.
double distance(const Segment2& s, const Segment2& t);

/// What stands in the way of circles on the floor: the lines of a band, found through a grid.
/// Thread-safe.
class Obstacles {
  public:
    /// \pre the band's pieces have owners
    explicit Obstacles(const Slice& band);

    /// An element of Environment::elements() whose line a circle reaches into, or in whose solid it
    /// lies.
    [[nodiscard]] std::optional<std::size_t> overlap(Point2 center, double radius) const;
    /// Distance to the nearest line, `farthest` if none is nearer than that. Costs less the nearer
    /// the line is.
    [[nodiscard]] double nearest(Point2 p, double farthest) const;
    /// True if the way comes nearer than `distance` to a line.
    [[nodiscard]] bool near(const Segment2& way, double distance) const;
    /// An element that stops a circle whose centre goes that way: it reaches into a line, deeper
    /// than at its start. Whoever stands in a line by rounding may leave it.
    [[nodiscard]] std::optional<std::size_t> stop(const Segment2& way, double radius) const;

  private:
    template <typename Test>
    [[nodiscard]] std::optional<std::size_t> find(Point2 p, double reach, Test test) const;

    std::vector<Polygon> solids_;
    std::vector<Box2> boxes_;  // of the solids
    std::vector<Segment2> lines_;
    std::vector<std::size_t> solid_owners_, line_owners_;
    SegmentGrid grid_;
};

/// A robot's step as it proposes it.
struct Move {
    const Motion* from = nullptr;
    const MotionLimits* limits = nullptr;
    double duration = 0;
    double radius = 0;
    Advance to;

    [[nodiscard]] Point2 start() const { return from->pose.position; }
    [[nodiscard]] Point2 end() const { return to.motion.pose.position; }
    [[nodiscard]] Segment2 chord() const { return {start(), end()}; }
    /// Its place after `part` of kParts equal parts of the time.
    static constexpr int kParts = 16;
    [[nodiscard]] Point2 place(int part) const;
    /// Stays where it is, at rest without a goal.
    void cancel();
};

/// The element that the move runs into. Swept along the chord if that is clear by more than the
/// way may bulge, else along the chords of its parts.
std::optional<std::size_t> collides(const Move& move, const Obstacles& obstacles);

/// True if the move runs into another robot that moves at the same time, or stands at its start.
bool collides(const Move& move, const Move& other, bool other_moves);

/// Indices of the robots in the order in which their moves are settled: by the bytes of their ids.
std::vector<std::size_t> settlingOrder(std::span<const PlacedRobot> robots);

/// Finds the robots and people that a move runs into. Robots come first, people behind them.
///
/// A move is tried against the moves of those that are settled before it and against the others
/// where they stand: whatever these do later, no two ever overlap.
class Traffic {
  public:
    /// `order` as of settlingOrder; a step takes `duration` seconds.
    Traffic(std::span<const PlacedRobot> robots, std::span<const Person> people,
            std::span<const std::size_t> order, double duration);

    /// Takes the places at which the moves begin.
    void rebuild(std::span<const Move> moves);
    /// The first one, in the order of settling, that this robot's move runs into.
    /// \pre moves of those before it are settled: cancelled or not
    [[nodiscard]] std::optional<std::size_t> hit(std::span<const Move> moves,
                                                 std::size_t robot) const;

  private:
    std::vector<std::size_t> rank_;  // in the order of settling
    double reach_ = 0;               // of who gets farthest from its place in a step
    std::vector<Point2> places_;
    FloorGrid grid_;
};

/// What robots run into, by their heights.
using ObstacleSets = std::map<double, Obstacles>;
ObstacleSets obstaclesOf(const Scene& scene);

/// \throws FormatError with all findings if a robot stands in something, in another robot or in
///         somebody
void checkStart(const Scene& scene, std::span<const Person> people, const ObstacleSets& obstacles);

}  // namespace ispace
