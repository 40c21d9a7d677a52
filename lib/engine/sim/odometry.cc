// SPDX-License-Identifier: GPL-3.0-or-later
// Arcs, errors, and the estimate of a robot's pose.
//
// Sine and cosine along an arc are power series of eleven terms, accurate to rounding up to a
// quarter turn: they take no branches, so the poses of all beams of a scan are computed by vectors.
// A chord of an arc that turns by a points a / 2 to the side and is sin(a / 2) / (a / 2) of its
// length.
#include "sim/odometry.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"

namespace ispace {

namespace {

/// Returns true if an alpha is not 0.
bool hasDeviation(const MotionAlphas& alphas) {
    return std::any_of(alphas.begin(), alphas.end(), [](double alpha) { return alpha != 0; });
}

/// 1/first - square * (1/second - square * (1/third - ...)).
ISPACE_INLINE double series(double /*square*/, double last) { return 1.0 / last; }
template <typename... Others>
ISPACE_INLINE double series(double square, double first, Others... others) {
    return 1.0 / first - square * series(square, others...);
}

/// Computes sin(x) / x from the square of x, up to rounding, to a quarter turn: factorials of odd
/// numbers.
ISPACE_INLINE double sineOver(double square) {
    return series(square, 1.0, 6.0, 120.0, 5040.0, 362880.0, 39916800.0, 6227020800.0,
                  1307674368000.0, 355687428096000.0, 121645100408832000.0, 51090942171709440000.0);
}

/// cos(x) likewise: of even ones.
ISPACE_INLINE double cosine(double square) {
    return series(square, 1.0, 2.0, 24.0, 720.0, 40320.0, 3628800.0, 479001600.0, 87178291200.0,
                  20922789888000.0, 6402373705728000.0, 2432902008176640000.0);
}

/// An arc from its beginning on.
struct ArcShape {
    double half, whole;
    double chord_x, chord_y;
};

/// The way after a share, and the cosine and sine of the turn.
struct ArcPart {
    double x, y, cos, sin;
};

ISPACE_INLINE ArcPart partOf(ArcShape course, double share) {
    const double angle = share * course.half, square = angle * angle;
    const double over = sineOver(square), c = cosine(square), s = angle * over;
    // The chord of an arc of this angle points half of it to the side.
    const double part = share * over / course.whole;
    return {part * (c * course.chord_x - s * course.chord_y),
            part * (s * course.chord_x + c * course.chord_y), 1 - 2 * s * s, 2 * s * c};
}

/// Poses in the world at the beginning of the course.
struct Begin {
    double x, y;                  // of the mover
    double mount_x, mount_y;      // from there to the carried frame
    double forward_x, forward_y;  // its heading
};

// Structures are passed by value, so that the compiler knows that stores to the arrays leave them
// unchanged.
ISPACE_SIMD_CLONES
void carryAlong(ArcShape course, Begin begin, double first, double step, int count, double* x,
                double* y, double* cos, double* sin) {
    for (int k = 0; k < count; ++k) {
        const ArcPart part = partOf(course, first + k * step);
        x[k] = begin.x + (part.x + (part.cos * begin.mount_x - part.sin * begin.mount_y));
        y[k] = begin.y + (part.y + (part.sin * begin.mount_x + part.cos * begin.mount_y));
        cos[k] = part.cos * begin.forward_x - part.sin * begin.forward_y;
        sin[k] = part.sin * begin.forward_x + part.cos * begin.forward_y;
    }
}

}  // namespace

ArcPath::ArcPath(const Pose2& from, const Pose2& to)
    : from_(from),
      to_(to),
      turn_(wrapped(to.heading - from.heading)),
      half_(0.5 * turn_.radians()),
      whole_(sineOver(half_ * half_)) {
    const auto [c, s] = cosSin(0.5 * turn_);
    const Vec2 chord = to.position - from.position;
    chord_ = {c * chord.x + s * chord.y, c * chord.y - s * chord.x};
}

Pose2 ArcPath::at(double share) const {
    if (share == 0) return from_;
    if (share == 1) return to_;
    const ArcPart part = partOf({half_, whole_, chord_.x, chord_.y}, share);
    return {from_.position + Vec2{part.x, part.y}, wrapped(from_.heading + share * turn_)};
}

void ArcPath::carry(const Pose2& mount, double first, double step, std::size_t begin,
                    std::size_t end, BeamFrames& frames) const {
    const Vec2 way = from_ * (mount.position - Point2());
    const Vec2 forward = unitVector(wrapped(from_.heading + mount.heading));
    carryAlong({half_, whole_, chord_.x, chord_.y},
               {from_.position.x, from_.position.y, way.x, way.y, forward.x, forward.y}, first,
               step, static_cast<int>(end - begin), frames.x.data() + begin,
               frames.y.data() + begin, frames.cos.data() + begin, frames.sin.data() + begin);
}

namespace {

/// Returns two independent standard normal numbers.
std::array<double, 2> normals(const RandomKey& key) {
    float a = 0, b = 0;
    draw(key, 0, {.normal = std::span(&a, 1), .other = std::span(&b, 1)});
    return {static_cast<double>(a), static_cast<double>(b)};
}

}  // namespace

Pose2 relativePose(const Pose2& from, const Pose2& to) {
    const Vec2 way = to.position - from.position;
    const Vec2 ahead = unitVector(from.heading);
    return {{dot(way, ahead), cross(ahead, way)}, wrapped(to.heading - from.heading)};
}

Pose2 composed(const Pose2& outer, const Pose2& inner) {
    return {outer * inner.position, wrapped(outer.heading + inner.heading)};
}

Pose2 strayed(const Pose2& motion, const MotionAlphas& alphas, const RandomKey& key) {
    const Vec2 way = motion.position - Point2{};
    const double metres = length(way), turn = std::abs(motion.heading.radians());
    if (metres == 0 && turn == 0) return motion;
    const auto [of_turn, of_way] = normals(key);
    const Angle error = Angle::radians(of_turn * std::sqrt(alphas[0] * turn + alphas[1] * metres));
    const double stretch = of_way * std::sqrt(alphas[2] * metres + alphas[3] * turn);
    // A mover that turns on the spot strays along the new heading.
    const Vec2 along = metres > 0 ? (1 / metres) * way : unitVector(motion.heading);
    const Vec2 far = (metres + stretch) * along;
    const Vec2 half = unitVector(0.5 * error);
    return {Point2{} + (far.x * half + far.y * perpendicular(half)), motion.heading + error};
}

std::vector<std::size_t> strayStarts(std::span<Mover> movers, const ObstacleSets& obstacles,
                                     std::uint64_t seed) {
    constexpr std::uint64_t kTries = 100;
    const auto is_free = [&](std::size_t i, const Pose2& pose) {
        const RobotModel& model = movers[i].model;
        // Rejects starts behind a wall, too.
        const Segment2 way{movers[i].pose.position, pose.position};
        if (obstacles.at(model.height).stop(way, model.radius)) return false;
        for (std::size_t j = 0; j < movers.size(); ++j)
            if (j != i && distance(pose.position, movers[j].pose.position) <
                              model.radius + movers[j].model.radius)
                return false;
        return true;
    };
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const MotionNoise& noise = movers[i].model.noise;
        if (noise.start_place == 0 && noise.start_heading == Angle()) continue;
        const std::uint64_t id = hashOf(movers[i].id);
        bool found = false;
        for (std::uint64_t k = 0; k < kTries && !found; ++k) {
            const auto [dx, dy] = normals({seed, Purpose::Start, id, 2 * k});
            const auto [turn, unused] = normals({seed, Purpose::Start, id, 2 * k + 1});
            const Pose2 pose{movers[i].pose.position + noise.start_place * Vec2{dx, dy},
                             wrapped(movers[i].pose.heading + turn * noise.start_heading)};
            found = is_free(i, pose);
            if (found) movers[i].pose = pose;
        }
        if (!found) kept.push_back(i);
    }
    return kept;
}

WheelTravel travelOf(const Motion& from, const Motion& to, double duration) {
    constexpr double kTurn = 360, kHalfTurn = 180;
    const Vec2 way = to.pose.position - from.pose.position;
    const double rate = (from.turn.speed + to.turn.speed) / 2;  // degrees a second
    if (rate == 0 && from.pose.heading == to.pose.heading) return {dot(way, from.forward()), {}};
    double turned = wrapped(to.pose.heading - from.pose.heading).degrees();
    turned += kTurn * std::round((rate * duration - turned) / kTurn);
    if (std::abs(turned) > kHalfTurn)  // the chord tells little
        return {(from.drive.speed + to.drive.speed) / 2 * duration, Angle::degrees(turned)};
    if (way == Vec2{}) return {0, Angle::degrees(turned)};
    const Angle half = Angle::degrees(turned / 2);
    // The chord points half of the turn to the side.
    const double chord = dot(way, unitVector(from.pose.heading + half));
    return {chord / sineOver(half.radians() * half.radians()), Angle::degrees(turned)};
}

Odometer::Odometer(const Mover& mover, std::uint64_t seed, bool noise)
    : noise_(mover.model.noise),
      seed_(seed),
      id_(hashOf(mover.id)),
      counts_(noise && (hasDeviation(noise_.motion) || hasDeviation(noise_.odometry))),
      drifts_(noise && hasDeviation(noise_.motion)),
      alphas_(alphasOf(noise_)),
      origin_(mover.pose) {}

Vec2 Odometer::stray(Motion& end, const Pose2& start, std::int64_t step) {
    turned_ = relativePose(start, end.pose);
    if (!drifts_) return {};
    const Pose2 motion = strayed(turned_, noise_.motion,
                                 {seed_, Purpose::Motion, id_, static_cast<std::uint64_t>(step)});
    const Pose2 pose = composed(start, motion);
    const Vec2 drift = pose.position - end.pose.position;
    end.turn_end = wrapped(end.turn_end + (pose.heading - end.pose.heading));
    end.pose = pose;
    return drift;
}

void Odometer::count(std::int64_t step) {
    if (!counts_) return;
    covariance_ = propagated(covariance_, pose_.heading, turned_, covarianceOf(turned_, alphas_));
    pose_ =
        composed(pose_, strayed(turned_, noise_.odometry,
                                {seed_, Purpose::Odometry, id_, static_cast<std::uint64_t>(step)}));
    turned_ = {};
}

}  // namespace ispace
