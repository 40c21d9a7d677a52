// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_bodies.h"

namespace ispace {

namespace {

/// Bounding box of the body.
void boundsOf(const RTCBoundsFunctionArguments* args) {
    const auto* const bodies = static_cast<const TracedBody*>(args->geometryUserPtr);
    const MovingBody& body = bodies[args->primID].body;
    const double around = body.reach() + body.sway();
    const Vec2 reach{around, around};
    const Point2 place = body.pose.position;
    setBounds({place - reach, place + reach}, body.bottom, body.top, *args->bounds_o);
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
    meetBody(*args, RTCRayHitN_RayN(args->rayhit, args->N), [&](unsigned ray, float multiple) {
        setHit(*args, ray, multiple, args->geomID, args->primID);
    });
}

void occlude(const RTCOccludedFunctionNArguments* args) {
    meetBody(*args, args->ray, [&](unsigned ray, float /*multiple*/) { setOccluded(*args, ray); });
}

}  // namespace

EmbreeSceneHandle buildBodies(RTCDeviceTy* device, std::span<const TracedBody> bodies,
                              unsigned geometry_id) {
    return buildScene(device, [&](RTCScene scene) {
        attachBodies(device, scene, bodies, geometry_id, {boundsOf, intersect, occlude});
    });
}

}  // namespace ispace
