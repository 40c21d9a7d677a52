// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "env/band.h"
#include "geom/spatial_index.h"
#include "sim/motion.h"

namespace ispace {

/// Metres by which circles may reach into things: touching is allowed, and this much is rounding.
constexpr double kTouch = 1e-9;

/// Least distance of two closed segments, 0 if they share a point; rounds.
double distance(const Segment2& s, const Segment2& t);

/// What stands in the way of circles on the floor: the lines of a band, found through a grid.
/// Thread-safe.
class Obstacles {
  public:
    /// \pre the band's pieces have owners
    explicit Obstacles(const Band& band);

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

}  // namespace ispace
