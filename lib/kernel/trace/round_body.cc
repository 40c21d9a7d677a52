// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/round_body.h"

namespace ispace {

RayHit meetRound(const RoundBody& round, const Ray& ray, double ray_epsilon) {
    const auto& [curve, bottom, top] = round;
    const Vec2 q = curve.toUnit(ray.origin.onFloor() - curve.center);
    const Vec2 d = curve.toUnit({ray.direction.x, ray.direction.y});
    const double a = dot(d, d), b = dot(q, d), c = dot(q, q) - 1;
    constexpr double kUnknown = -1;  // slope of the side: computed where the ray meets it
    RayInterval inside;
    inside.cutSlab(ray.origin.z, ray.direction.z, bottom, top);
    if (a > 0) {
        const DiscRoots side = meetUnitDisc(q, d, a, b, c);
        if (!(side.enter <= side.exit)) return {};
        inside.cut(side.enter, side.exit, kUnknown, kUnknown);
    } else if (c > 0) {
        return {};
    }
    if (!(inside.enter <= inside.exit && inside.exit >= 0)) return {};
    bool touches = false;
    const double z = ray.origin.z, rise = ray.direction.z;
    if (!round.isFarOutside(q, z, ray_epsilon)) {
        const double height = curve.heightOf(ray.origin.onFloor());
        touches = std::fabs(std::max({height, z - top, bottom - z})) <= ray_epsilon;
        const bool goes_out = (std::fabs(height) <= ray_epsilon && b >= 0) ||
                              (std::fabs(z - top) <= ray_epsilon && rise > 0) ||
                              (std::fabs(bottom - z) <= ray_epsilon && rise < 0);
        if (touches && (goes_out || inside.exit * length(ray.direction) <= ray_epsilon)) return {};
    }
    const bool enters = inside.enter >= 0 && !touches;
    const double multiple = enters ? inside.enter : inside.exit;
    if (!(multiple <= ray.reach)) return {};
    const double slope = enters ? inside.enter_slope : inside.exit_slope;
    if (slope != kUnknown) return {multiple, slope};
    const Vec2 normal = curve.normalAt((ray.origin + multiple * ray.direction).onFloor());
    const Vec2 flat{ray.direction.x, ray.direction.y};
    return {multiple, std::fabs(dot(normal, flat)) / length(normal)};
}

}  // namespace ispace
