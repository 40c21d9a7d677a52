// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/arc_way.h"

#include "base/simd.h"

namespace ispace {

namespace {

/// 1/first - square * (1/second - square * (1/third - ...)).
ISPACE_INLINE double series(double /*square*/, double last) { return 1.0 / last; }
template <typename... Others>
ISPACE_INLINE double series(double square, double first, Others... others) {
    return 1.0 / first - square * series(square, others...);
}

/// sin(x) / x by the square of x, to rounding up to a quarter turn: factorials of odd numbers.
ISPACE_INLINE double sineOver(double square) {
    return series(square, 1.0, 6.0, 120.0, 5040.0, 362880.0, 39916800.0, 6227020800.0,
                  1307674368000.0, 355687428096000.0, 121645100408832000.0, 51090942171709440000.0);
}

/// cos(x) alike: of even ones.
ISPACE_INLINE double cosine(double square) {
    return series(square, 1.0, 2.0, 24.0, 720.0, 40320.0, 3628800.0, 479001600.0, 87178291200.0,
                  20922789888000.0, 6402373705728000.0, 2432902008176640000.0);
}

/// An arc from its beginning on.
struct Course {
    double half, whole;
    double chord_x, chord_y;
};

/// The way after a share, and the cosine and sine of the turn.
struct Part {
    double x, y, cos, sin;
};

ISPACE_INLINE Part partOf(Course course, double share) {
    const double angle = share * course.half, square = angle * angle;
    const double over = sineOver(square), c = cosine(square), s = angle * over;
    // An arc of this angle has a chord that points half of it to the side.
    const double part = share * over / course.whole;
    return {part * (c * course.chord_x - s * course.chord_y),
            part * (s * course.chord_x + c * course.chord_y), 1 - 2 * s * s, 2 * s * c};
}

/// Poses in the world where the course begins.
struct Begin {
    double x, y;                  // of the mover
    double mount_x, mount_y;      // from there to what it carries
    double forward_x, forward_y;  // where that faces
};

// Structures come by value: they are then known not to change while the arrays do.
ISPACE_SIMD_CLONES
void carryAlong(Course course, Begin begin, double first, double step, int count, double* x,
                double* y, double* cos, double* sin) {
    for (int k = 0; k < count; ++k) {
        const Part part = partOf(course, first + k * step);
        x[k] = begin.x + (part.x + (part.cos * begin.mount_x - part.sin * begin.mount_y));
        y[k] = begin.y + (part.y + (part.sin * begin.mount_x + part.cos * begin.mount_y));
        cos[k] = part.cos * begin.forward_x - part.sin * begin.forward_y;
        sin[k] = part.sin * begin.forward_x + part.cos * begin.forward_y;
    }
}

}  // namespace

ArcWay::ArcWay(const Pose2& from, const Pose2& to)
    : from_(from),
      to_(to),
      turn_(wrapped(to.heading - from.heading)),
      half_(0.5 * turn_.radians()),
      whole_(sineOver(half_ * half_)) {
    const auto [c, s] = cosSin(0.5 * turn_);
    const Vec2 chord = to.position - from.position;
    chord_ = {c * chord.x + s * chord.y, c * chord.y - s * chord.x};
}

Pose2 ArcWay::at(double share) const {
    if (share == 0) return from_;
    if (share == 1) return to_;
    const Part part = partOf({half_, whole_, chord_.x, chord_.y}, share);
    return {from_.position + Vec2{part.x, part.y}, wrapped(from_.heading + share * turn_)};
}

void ArcWay::carry(const Pose2& mount, double first, double step, std::size_t begin,
                   std::size_t end, BeamFrames& frames) const {
    const Vec2 way = from_ * (mount.position - Point2());
    const Vec2 forward = unitVector(wrapped(from_.heading + mount.heading));
    carryAlong({half_, whole_, chord_.x, chord_.y},
               {from_.position.x, from_.position.y, way.x, way.y, forward.x, forward.y}, first,
               step, static_cast<int>(end - begin), frames.x.data() + begin,
               frames.y.data() + begin, frames.cos.data() + begin, frames.sin.data() + begin);
}

}  // namespace ispace
