// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_query.h"

#include <algorithm>
#include <cmath>

namespace ispace {

namespace {

/// Collects surfaces whose bounds come near the point of a query.
bool collect(RTCPointQueryFunctionArguments* args) {
    static_cast<std::vector<unsigned>*>(args->userPtr)->push_back(args->primID);
    return false;
}

void passIgnored(const RTCFilterFunctionNArguments* args) {
    const auto& query =
        static_cast<const PassingQuery&>(*reinterpret_cast<const EmbreeQuery*>(args->context));
    for (unsigned i = 0; i < args->N; ++i)
        if (args->valid[i] != 0 &&
            query.ignored.contains(RTCHitN_primID(args->hit, args->N, i), query.origin))
            args->valid[i] = 0;
}

void passUnmet(const RTCFilterFunctionNArguments* args) {
    const auto& query =
        static_cast<const SingleQuery&>(*reinterpret_cast<const EmbreeQuery*>(args->context));
    if (args->valid[0] != 0 &&
        query.ignored.meet(RTCHitN_primID(args->hit, 1, 0), query.ray).isNone())
        args->valid[0] = 0;
}

}  // namespace

IgnoredSurfaces::IgnoredSurfaces(RTCScene scene, const TriangleSet& set, double ray_epsilon,
                                 Point3 origin)
    : IgnoredSurfaces(set, ray_epsilon) {
    RTCPointQuery query{};
    query.x = static_cast<float>(origin.x);
    query.y = static_cast<float>(origin.y);
    query.z = static_cast<float>(origin.z);
    query.radius = static_cast<float>(ray_epsilon + set.tolerance());
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    std::vector<unsigned> near;
    rtcPointQuery(scene, &query, &context, collect, &near);
    for (const unsigned triangle : near)
        if (set.distance(triangle, origin) <= ray_epsilon)
            normals_.push_back(set.planes()[triangle].normal);
}

bool IgnoredSurfaces::contains(std::size_t triangle, Point3 origin) const {
    constexpr double kParallel = 1 - 1e-6;  // cosine
    const Plane& plane = set_.planes()[triangle];
    const double height = std::fabs(plane.heightOver(origin));
    if (height <= kEdgeOn) return true;
    return height <= ray_epsilon_ &&
           std::any_of(normals_.begin(), normals_.end(), [&](Vec3 normal) {
               return std::fabs(dot(normal, plane.normal)) >= kParallel;
           });
}

PassingQuery::PassingQuery(const IgnoredSurfaces& surfaces, Point3 from)
    : EmbreeQuery(surfaces.touches() ? passIgnored : nullptr), ignored(surfaces), origin(from) {}

SingleQuery::SingleQuery(const IgnoredSurfaces& surfaces, const Ray& asked)
    : EmbreeQuery(passUnmet), ignored(surfaces), ray(asked) {}

}  // namespace ispace
