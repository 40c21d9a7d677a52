// SPDX-License-Identifier: GPL-3.0-or-later
// Intersects round bodies with packets of rays, for Embree. Private to lib/kernel/trace.
//
// The values that all rays of an origin share are computed once, and the lanes of a packet in one
// loop without branches. Cases of upright rays, of origins near or in the body and of several
// origins are left to meetRound(), so the two agree to the last bit (round_view_test).
#pragma once

#include <array>
#include <span>

#include "trace/embree_query.h"
#include "trace/triangle_set.h"

namespace ispace {

/// A round body as seen from a point well outside of it. Computes meetRound() for a packet of rays,
/// with identical results to the last bit.
class RoundView {
  public:
    RoundView() = default;
    /// \param ray_epsilon as in meetRound() \pre `body` outlives it
    RoundView(const RoundBody& body, Point3 origin, double ray_epsilon);

    [[nodiscard]] const RoundBody* body() const { return body_; }
    /// Computes the packet's intersections, +infinity for rays that miss. Uses the first ray's
    /// origin for all.
    /// \return false, without results, if a ray or the origin needs the exact test
    [[nodiscard]] bool meet(const RayPacket& packet, std::array<float, kLanes>& multiples) const;

  private:
    const RoundBody* body_ = nullptr;
    bool is_far_ = false;
};

/// Adds round bodies to a scene; hits hold `geometry_id` and the number of the surface. Embree
/// searches bounding boxes; ExactRays are met in doubles.
/// \pre the bodies stay at the same address while the scene lives
/// \throws as throwIfEmbreeFailed()
void attachRounds(RTCDevice device, RTCScene scene,
                  std::span<const TriangleSet::RoundSurface> rounds, unsigned geometry_id);

}  // namespace ispace
