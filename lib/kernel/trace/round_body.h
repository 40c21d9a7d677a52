// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against round bodies. Private to lib/kernel/trace.
//
// Each kernel solves a t^2 + 2 b t + c = 0 in the frame of its bodies. Standing bodies may be
// ellipses: meetUnitDisc() solves for single rays (meetRound()) and packets (RoundView). Moving
// bodies are circles and balls, which RayInterval clips in metres. RoundFrom of FlatWorld computes
// the inverse of the nearest range alone, as its scans keep the largest. These three forms round
// differently: one form for all would change the last bits of ranges.
//
// The discriminant is a r^2 - (q x d)^2, by the cross product of origin and direction, instead of
// b^2 - a c: far bodies lose no digits to the cancellation of two large squares. meetUnitDisc()
// takes the roots c / far and far / a, so that neither cancels. A ray that grazes a body loses half
// of the digits, as the root of a discriminant near 0 does. Closed sets: a ray that touches meets.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/simd.h"
#include "geom/curve.h"
#include "geom/point.h"
#include "trace/rays.h"

namespace ispace {

/// The part of a ray inside a closed set, in multiples of its direction, with |slopes| of the
/// surfaces at its ends: |normal times direction|.
struct RayInterval {
    double enter = -std::numeric_limits<double>::infinity();
    double exit = std::numeric_limits<double>::infinity();
    double enter_slope = 0, exit_slope = 0;

    /// Intersects with [near, far]; of equal ends the slope stays.
    void cut(double near, double far, double slope_near, double slope_far) {
        if (near > enter) {
            enter = near;
            enter_slope = slope_near;
        }
        if (far < exit) {
            exit = far;
            exit_slope = slope_far;
        }
    }
    /// Makes it empty: enter above exit.
    void clear() {
        enter = std::numeric_limits<double>::infinity();
        exit = -enter;
    }
    /// Clips by two planes; a ray parallel to them is kept whole or rejected.
    void cutSlab(double origin, double direction, double low, double high) {
        if (direction != 0) {
            const double a = (low - origin) / direction, b = (high - origin) / direction;
            cut(std::min(a, b), std::max(a, b), std::fabs(direction), std::fabs(direction));
        } else if (origin < low || origin > high) {
            clear();
        }
    }
    /// Clips by a cylinder with level cuts that move along x by `lean` per metre; the ray is given
    /// in the frame of these cuts.
    void cutDisc(Vec2 origin, Vec2 direction, double radius, double lean) {
        const double a = dot(direction, direction), b = dot(origin, direction);
        const double side = cross(origin, direction);
        const double root = a * radius * radius - side * side;
        if (a == 0 ? dot(origin, origin) > radius * radius : root < 0) {
            clear();
        } else if (a != 0) {
            const double half = std::sqrt(root), near = (-b - half) / a, far = (-b + half) / a;
            const double level = half / radius;
            if (lean == 0) return cut(near, far, level, level);
            // The normal of a slanted side is not level.
            const auto slope = [&](double multiple) {
                const double rise = lean * (origin.x + multiple * direction.x) / radius;
                return level / std::sqrt(1 + rise * rise);
            };
            cut(near, far, slope(near), slope(far));
        }
    }
    /// Clips by a ball about the origin of the frame.
    void cutBall(Vec3 origin, Vec3 direction, double radius) {
        const double a = dot(direction, direction), b = dot(origin, direction);
        const Vec3 side = cross(origin, direction);
        const double root = a * radius * radius - dot(side, side);
        if (root < 0) return clear();
        const double half = std::sqrt(root);
        cut((-b - half) / a, (-b + half) / a, half / radius, half / radius);
    }
};

/// Multiples of a direction between which a line lies in the unit disc.
struct DiscRoots {
    double enter, exit;
};

/// Returns the roots of a t^2 + 2 b t + c, where a line q + t d meets the unit disc, so that
/// neither cancels; NaN if it misses. Free of branches, for vector units: the results of single
/// rays and packets are equal to the last bit.
/// \param c |q|^2 - 1
/// \pre a = |d|^2 is above 0
ISPACE_INLINE DiscRoots meetUnitDisc(Vec2 q, Vec2 d, double a, double b, double c) {
    const double side = q.x * d.y - q.y * d.x;
    const double root = std::sqrt(a - side * side);
    const double far = simd::choose(b > 0, -b - root, root - b);
    const double one = far / a, two = c / far;
    return {simd::choose(b > 0, one, two), simd::choose(b > 0, two, one)};
}

/// An upright round body with closed ends.
struct RoundBody {
    Ellipse curve;
    double bottom = 0, top = 0;

    /// True only if p lies outside by more than `distance`, along the floor or upright: a quick
    /// bound, which may be false for points slightly farther. `unit`: p in the frame where the
    /// curve is the unit disc.
    [[nodiscard]] bool isFarOutside(Vec2 unit, double z, double distance) const {
        if (z - top > distance || bottom - z > distance) return true;
        // Ellipse::heightOf() is at least half_width (|u| - 1), where |u| <= 1 + (|u|^2 - 1) / 2.
        const double over = dot(unit, unit) - 1;
        const double narrow =
            curve.half_width < curve.half_length ? curve.half_width : curve.half_length;
        constexpr double kSlack = 1.001;
        return over > 0 && over * narrow > kSlack * distance * (2 + over / 2);
    }
};

/// Intersects a ray with a round body. From inside, or going in from within `ray_epsilon` of its
/// surface, returns the exit; going out from there the ray misses.
RayHit meetRound(const RoundBody& round, const Ray& ray, double ray_epsilon);

}  // namespace ispace
