// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "trace/embree_query.h"
#include "trace/rays.h"
#include "trace/triangle_set.h"

namespace ispace {

/// Rays traced together, in doubles, and what comes of them.
struct alignas(64) RayPacket {
    using Lanes = std::array<double, kLanes>;

    Lanes x, y, z;                       ///< of the directions
    Lanes origin_x, origin_y, origin_z;  ///< of the rays
    Lanes reach;                         ///< in multiples of the directions, inclusive
    /// To where they meet a surface, of its direction: +infinity if a ray meets none.
    std::array<float, kLanes> multiples;
    std::array<float, kLanes> slopes;  ///< |normal times direction|; +infinity likewise

    /// A ray along `way` that ends `before` its end.
    void aim(std::size_t lane, Vec3 way, double before) {
        // Squares of what fits in float32 fit in double: no need of hypot, which takes longer.
        const double distance = std::sqrt(dot(way, way));
        // Nothing stands on a way so short: a ray of no length meets nothing.
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

/// The rays of a square tile of a picture; beyond its edges those at the edge.
constexpr int kTile = 4;
void fillTile(const RayGrid& grid, int column, int row, RayPacket& packet);

/// For Embree, in float32: where the rays begin.
void roundOrigins(const RayPacket& packet, RTCRayHit16& rays);
/// The rest of the rays. `tail` is added to the reach, which decides once the hits are known.
void roundRays(const RayPacket& packet, double tail, RTCRayHit16& rays);

/// Where the rays meet the planes of the triangles hit; multiples are at most `most`.
/// Planes nearer than `clear` to the origin need a closer look, as do hits near an edge.
/// \return a bit for each lane that does
std::uint32_t meetPlanes(const RTCRayHit16& hits, const Plane* planes, const double* margins,
                         double clear, float most, RayPacket& packet);

}  // namespace ispace
