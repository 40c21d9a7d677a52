// SPDX-License-Identifier: GPL-3.0-or-later
// Private to EmbreeScene: round bodies and packets of rays.
#pragma once

#include <array>

#include "trace/embree_query.h"
#include "trace/triangle_set.h"

namespace ispace {

/// A round body as seen from a place well outside of it. What TriangleSet::meet() finds for one ray
/// this finds for a packet, to the last bit.
class RoundView {
  public:
    RoundView() = default;
    /// `ray_epsilon` as TriangleSet::meet() has it.
    RoundView(const RoundBody& body, Point3 origin, double ray_epsilon);

    [[nodiscard]] const RoundBody* body() const { return body_; }
    /// Where the packet's rays meet it, +infinity where they do not. Only the first ray's origin
    /// counts.
    /// \return false if a ray, or the place, needs a closer look; then nothing is set
    [[nodiscard]] bool meet(const RayPacket& packet, std::array<float, kLanes>& multiples) const;

  private:
    const RoundBody* body_ = nullptr;
    bool is_far_ = false;
};

}  // namespace ispace
