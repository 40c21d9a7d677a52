// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/ray_packet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/simd.h"

namespace ispace {

namespace {

ISPACE_INLINE float choose(bool condition, float yes, float no) { return condition ? yes : no; }

}  // namespace

ISPACE_SIMD_CLONES void fillTile(const RayGrid& grid, int column, int row, RayPacket& packet) {
    const int last_column = grid.columns - 1, last_row = grid.rows - 1;
    for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
        const Vec3 ray = grid.ray(std::min(column + lane % kTile, last_column),
                                  std::min(row + lane / kTile, last_row));
        packet.x[static_cast<std::size_t>(lane)] = ray.x;
        packet.y[static_cast<std::size_t>(lane)] = ray.y;
        packet.z[static_cast<std::size_t>(lane)] = ray.z;
    }
}

ISPACE_SIMD_CLONES void roundRays(const RayPacket& packet, double tail, RTCRayHit16& rays) {
    // More than rounding adds to a distance, relative to it.
    constexpr double kFar = 1 + 2e-6;
    constexpr double kMost = 1e30;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        rays.ray.dir_x[lane] = static_cast<float>(packet.x[lane]);
        rays.ray.dir_y[lane] = static_cast<float>(packet.y[lane]);
        rays.ray.dir_z[lane] = static_cast<float>(packet.z[lane]);
        rays.ray.org_x[lane] = static_cast<float>(packet.origin_x[lane]);
        rays.ray.org_y[lane] = static_cast<float>(packet.origin_y[lane]);
        rays.ray.org_z[lane] = static_cast<float>(packet.origin_z[lane]);
        rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    alignas(64) RayPacket::Lanes far;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double reach = packet.reach[lane] * kFar + tail;
        far[lane] = reach < kMost ? reach : kMost;
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        rays.ray.tfar[lane] = static_cast<float>(far[lane]);
}

ISPACE_SIMD_CLONES std::uint32_t meetPlanes(const RTCRayHit16& hits, const Plane* planes,
                                            const double* margins, double clear, float most,
                                            RayPacket& packet) {
    constexpr float kNoReturn = std::numeric_limits<float>::infinity();
    const double* const numbers = &planes->normal.x;
    // In steps, each of which the compiler can vectorise.
    alignas(64) std::array<std::int64_t, kLanes> triangles;
    alignas(64) std::array<float, kLanes> edges;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t hit = hits.hit.primID[lane];
        triangles[lane] = hits.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID ? 0 : hit;
        const float u = hits.hit.u[lane], v = hits.hit.v[lane], w = 1 - u - v;
        const float low = u < v ? u : v;
        edges[lane] = low < w ? low : w;
    }
    std::int64_t other = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) other |= triangles[lane] ^ triangles[0];
    alignas(64) RayPacket::Lanes x, y, z, offset, margin;
    if (other == 0) {
        // Neighbouring rays often meet one triangle, which is then read once.
        const double* const plane = numbers + 4 * triangles[0];
        const double least = margins[triangles[0]];
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            x[lane] = plane[0];
            y[lane] = plane[1];
            z[lane] = plane[2];
            offset[lane] = plane[3];
            margin[lane] = least;
        }
    } else {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const double* const plane = numbers + 4 * triangles[lane];
            x[lane] = plane[0];
            y[lane] = plane[1];
            z[lane] = plane[2];
            offset[lane] = plane[3];
            margin[lane] = margins[triangles[lane]];
        }
    }
    alignas(64) std::array<std::int64_t, kLanes> is_sure, is_met;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double dx = packet.x[lane], dy = packet.y[lane], dz = packet.z[lane];
        const double height =
            offset[lane] - (x[lane] * packet.origin_x[lane] + y[lane] * packet.origin_y[lane] +
                            z[lane] * packet.origin_z[lane]);
        const double slope = x[lane] * dx + y[lane] * dy + z[lane] * dz;
        const double multiple = height / slope;
        packet.multiples[lane] = static_cast<float>(multiple);
        packet.slopes[lane] = static_cast<float>(std::fabs(slope));
        is_met[lane] = multiple <= packet.reach[lane];
        // The cosine is slope / length of the direction, and both sides are positive.
        const double edge = static_cast<double>(edges[lane]), least = margin[lane];
        const bool is_inside =
            edge * edge * (slope * slope) > least * least * (dx * dx + dy * dy + dz * dz);
        is_sure[lane] = is_inside & (edge > 0) & (std::fabs(height) > clear);
    }
    alignas(64) std::array<std::uint32_t, kLanes> care;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool is_hit = hits.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
        is_met[lane] = is_met[lane] & (is_hit ? 1 : 0);
        care[lane] = (is_hit ? 1U : 0U) & (is_sure[lane] != 0 ? 0U : 1U);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float multiple = packet.multiples[lane], slope = packet.slopes[lane];
        const float nearest = multiple < most ? multiple : most;
        packet.multiples[lane] = choose(is_met[lane] != 0, nearest, kNoReturn);
        packet.slopes[lane] = choose(is_met[lane] != 0, slope, kNoReturn);
    }
    std::uint32_t all = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        all |= care[lane] << static_cast<std::uint32_t>(lane);
    return all;
}

}  // namespace ispace
