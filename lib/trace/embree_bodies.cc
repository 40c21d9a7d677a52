// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ispace {

namespace {

/// Bounding box of the body, enlarged by more than the float32 rounding of rays and corners.
void boundsOf(const RTCBoundsFunctionArguments* args) {
    const auto* const bodies = static_cast<const TracedBody*>(args->geometryUserPtr);
    const MovingBody& body = bodies[args->primID].body;
    const double around = body.reach() + body.sway();
    const auto [x, y] = body.pose.position;
    const double far = std::max({std::fabs(x), std::fabs(y), body.top}) + around;
    const double slack = 1e-6 * (1 + far);
    const auto low = [&](double at) { return static_cast<float>(at - slack); };
    const auto high = [&](double at) { return static_cast<float>(at + slack); };
    RTCBounds& box = *args->bounds_o;
    box.lower_x = low(x - around);
    box.lower_y = low(y - around);
    box.lower_z = low(body.bottom);
    box.upper_x = high(x + around);
    box.upper_y = high(y + around);
    box.upper_z = high(body.top);
}

/// Calls met(lane, multiple) for each ray that the body stops.
template <typename Arguments, typename Met>
void meetBody(const Arguments& args, RTCRayN* rays, Met met) {
    const auto& query =
        static_cast<const BodyQuery&>(*reinterpret_cast<const EmbreeQuery*>(args.context));
    const TracedBody& traced = static_cast<const TracedBody*>(args.geometryUserPtr)[args.primID];
    const std::uint32_t owner = traced.body.owner;
    if (owner < query.hidden.size() && query.hidden[owner]) return;
    for (unsigned i = 0; i < args.N; ++i) {
        if (args.valid[i] == 0) continue;
        const Point3 origin{RTCRayN_org_x(rays, args.N, i), RTCRayN_org_y(rays, args.N, i),
                            RTCRayN_org_z(rays, args.N, i)};
        const Vec3 direction{RTCRayN_dir_x(rays, args.N, i), RTCRayN_dir_y(rays, args.N, i),
                             RTCRayN_dir_z(rays, args.N, i)};
        const double least = static_cast<double>(RTCRayN_tnear(rays, args.N, i));
        const auto multiple = static_cast<float>(traced.meet(origin, direction, least).multiple);
        if (multiple <= RTCRayN_tfar(rays, args.N, i)) met(i, multiple);
    }
}

void intersect(const RTCIntersectFunctionNArguments* args) {
    const unsigned count = args->N;
    RTCRayN* const rays = RTCRayHitN_RayN(args->rayhit, count);
    RTCHitN* const hits = RTCRayHitN_HitN(args->rayhit, count);
    meetBody(*args, rays, [&](unsigned lane, float multiple) {
        RTCRayN_tfar(rays, count, lane) = multiple;
        RTCHitN_primID(hits, count, lane) = args->primID;
        RTCHitN_geomID(hits, count, lane) = args->geomID;
        RTCHitN_instID(hits, count, lane, 0) = args->context->instID[0];
    });
}

void occlude(const RTCOccludedFunctionNArguments* args) {
    meetBody(*args, args->ray, [&](unsigned lane, float /*multiple*/) {
        RTCRayN_tfar(args->ray, args->N, lane) = -std::numeric_limits<float>::infinity();
    });
}

}  // namespace

EmbreeSceneHandle buildBodies(RTCDeviceTy* device, std::span<const TracedBody> bodies,
                              unsigned geometry_id) {
    return buildScene(
        device, RTC_GEOMETRY_TYPE_USER, bodies.size(), geometry_id, [&](RTCGeometry geometry) {
            rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(bodies.size()));
            // Read-only use; Embree's interface lacks const.
            rtcSetGeometryUserData(geometry, const_cast<TracedBody*>(bodies.data()));  // NOLINT
            rtcSetGeometryBoundsFunction(
                geometry, [](const RTCBoundsFunctionArguments* args) { boundsOf(args); }, nullptr);
            rtcSetGeometryIntersectFunction(geometry, intersect);
            rtcSetGeometryOccludedFunction(geometry, occlude);
        });
}

}  // namespace ispace
