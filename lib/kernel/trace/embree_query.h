// SPDX-License-Identifier: GPL-3.0-or-later
// Embree's queries with intersections in doubles. Private to lib/kernel/trace and its render.
//
// A packet holds 16 rays in doubles. Embree searches its tree in float32 and returns the surface of
// each ray; planes are then met in doubles, all lanes of the packet in one loop. A ray close to an
// edge, or to a surface at its origin, takes the exact test: one ray after another, through a
// filter that skips ignored surfaces. Supports Embree 3 and 4, which differ in how a query is
// passed.
//
// One query object per thread. Results of a lane depend on its ray alone, except near edges, where
// Embree's choice of two triangles may depend on the packet (see EmbreeScene).
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "trace/embree_device.h"
#include "trace/rays.h"
#include "trace/triangle_set.h"

namespace ispace {

struct RayPacket;

/// The rays of a query in doubles, for Embree's callbacks.
struct ExactRays {
    const RayPacket* packet = nullptr;  ///< by the ids of the rays; null: as Embree has them
    bool have_one_origin = false;
    double ray_epsilon = 0;  ///< see meetRound()
};

// A query for Embree 3 or 4. Its context is the first member, so that callbacks can cast back to
// the query.
#if RTC_VERSION_MAJOR >= 4
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
struct EmbreeQuery {
    RTCRayQueryContext context;
    RTCIntersectArguments arguments;
    ExactRays rays;

    explicit EmbreeQuery(RTCFilterFunctionN filter = nullptr) {
        rtcInitRayQueryContext(&context);
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
        if (filter == nullptr) return;
        arguments.filter = filter;
        arguments.flags = static_cast<RTCRayQueryFlags>(arguments.flags |
                                                        RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
    }
    template <auto kCall, typename Rays>
    void trace(const int* valid, RTCScene scene, Rays* rays) {
        if constexpr (std::is_invocable_v<decltype(kCall), const int*, RTCScene, Rays*,
                                          RTCIntersectArguments*>) {
            kCall(valid, scene, rays, &arguments);
        } else {
            RTCOccludedArguments occluded;
            rtcInitOccludedArguments(&occluded);
            occluded.context = &context;
            occluded.flags = arguments.flags;
            occluded.filter = arguments.filter;
            kCall(valid, scene, rays, &occluded);
        }
    }
    void trace(RTCScene scene, RTCRayHit* ray) { rtcIntersect1(scene, ray, &arguments); }
    void makeIncoherent() {
        arguments.flags =
            static_cast<RTCRayQueryFlags>(arguments.flags & ~RTC_RAY_QUERY_FLAG_COHERENT);
    }
};
#else
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
struct EmbreeQuery {
    RTCIntersectContext context;
    ExactRays rays;

    explicit EmbreeQuery(RTCFilterFunctionN filter = nullptr) {
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        context.filter = filter;
    }
    template <auto kCall, typename Rays>
    void trace(const int* valid, RTCScene scene, Rays* rays) {
        kCall(valid, scene, &context, rays);
    }
    void trace(RTCScene scene, RTCRayHit* ray) { rtcIntersect1(scene, &context, ray); }
    void makeIncoherent() { context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT; }
};
#endif

/// Adds a geometry with primitives set by fill(geometry).
/// \throws as throwIfEmbreeFailed()
template <typename Fill>
void attachGeometry(RTCDevice device, RTCScene scene, RTCGeometryType type, unsigned geometry_id,
                    Fill fill) {
    const RTCGeometry geometry = rtcNewGeometry(device, type);
    throwIfEmbreeFailed(device);
    rtcAttachGeometryByID(scene, geometry, geometry_id);
    rtcReleaseGeometry(geometry);  // the scene holds it
    fill(geometry);
    rtcCommitGeometry(geometry);
}

/// Geometry ids of round bodies: those of the surfaces they belong to plus this.
constexpr unsigned kRoundGeometries = 1U << 8U;

/// Embree's callbacks of bodies with intersections computed in doubles.
struct BodyCallbacks {
    RTCBoundsFunction bounds;
    RTCIntersectFunctionN intersect;
    RTCOccludedFunctionN occlude;
};

/// Adds bodies, which stay at their address while the scene lives; none for an empty list.
/// \throws as throwIfEmbreeFailed()
template <typename SomeBody>
void attachBodies(RTCDevice device, RTCScene scene, std::span<const SomeBody> bodies,
                  unsigned geometry_id, const BodyCallbacks& callbacks) {
    if (bodies.empty()) return;
    attachGeometry(device, scene, RTC_GEOMETRY_TYPE_USER, geometry_id, [&](RTCGeometry geometry) {
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(bodies.size()));
        // Read-only use; Embree's interface lacks const.
        rtcSetGeometryUserData(geometry, const_cast<SomeBody*>(bodies.data()));  // NOLINT
        rtcSetGeometryBoundsFunction(geometry, callbacks.bounds, nullptr);
        rtcSetGeometryIntersectFunction(geometry, callbacks.intersect);
        rtcSetGeometryOccludedFunction(geometry, callbacks.occlude);
    });
}

/// Sets a body's bounds, enlarged by more than the float32 rounding of rays and corners.
inline void setBounds(const Box2& plan, double bottom, double top, RTCBounds& box) {
    const double far = std::max({std::fabs(plan.low.x), std::fabs(plan.low.y),
                                 std::fabs(plan.high.x), std::fabs(plan.high.y), top});
    const double slack = 1e-6 * (1 + far);
    const auto low = [&](double at) { return static_cast<float>(at - slack); };
    const auto high = [&](double at) { return static_cast<float>(at + slack); };
    box.lower_x = low(plan.low.x);
    box.lower_y = low(plan.low.y);
    box.lower_z = low(bottom);
    box.upper_x = high(plan.high.x);
    box.upper_y = high(plan.high.y);
    box.upper_z = high(top);
}

/// Records a body that a ray meets.
inline void setHit(const RTCIntersectFunctionNArguments& args, unsigned ray, float multiple,
                   unsigned geometry_id, unsigned surface) {
    RTCHitN* const hits = RTCRayHitN_HitN(args.rayhit, args.N);
    RTCRayN_tfar(RTCRayHitN_RayN(args.rayhit, args.N), args.N, ray) = multiple;
    RTCHitN_primID(hits, args.N, ray) = surface;
    RTCHitN_geomID(hits, args.N, ray) = geometry_id;
    RTCHitN_instID(hits, args.N, ray, 0) = args.context->instID[0];
}

/// Records that a body stops a ray.
inline void setOccluded(const RTCOccludedFunctionNArguments& args, unsigned ray) {
    RTCRayN_tfar(args.ray, args.N, ray) = -std::numeric_limits<float>::infinity();
}

/// Builds a scene, ROBUST and of high quality, of the geometries that attach_all(scene) attaches.
/// \throws as throwIfEmbreeFailed()
template <typename AttachAll>
EmbreeSceneHandle buildScene(RTCDevice device, AttachAll attach_all) {
    EmbreeSceneHandle scene(rtcNewScene(device));
    throwIfEmbreeFailed(device);
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | kFilterFlag);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
    attach_all(scene.get());
    rtcCommitScene(scene.get());
    throwIfEmbreeFailed(device);
    return scene;
}

/// Maximum length of Embree's rays.
constexpr double kMaxRayReach = 1e30;

/// Number of lanes in a packet, independent of the width in which Embree traces it.
constexpr std::size_t kLanes = 16;

/// Traces the lanes of a packet in parts as wide as Rays by calling trace(valid, rays).
template <typename Rays, std::size_t kWidth, typename Packet, typename Trace>
void traceParts(const int* valid, Packet& packet, Trace trace) {
    // All fields are arrays of four bytes a lane.
    constexpr std::size_t kFields = sizeof(Packet) / (4 * kLanes);
    static_assert(sizeof(Rays) >= 4 * kFields * kWidth);
    auto* const wide = reinterpret_cast<std::uint32_t*>(&packet);
    Rays rays{};
    auto* const narrow = reinterpret_cast<std::uint32_t*>(&rays);
    for (std::size_t begin = 0; begin < kLanes; begin += kWidth) {
        if (valid[begin] == 0) continue;
        for (std::size_t k = 0; k < kFields; ++k)
            std::memcpy(narrow + k * kWidth, wide + k * kLanes + begin, 4 * kWidth);
        trace(valid + begin, &rays);
        for (std::size_t k = 0; k < kFields; ++k)
            std::memcpy(wide + k * kLanes + begin, narrow + k * kWidth, 4 * kWidth);
    }
}

/// Traces a packet in parts of 1, 4, 8 or 16 lanes. \pre valid lanes come first
inline void tracePacket(EmbreeQuery& query, RTCScene scene, std::size_t width, const int* valid,
                        RTCRayHit16& packet) {
    switch (width) {
        case 16:
            return query.trace<rtcIntersect16>(valid, scene, &packet);
        case 8:
            return traceParts<RTCRayHit8, 8>(valid, packet,
                                             [&](const int* lanes, RTCRayHit8* rays) {
                                                 query.trace<rtcIntersect8>(lanes, scene, rays);
                                             });
        case 4:
            return traceParts<RTCRayHit4, 4>(valid, packet,
                                             [&](const int* lanes, RTCRayHit4* rays) {
                                                 query.trace<rtcIntersect4>(lanes, scene, rays);
                                             });
        default:
            return traceParts<RTCRayHit, 1>(
                valid, packet, [&](const int*, RTCRayHit* ray) { query.trace(scene, ray); });
    }
}

/// Sets tfar of the rays that hit a surface to -infinity; parts and lanes as in tracePacket().
inline void traceShadows(EmbreeQuery& query, RTCScene scene, std::size_t width, const int* valid,
                         RTCRay16& packet) {
    switch (width) {
        case 16:
            return query.trace<rtcOccluded16>(valid, scene, &packet);
        case 8:
            return traceParts<RTCRay8, 8>(valid, packet, [&](const int* lanes, RTCRay8* rays) {
                query.trace<rtcOccluded8>(lanes, scene, rays);
            });
        default:
            return traceParts<RTCRay4, 4>(valid, packet, [&](const int* lanes, RTCRay4* rays) {
                query.trace<rtcOccluded4>(lanes, scene, rays);
            });
    }
}

/// Returns all surfaces within a distance of a point, and some farther away.
std::vector<std::size_t> surfacesNear(RTCScene scene, const TriangleSet& set, double distance,
                                      Point3 middle);

/// The surfaces ignored by rays of one origin: those within `ray_epsilon` of it, those that
/// continue the plane of such a surface within that distance, and those seen exactly edge-on.
class IgnoredSurfaces {
  public:
    /// A surface with a plane this near to the origin, in metres, is seen edge-on: the error of a
    /// corner in float32 for coordinates of a building.
    static constexpr double kEdgeOn = 5e-6;

    /// For an origin without surfaces nearby.
    IgnoredSurfaces(const TriangleSet& set, double ray_epsilon)
        : set_(set), ray_epsilon_(ray_epsilon) {}
    IgnoredSurfaces(RTCScene scene, const TriangleSet& set, double ray_epsilon, Point3 origin);

    [[nodiscard]] bool touches() const { return !normals_.empty(); }
    /// Surfaces stop rays if their planes are farther from the origin than this.
    [[nodiscard]] double reach() const { return touches() ? ray_epsilon_ : kEdgeOn; }
    [[nodiscard]] bool contains(std::size_t triangle, Point3 origin) const;
    [[nodiscard]] double rayEpsilon() const { return ray_epsilon_; }
    /// Computes the intersection with a surface found by Embree, if it stops the ray.
    [[nodiscard]] RayHit meet(std::size_t triangle, const Ray& ray) const {
        if (set_.roundOf(triangle) == nullptr && contains(triangle, ray.origin)) return {};
        return set_.meet(triangle, ray, ray_epsilon_);
    }

  private:
    const TriangleSet& set_;
    double ray_epsilon_;
    std::vector<Vec3> normals_;  // of the surfaces within ray_epsilon_
};

/// A query for rays from one origin that skips ignored surfaces.
struct PassingQuery : EmbreeQuery {
    const IgnoredSurfaces& ignored;
    Point3 origin;

    PassingQuery(const IgnoredSurfaces& surfaces, Point3 from);
};

/// A query for one ray of a packet, its number the ray's id, that skips surfaces which do not stop
/// it.
struct SingleQuery : EmbreeQuery {
    const IgnoredSurfaces& ignored;
    Ray ray;

    SingleQuery(const IgnoredSurfaces& surfaces, const RayPacket& packet, std::size_t lane);
};

/// Rays traced together, in doubles, and their hits.
struct alignas(64) RayPacket {
    using Lanes = std::array<double, kLanes>;

    Lanes x, y, z;                       ///< of the directions
    Lanes origin_x, origin_y, origin_z;  ///< of the rays
    Lanes reach;                         ///< limit in multiples of the directions, inclusive
    /// Multiples of the directions at the hits: +infinity if a ray meets no surface.
    std::array<float, kLanes> multiples;
    std::array<float, kLanes> slopes;  ///< |normal times direction|; +infinity without hit

    /// Sets a ray along `way` that ends `before` its end.
    void aim(std::size_t lane, Vec3 way, double before) {
        // Squares of float32 values fit in double: no need for hypot, which is slower.
        const double distance = std::sqrt(dot(way, way));
        // Too short for an obstacle: a ray without length has no hit.
        const bool is_short = distance <= 2 * before;
        const Vec3 direction = is_short ? Vec3{1, 0, 0} : (1 / distance) * way;
        x[lane] = direction.x;
        y[lane] = direction.y;
        z[lane] = direction.z;
        reach[lane] = is_short ? 0 : distance - before;
    }
    [[nodiscard]] Ray ray(std::size_t lane) const {
        return {{origin_x[lane], origin_y[lane], origin_z[lane]},
                {x[lane], y[lane], z[lane]},
                reach[lane]};
    }
};

/// Pictures are traced in square tiles of this many columns and rows; tiles at the edges repeat the
/// outermost rays.
constexpr int kTile = 4;

/// Values shared by the rays of a row of tiles.
struct TileRow {
    Vec3 corner, right;
    double last_column;
    alignas(64) RayPacket::Lanes x, y, z;  ///< part of each ray that depends on its row of pixels

    TileRow(const RayGrid& grid, int row);
};

/// Converts the origins to float32 for Embree.
void roundOrigins(const RayPacket& packet, RTCRayHit16& rays);
/// Converts the limits. `tail` is added to the reach; the exact limit is applied to the hits.
void roundReach(const RayPacket& packet, double tail, std::array<float, kLanes>& far);
/// Converts the rest of the rays, up to `far`.
void roundRays(const RayPacket& packet, const std::array<float, kLanes>& far, RTCRayHit16& rays);
/// The same for the rays of a tile, which it computes.
void aimTile(const TileRow& row, int column, const std::array<float, kLanes>& far,
             RayPacket& packet, RTCRayHit16& rays);

/// Computes the intersections with the planes of the triangles hit; multiples are at most `most`.
/// \return a bit for each lane that needs the exact test, because its plane is nearer than `clear`
/// to the origin or its hit is near an edge
std::uint32_t meetPlanes(const RTCRayHit16& hits, const Plane* planes, const double* margins,
                         double clear, float most, RayPacket& packet);

/// Limits within which rays from one origin need no exact test.
struct SureMeeting {
    double clear;    ///< minimum distance of planes from the origin
    double longest;  ///< upper bound of the directions' lengths
    float near;      ///< upper bound of multiples
};

/// A fast path of meetPlanes() for the usual packets: all rays hit one triangle without needing the
/// exact test, or all rays miss. \pre all rays have one origin, and the geometry hit is number 0
/// \return false if the packet is of another kind; then the output is unchanged
bool meetOnePlane(const RTCRayHit16& hits, const Plane* planes, const double* margins,
                  const SureMeeting& sure, RayPacket& packet);

}  // namespace ispace
