// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/round_view.h"

#include <cmath>
#include <cstdint>

#include "base/simd.h"
#include "trace/flat_kernels.h"

namespace ispace {

namespace {

/// Values of a body and the rays' origin, as in meetRound().
struct RoundTask {
    Ellipse curve;
    Vec2 q;
    double c, low_end, high_end;
};

// Omits branches of meetRound() that matter only for upright or level rays.
ISPACE_SIMD_CLONES bool meetAll(const RoundTask& task, const RayPacket& packet, float* out) {
    const Vec2 axis = task.curve.axis, q = task.q;
    const double wide = task.curve.half_length, deep = task.curve.half_width;
    const double c = task.c, low_end = task.low_end, high_end = task.high_end;
    std::int64_t special = 0;
    alignas(64) std::array<float, kLanes> multiples;  // NOLINT: set in the loop
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double x = packet.x[lane], y = packet.y[lane], rise = packet.z[lane];
        const double dx = (axis.x * x + axis.y * y) / wide, dy = (axis.x * y - axis.y * x) / deep;
        const double a = dx * dx + dy * dy, b = q.x * dx + q.y * dy;
        special |= (a > 0 ? 0 : 1) | (rise != 0 ? 0 : 1);
        const auto [from, to] = meetUnitDisc(q, {dx, dy}, a, b, c);
        const double s = low_end / rise, t = high_end / rise;
        const double low = flatMin(t, s), high = flatMax(t, s);
        const double enter = flatMax(low, from), leave = flatMin(high, to);
        const double multiple = simd::choose(enter >= 0, enter, leave);
        const bool is_met = (enter <= leave) & (leave >= 0) & (multiple <= packet.reach[lane]);
        multiples[lane] = simd::choose(is_met, static_cast<float>(multiple), kNoReturn);
    }
    if (special != 0) return false;
    for (std::size_t lane = 0; lane < kLanes; ++lane) out[lane] = multiples[lane];
    return true;
}

}  // namespace

RoundView::RoundView(const RoundBody& body, Point3 origin, double ray_epsilon)
    : body_(&body),
      is_far_(body.isFarOutside(body.curve.toUnit(origin.onFloor() - body.curve.center), origin.z,
                                ray_epsilon)) {}

bool RoundView::meet(const RayPacket& packet, std::array<float, kLanes>& multiples) const {
    if (!is_far_) return false;
    const Point3 origin{packet.origin_x[0], packet.origin_y[0], packet.origin_z[0]};
    const Vec2 q = body_->curve.toUnit(origin.onFloor() - body_->curve.center);
    const RoundTask task{body_->curve, q, dot(q, q) - 1, body_->bottom - origin.z,
                         body_->top - origin.z};
    return meetAll(task, packet, multiples.data());
}

namespace {

using RoundSurface = TriangleSet::RoundSurface;

void boundsOfRound(const RTCBoundsFunctionArguments* args) {
    const RoundBody& round =
        static_cast<const RoundSurface*>(args->geometryUserPtr)[args->primID].body;
    setBounds(round.curve.box(), round.bottom, round.top, *args->bounds_o);
}

/// Computes the multiple of one ray's direction at which it meets the body.
float meetAlone(const RoundBody& round, const ExactRays& exact, RTCRayN* rays, unsigned count,
                unsigned i) {
    Ray ray = exact.packet != nullptr
                  ? exact.packet->ray(RTCRayN_id(rays, count, i))
                  : Ray{{RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i),
                         RTCRayN_org_z(rays, count, i)},
                        {RTCRayN_dir_x(rays, count, i), RTCRayN_dir_y(rays, count, i),
                         RTCRayN_dir_z(rays, count, i)},
                        kMaxRayReach};
    const double least = static_cast<double>(RTCRayN_tnear(rays, count, i));
    double multiple = meetRound(round, ray, exact.ray_epsilon).multiple;
    if (multiple < least) {
        ray.origin = ray.origin + least * ray.direction;
        multiple = least + meetRound(round, ray, exact.ray_epsilon).multiple;
    }
    return static_cast<float>(multiple);
}

/// Calls met(ray, multiple) for each ray that the body stops.
template <typename Arguments, typename Met>
void meetRays(const Arguments& args, RTCRayN* rays, const RoundBody& round, Met met) {
    constexpr unsigned kFew = 2;
    const ExactRays& exact = reinterpret_cast<const EmbreeQuery*>(args.context)->rays;
    unsigned asked = 0;
    for (unsigned i = 0; i < args.N; ++i) asked += args.valid[i] != 0 ? 1 : 0;
    alignas(64) std::array<float, kLanes> all;  // NOLINT: set by meet()
    const bool has_all =
        exact.have_one_origin && asked > kFew &&
        RoundView(round, exact.packet->ray(0).origin, exact.ray_epsilon).meet(*exact.packet, all);
    for (unsigned i = 0; i < args.N; ++i) {
        if (args.valid[i] == 0) continue;
        const float multiple =
            has_all ? all[RTCRayN_id(rays, args.N, i)] : meetAlone(round, exact, rays, args.N, i);
        if (multiple <= RTCRayN_tfar(rays, args.N, i)) met(i, multiple);
    }
}

void intersectRounds(const RTCIntersectFunctionNArguments* args) {
    const auto& [round, surface] =
        static_cast<const RoundSurface*>(args->geometryUserPtr)[args->primID];
    meetRays(*args, RTCRayHitN_RayN(args->rayhit, args->N), round,
             [&, number = surface](unsigned ray, float multiple) {
                 setHit(*args, ray, multiple, args->geomID - kRoundGeometries, number);
             });
}

void occludeRounds(const RTCOccludedFunctionNArguments* args) {
    const auto* const rounds = static_cast<const RoundSurface*>(args->geometryUserPtr);
    meetRays(*args, args->ray, rounds[args->primID].body,
             [&](unsigned ray, float /*multiple*/) { setOccluded(*args, ray); });
}

}  // namespace

void attachRounds(RTCDevice device, RTCScene scene, std::span<const RoundSurface> rounds,
                  unsigned geometry_id) {
    attachBodies(device, scene, rounds, geometry_id + kRoundGeometries,
                 {boundsOfRound, intersectRounds, occludeRounds});
}

}  // namespace ispace
