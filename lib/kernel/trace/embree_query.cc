// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_query.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/simd.h"
#include "trace/rays.h"

namespace ispace {

namespace {

/// Surfaces with bounds near a point.
struct NearSurfaces {
    std::size_t triangles;  ///< number of the first round body
    std::vector<std::size_t> found = {};
};

bool collect(RTCPointQueryFunctionArguments* args) {
    auto& near = *static_cast<NearSurfaces*>(args->userPtr);
    near.found.push_back((args->geomID < kRoundGeometries ? 0 : near.triangles) + args->primID);
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

std::vector<std::size_t> surfacesNear(RTCScene scene, const TriangleSet& set, double distance,
                                      Point3 middle) {
    RTCPointQuery query{};
    query.x = static_cast<float>(middle.x);
    query.y = static_cast<float>(middle.y);
    query.z = static_cast<float>(middle.z);
    query.radius = static_cast<float>(distance + set.tolerance());
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    NearSurfaces near{set.triangles()};
    rtcPointQuery(scene, &query, &context, collect, &near);
    return std::move(near.found);
}

IgnoredSurfaces::IgnoredSurfaces(RTCScene scene, const TriangleSet& set, double ray_epsilon,
                                 Point3 origin)
    : IgnoredSurfaces(set, ray_epsilon) {
    for (const std::size_t surface : surfacesNear(scene, set, ray_epsilon, origin))
        set.addTouched(surface, origin, ray_epsilon, normals_);
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

SingleQuery::SingleQuery(const IgnoredSurfaces& surfaces, const RayPacket& packet, std::size_t lane)
    : EmbreeQuery(passUnmet), ignored(surfaces), ray(packet.ray(lane)) {
    rays = {&packet, false, surfaces.rayEpsilon()};
}

namespace {

/// Upper bound of the relative rounding error of a distance.
constexpr double kFar = 1 + 2e-6;

/// Hits of a packet, and their planes.
struct alignas(64) Hits {
    std::array<std::int64_t, kLanes> triangle;  ///< any valid triangle if the ray missed
    std::array<float, kLanes> edge;             ///< least barycentric coordinate
    RayPacket::Lanes x, y, z, offset, margin;
};

ISPACE_INLINE bool isHit(const RTCRayHit16& hits, std::size_t lane) {
    return hits.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
}

ISPACE_INLINE void read(const RTCRayHit16& from, Hits& hits) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t triangle = from.hit.primID[lane];
        hits.triangle[lane] = isHit(from, lane) ? triangle : 0;
        const float u = from.hit.u[lane], v = from.hit.v[lane], w = 1 - u - v;
        const float low = u < v ? u : v;
        hits.edge[lane] = low < w ? low : w;
    }
}

ISPACE_INLINE void gather(const Plane* planes, const double* margins, Hits& hits) {
    const double* const numbers = &planes->normal.x;
    std::int64_t other = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        other |= hits.triangle[lane] ^ hits.triangle[0];
    if (other == 0) {
        // Neighbouring rays often meet one triangle, which is then read once.
        const std::int64_t triangle = hits.triangle[0];
        const double* const plane = numbers + 4 * triangle;
        hits.x.fill(plane[0]);
        hits.y.fill(plane[1]);
        hits.z.fill(plane[2]);
        hits.offset.fill(plane[3]);
        hits.margin.fill(margins[triangle]);
    } else {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const double* const plane = numbers + 4 * hits.triangle[lane];
            hits.x[lane] = plane[0];
            hits.y[lane] = plane[1];
            hits.z[lane] = plane[2];
            hits.offset[lane] = plane[3];
            hits.margin[lane] = margins[hits.triangle[lane]];
        }
    }
}

}  // namespace

TileRow::TileRow(const RayGrid& grid, int row)
    : corner(grid.corner), right(grid.right), last_column(grid.columns - 1) {
    for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
        const double j = std::min(row + lane / kTile, grid.rows - 1);
        x[static_cast<std::size_t>(lane)] = j * grid.down.x;
        y[static_cast<std::size_t>(lane)] = j * grid.down.y;
        z[static_cast<std::size_t>(lane)] = j * grid.down.z;
    }
}

ISPACE_SIMD_CLONES void roundOrigins(const RayPacket& packet, RTCRayHit16& rays) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        rays.ray.org_x[lane] = static_cast<float>(packet.origin_x[lane]);
        rays.ray.org_y[lane] = static_cast<float>(packet.origin_y[lane]);
        rays.ray.org_z[lane] = static_cast<float>(packet.origin_z[lane]);
    }
}

ISPACE_SIMD_CLONES void roundReach(const RayPacket& packet, double tail,
                                   std::array<float, kLanes>& far) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double reach = packet.reach[lane] * kFar + tail;
        far[lane] = static_cast<float>(reach < kMaxRayReach ? reach : kMaxRayReach);
    }
}

namespace {

ISPACE_INLINE void roundDirections(const RayPacket& packet, const std::array<float, kLanes>& far,
                                   RTCRayHit16& rays) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        rays.ray.dir_x[lane] = static_cast<float>(packet.x[lane]);
        rays.ray.dir_y[lane] = static_cast<float>(packet.y[lane]);
        rays.ray.dir_z[lane] = static_cast<float>(packet.z[lane]);
        rays.ray.tfar[lane] = far[lane];
        rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

/// Columns of a tile's rays from its first.
alignas(64) constexpr RayPacket::Lanes kAside{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
static_assert(kTile == 4);

}  // namespace

ISPACE_SIMD_CLONES void roundRays(const RayPacket& packet, const std::array<float, kLanes>& far,
                                  RTCRayHit16& rays) {
    roundDirections(packet, far, rays);
}

ISPACE_SIMD_CLONES void aimTile(const TileRow& row, int column,
                                const std::array<float, kLanes>& far, RayPacket& packet,
                                RTCRayHit16& rays) {
    const Vec3 corner = row.corner, right = row.right;
    const double first = column, last = row.last_column;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double unlimited = first + kAside[lane], i = unlimited < last ? unlimited : last;
        packet.x[lane] = corner.x + i * right.x + row.x[lane];
        packet.y[lane] = corner.y + i * right.y + row.y[lane];
        packet.z[lane] = corner.z + i * right.z + row.z[lane];
    }
    roundDirections(packet, far, rays);
}

ISPACE_SIMD_CLONES std::uint32_t meetPlanes(const RTCRayHit16& hits, const Plane* planes,
                                            const double* margins, double clear, float most,
                                            RayPacket& packet) {
    // In steps, each of which the compiler can vectorise.
    Hits met;
    read(hits, met);
    gather(planes, margins, met);
    alignas(64) std::array<std::int64_t, kLanes> is_sure, is_met;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double dx = packet.x[lane], dy = packet.y[lane], dz = packet.z[lane];
        const double height = met.offset[lane] - (met.x[lane] * packet.origin_x[lane] +
                                                  met.y[lane] * packet.origin_y[lane] +
                                                  met.z[lane] * packet.origin_z[lane]);
        const double slope = met.x[lane] * dx + met.y[lane] * dy + met.z[lane] * dz;
        const double multiple = height / slope;
        packet.multiples[lane] = static_cast<float>(multiple);
        packet.slopes[lane] = static_cast<float>(std::fabs(slope));
        is_met[lane] = multiple <= packet.reach[lane];
        // The cosine is slope / length of the direction, and both sides are positive.
        const double edge = static_cast<double>(met.edge[lane]), least = met.margin[lane];
        const bool is_inside =
            edge * edge * (slope * slope) > least * least * (dx * dx + dy * dy + dz * dz);
        is_sure[lane] = is_inside & (edge > 0) & (std::fabs(height) > clear);
    }
    alignas(64) std::array<std::uint32_t, kLanes> care;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool is_hit = isHit(hits, lane);
        is_met[lane] = is_met[lane] & (is_hit ? 1 : 0);
        care[lane] = (is_hit ? 1U : 0U) & (is_sure[lane] != 0 ? 0U : 1U);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float multiple = packet.multiples[lane], slope = packet.slopes[lane];
        const float nearest = multiple < most ? multiple : most;
        packet.multiples[lane] = simd::choose(is_met[lane] != 0, nearest, kNoReturn);
        packet.slopes[lane] = simd::choose(is_met[lane] != 0, slope, kNoReturn);
    }
    std::uint32_t all = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        all |= care[lane] << static_cast<std::uint32_t>(lane);
    return all;
}

ISPACE_SIMD_CLONES bool meetOnePlane(const RTCRayHit16& hits, const Plane* planes,
                                     const double* margins, const SureMeeting& sure,
                                     RayPacket& packet) {
    const std::uint32_t triangle = hits.hit.primID[0];
    std::uint32_t other = 0, missed = ~0U;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        other |= (hits.hit.primID[lane] ^ triangle) | hits.hit.geomID[lane];
        missed &= hits.hit.geomID[lane];
    }
    if (other != 0) {
        if (missed != RTC_INVALID_GEOMETRY_ID) return false;
        packet.multiples.fill(kNoReturn);
        packet.slopes.fill(kNoReturn);
        return true;
    }
    const Plane& plane = planes[triangle];
    const double height =
        plane.heightOver({packet.origin_x[0], packet.origin_y[0], packet.origin_z[0]});
    if (!(std::fabs(height) > sure.clear)) return false;
    alignas(64) std::array<float, kLanes> multiples, slopes;  // NOLINT: set in the loop
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double slope = plane.normal.x * packet.x[lane] + plane.normal.y * packet.y[lane] +
                             plane.normal.z * packet.z[lane];
        multiples[lane] = static_cast<float>(height / slope);
        slopes[lane] = static_cast<float>(std::fabs(slope));
    }
    // Margin for rounding.
    const auto least = static_cast<float>(margins[triangle] * sure.longest * kFar);
    std::uint32_t doubt = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float u = hits.hit.u[lane], v = hits.hit.v[lane], w = 1 - u - v;
        const float low = u < v ? u : v;
        const float edge = low < w ? low : w;
        doubt |= edge * slopes[lane] > least ? 0U : 1U;
        doubt |= multiples[lane] < sure.near ? 0U : 1U;
    }
    if (doubt != 0) return false;
    packet.multiples = multiples;
    packet.slopes = slopes;
    return true;
}

}  // namespace ispace
