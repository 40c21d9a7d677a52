// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "env/environment.h"
#include "env/point_location.h"
#include "env/slice.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"
#include "sim/motion.h"
#include "sim/mover.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Metres by which circles may overlap things: touching is allowed, and this absorbs rounding.
constexpr double kTouch = 1e-9;

/// Distance of two closed segments, 0 if they share a point, with rounding errors.
double distance(const Segment2& s, const Segment2& t);

/// Squared distance of a point and a segment, for those who look at many.
inline double squaredDistance(Point2 p, const Segment2& s) {
    const Vec2 along = s.b - s.a, way = p - s.a;
    const double square = dot(along, along);
    const double t = square > 0 ? std::clamp(dot(way, along) / square, 0.0, 1.0) : 0;
    const Vec2 apart = way - t * along;
    return dot(apart, apart);
}

/// Obstacles for circles on the floor: the lines of a band, indexed by a grid.
/// Thread-safe.
class Obstacles {
  public:
    /// \pre the band's pieces have owners
    explicit Obstacles(const Slice& band);
    Obstacles(Obstacles&&) = default;  // the solids stay where they are

    /// An element of Environment::elements() whose line a circle overlaps, or whose solid contains
    /// it.
    [[nodiscard]] std::optional<std::size_t> overlap(Point2 center, double radius) const;
    /// Distance to the nearest line, at most `farthest`. The nearer the line, the cheaper.
    [[nodiscard]] double nearest(Point2 p, double farthest) const;
    /// Appends the lines that are nearer to p than `reach`, and perhaps others, each once.
    void findAbout(Point2 p, double reach, std::vector<Segment2>& lines) const;
    /// True if the path comes nearer than `distance` to a line.
    [[nodiscard]] bool near(const Segment2& way, double distance) const;
    /// An element that stops a circle whose centre moves along the path: one it enters deeper than
    /// at its start, so that a circle overlapping a line by rounding can leave it.
    [[nodiscard]] std::optional<std::size_t> stop(const Segment2& way, double radius) const;

  private:
    template <typename Test>
    [[nodiscard]] std::optional<std::size_t> find(Point2 p, double reach, Test test) const;

    std::vector<Polygon> solids_;
    PolygonIndex index_;  // of them
    std::vector<Segment2> lines_;
    std::vector<std::size_t> solid_owners_, line_owners_;
    SegmentGrid grid_;
};

/// The lines about somebody: found for more than is asked, and again only after some way.
class Vicinity {
  public:
    /// Calls visit(line, its distance) for the lines nearer to p than `reach`, each once.
    /// \pre the obstacles are the same each time
    template <typename Visit>
    void forEachWithin(const Obstacles& obstacles, Point2 p, double reach, Visit visit) {
        if (!(std::hypot(p.x - middle_.x, p.y - middle_.y) + reach <= reach_))
            find(obstacles, p, reach);
        const auto apart = [reach](double at, double a, double b) {
            return std::min(a, b) - at > reach || at - std::max(a, b) > reach;
        };
        for (const Segment2& line : lines_) {
            if (apart(p.x, line.a.x, line.b.x) || apart(p.y, line.a.y, line.b.y)) continue;
            if (const double square = squaredDistance(p, line); square < reach * reach)
                visit(line, std::sqrt(square));
        }
    }

  private:
    void find(const Obstacles& obstacles, Point2 p, double reach);

    Point2 middle_;
    double reach_ = -1;
    std::vector<Segment2> lines_;
};

/// A robot's or a person's proposed step.
struct Move {
    const Motion* from = nullptr;
    const MotionLimits* limits = nullptr;
    double duration = 0;
    double radius = 0;
    Advance to;
    Vec2 drift = {};  ///< of its end from where the motion alone would lead; grows evenly with time

    [[nodiscard]] Point2 start() const { return from->pose.position; }
    /// With the drift, as is the pose in `to`.
    [[nodiscard]] Point2 end() const { return to.motion.pose.position; }
    [[nodiscard]] Segment2 chord() const { return {start(), end()}; }
    /// Its place after `part` of kParts equal intervals of the step.
    static constexpr int kParts = 16;
    [[nodiscard]] Point2 place(int part) const;
    /// Keeps the robot where it is, at rest and without a goal.
    void cancel();
};

/// The element that the move runs into. Tests the chord first; only if that is not clear by more
/// than the path may bulge, the chords of its parts.
std::optional<std::size_t> collides(const Move& move, const Obstacles& obstacles);

/// True if the move runs into another robot, which moves at the same time or stays at its start.
bool collides(const Move& move, const Move& other, bool other_moves);

/// Indices of the movers in the order in which their moves are settled: robots, then people, each
/// by the bytes of their ids.
std::vector<std::size_t> settlingOrder(std::span<const Mover> movers);

/// Finds the robots and people that a move runs into.
///
/// A move is tested against the moves settled before it, and against all others where they stand:
/// whatever these do later, no two ever overlap.
class Traffic {
  public:
    /// `order` as of settlingOrder; a step takes `duration` seconds.
    Traffic(std::span<const Mover> movers, std::span<const std::size_t> order, double duration);

    /// Indexes where everybody is, which is where the moves begin.
    void rebuild(std::span<const Motion> motions);
    /// The first one, in the order of settling, that this mover's move runs into.
    /// \pre the moves before it are settled, cancelled or not
    [[nodiscard]] std::optional<std::size_t> hit(std::span<const Move> moves,
                                                 std::size_t mover) const;
    /// Place in the order of settling.
    [[nodiscard]] std::size_t rank(std::size_t mover) const { return rank_[mover]; }
    /// Where a mover is.
    [[nodiscard]] Point2 place(std::size_t mover) const { return places_[mover]; }
    /// Calls visit(index) for everybody who may stand or come within `reach` of p in a step.
    template <typename Visit>
    void forEachNear(Point2 p, double reach, Visit visit) const {
        const Vec2 margin{reach, reach};
        grid_.forEachNear({p - margin, p + margin}, visit);
    }

  private:
    std::vector<std::size_t> rank_;  // in the order of settling
    double reach_ = 0;               // of who gets farthest from its place in a step
    std::vector<Point2> places_;
    FloorGrid grid_;
};

/// Obstacles by height of the movers.
using ObstacleSets = std::map<double, Obstacles>;
ObstacleSets obstaclesOf(const Environment& environment, std::span<const Mover> movers);

/// \throws FormatError with all findings if a robot stands in something, in another robot or in a
///         person. People may stand in things, like one who sits on a chair: they can only get out.
void checkStart(const Environment& environment, std::span<const Mover> movers,
                const ObstacleSets& obstacles);

}  // namespace ispace
