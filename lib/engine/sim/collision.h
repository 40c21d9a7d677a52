// SPDX-License-Identifier: GPL-3.0-or-later
// Collisions of movers with obstacles and with each other.
//
// A mover is a circle on the floor. Bodies count from the floor to the height of the mover. A step
// is a path: it is tested as a whole, so that fast movers pass through no thin wall. Circles may
// touch, and overlap by kContactTolerance, which absorbs rounding. One that overlaps a body by
// rounding, or from the start, gets no deeper into it.
//
// A path that bends is replaced by the chords of 16 parts. With acceleration a the path of a part
// strays from a uniform motion along its chord by at most a (T / 16)^2 / 8: 1.2e-8 m in a step of 5
// ms at 1 m/s2.
//
//     const Obstacles obstacles(environment, 0.5, nullptr);
//     const std::optional<std::size_t> element = obstacles.stop({{0, 0}, {2, 0}}, 0.25);
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "env/environment.h"
#include "env/slice.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"
#include "geom/tolerance.h"
#include "sim/motion.h"
#include "sim/mover.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Returns the distance between two closed segments, 0 if they share a point, with rounding errors.
double distance(const Segment2& s, const Segment2& t);

/// Returns the squared distance between a point and a segment, for bulk queries.
inline double squaredDistance(Point2 p, const Segment2& s) {
    const Vec2 along = s.b - s.a, way = p - s.a;
    const double square = dot(along, along);
    const double t = square > 0 ? std::clamp(dot(way, along) / square, 0.0, 1.0) : 0;
    const Vec2 apart = way - t * along;
    return dot(apart, apart);
}

/// Finds the lines of a band that block a circle, by a grid. Only overlap() knows the inside of
/// solids: for the other queries a circle within one, off its lines, is free. Queries take time in
/// proportion to the lines near the point; building takes O(n log n); after few changes of the
/// environment only the changed elements are indexed, and O(elements) are numbered anew.
/// Thread-safe.
class Obstacles {
  public:
    /// \pre the band's pieces have owners
    explicit Obstacles(const Slice& band);
    /// Takes the band from the floor to this height.
    /// \param before obstacles of the same height: their grid is shared if few elements changed
    ///        since it was built, and those stand in a second grid; may be null
    Obstacles(const Environment& environment, double height, const Obstacles* before);

    /// Returns the first element of Environment::elements() with a line that a circle overlaps; if
    /// there is none, the first with a solid that contains it.
    [[nodiscard]] std::optional<std::size_t> overlap(Point2 center, double radius) const;
    /// Returns the distance to the nearest line, at most `farthest`, which it is without a line in
    /// reach. Near lines cost least.
    [[nodiscard]] double nearest(Point2 p, double farthest) const;
    /// Appends each line nearer to p than `reach` once, and possibly others.
    void findAbout(Point2 p, double reach, std::vector<Segment2>& lines) const;
    /// Returns true if the path comes nearer than `distance` to a line.
    [[nodiscard]] bool near(const Segment2& way, double distance) const;
    /// Finds the first element that stops a circle with its centre moving along the path: one that
    /// it enters deeper than at its start, so that a circle that overlaps a line by rounding can
    /// leave it.
    [[nodiscard]] std::optional<std::size_t> stop(const Segment2& way, double radius) const;

  private:
    /// A band with its indices.
    struct Part {
        explicit Part(const Slice& band);

        std::vector<Polygon> solids;
        BoxTree boxes;  // of the solids
        std::vector<Segment2> lines;
        std::vector<std::size_t> solid_owners, line_owners;
        SegmentGrid grid;
    };
    static constexpr std::size_t kGone = std::numeric_limits<std::size_t>::max();

    /// Returns the element that owns a piece; kGone if that has changed or was removed.
    [[nodiscard]] std::size_t elementOf(const Part& part, std::size_t owner) const {
        return &part == base_.get() && !elements_.empty() ? elements_[owner] : owner;
    }
    template <typename Visit>
    void forEachPart(Visit visit) const;
    template <typename Visit, typename Done>
    void search(Point2 p, Visit visit, Done done) const;
    template <typename Test>
    [[nodiscard]] std::optional<std::size_t> find(Point2 p, double reach, Test test) const;

    std::shared_ptr<const Part> base_, added_;  // added_ may be null
    std::optional<Environment> base_of_;        // the environment that base_ was built of
    std::vector<std::size_t> elements_;         // by element of that one; empty: all the same
};

/// Caches the lines around a mover: a lookup finds more lines than required and is repeated only
/// after the mover has gone some way.
class Vicinity {
  public:
    /// Calls visit(line, its distance) once for each line nearer to p than `reach`.
    /// \pre every call passes the same obstacles
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

/// A disc on the floor that a part of a resting body covers.
struct BodyDisc {
    Point2 center;
    double radius = 0, bottom = 0;  ///< bottom: height from which on it stops a robot
};

/// Covers the body of a person that sits, lies or has fallen, without a thing that it carries, by
/// discs along its parts, those of boxes as wide as their shorter sides.
std::vector<BodyDisc> discsOf(const PersonFigure& figure, const Pose2& pose);

/// The step that a mover proposes.
struct Move {
    const Motion* from = nullptr;
    const MotionLimits* limits = nullptr;
    double duration = 0;
    double radius = 0;
    double height = 0;  ///< of a robot, which resting bodies stop; 0: of a person, which steps over
    const std::vector<BodyDisc>* body = nullptr;  ///< of a person that rests
    double span = 0;                              ///< of the body, from its position
    Advance to;
    Vec2 drift = {};  ///< offset of its end from the noiseless motion; grows linearly with time

    [[nodiscard]] Point2 start() const { return from->pose.position; }
    /// Includes the drift, like the pose in `to`.
    [[nodiscard]] Point2 end() const { return to.motion.pose.position; }
    [[nodiscard]] Segment2 chord() const { return {start(), end()}; }
    /// Returns the radius of the circle about `other` that may stop this one.
    [[nodiscard]] double reachOf(const Move& other) const {
        return height > 0 ? std::max(other.radius, other.span) : other.radius;
    }
    /// Returns its position after `part` of kParts equal intervals of the step.
    static constexpr int kParts = 16;
    [[nodiscard]] Point2 place(int part) const;
    /// Holds the robot at its start, at rest and without a goal.
    void cancel();
};

/// Finds the element that the move runs into. Tests the chord first, and the chords of the parts
/// only if the path may bulge beyond the clearance.
std::optional<std::size_t> collides(const Move& move, const Obstacles& obstacles);

/// Returns true if the move runs into another mover, which moves at the same time or stays at its
/// start: into its circle, or a robot into a body that rests.
bool collides(const Move& move, const Move& other, bool other_moves);

/// Sorts the movers into the order in which their moves are settled: robots, then people, each by
/// the bytes of their ids. Returns indices.
std::vector<std::size_t> settlingOrder(std::span<const Mover> movers);

/// Finds the movers that a move runs into.
///
/// A move is tested against the settled moves, and against the starts of all other movers: whatever
/// moves these make later, no two movers ever overlap. Const members are thread-safe.
class Traffic {
  public:
    /// \param order see settlingOrder \param duration seconds of a step
    Traffic(std::span<const Mover> movers, std::span<const std::size_t> order, double duration);

    /// Builds the index of positions, at which the moves begin.
    void rebuild(std::span<const Motion> motions);
    /// Returns the first mover, in settling order, that this mover's move runs into.
    /// \param farthest metres that noise may make a move long; 0: none is longer than at top speed
    /// \pre the moves before it are settled, cancelled or not
    [[nodiscard]] std::optional<std::size_t> hit(std::span<const Move> moves, std::size_t mover,
                                                 double farthest = 0) const;
    /// Returns the rank in settling order.
    [[nodiscard]] std::size_t rank(std::size_t mover) const { return rank_[mover]; }
    /// Returns a mover's position.
    [[nodiscard]] Point2 place(std::size_t mover) const { return places_[mover]; }
    /// Calls visit(index) for each mover that may come within `reach` of p in a step.
    template <typename Visit>
    void forEachNear(Point2 p, double reach, Visit visit) const {
        const Vec2 margin{reach, reach};
        grid_.forEachNear({p - margin, p + margin}, visit);
    }

  private:
    std::vector<std::size_t> rank_;  // in settling order
    double reach_ = 0;               // of the mover that gets farthest from its start in a step
    std::vector<Point2> places_;
    FloorGrid grid_;
};

/// Maps the height of movers to their obstacles.
using ObstacleSets = std::map<double, Obstacles>;
/// \param before of another environment, see Obstacles; may be null
ObstacleSets obstaclesOf(const Environment& environment, std::span<const Mover> movers,
                         const ObstacleSets* before = nullptr);

/// \throws FormatError with the findings of checkScene() if a robot overlaps a body, a robot or a
/// person, or two people overlap by more than a tenth of their widths. People may overlap bodies,
/// as one on a chair does, and a little each other, as in a crowd: they can only get out.
void checkStart(const Scene& scene, std::span<const Mover> movers, const ObstacleSets& obstacles);

/// Distance at which movers look out for each other, in metres between their edges.
constexpr double kMoverSight = 4;
/// Limit of pairs of movers that look out for each other: a step tests each some twenty times.
constexpr std::size_t kMaxMeetingPairs = 4'000'000;

/// Bounds the work of a step before there is any. Two movers are a pair if their centres are nearer
/// than `reach` and twice the largest radius. \throws FormatError beyond kMaxMeetingPairs
void checkCrowding(std::span<const Mover> movers, std::span<const Motion> motions, double reach);

}  // namespace ispace
