// SPDX-License-Identifier: GPL-3.0-or-later
// lib/trace: rays against everything that stands still. Uses layout and below; Embree inside.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "env/environment.h"
#include "geom/point.h"

namespace ispace {

/// Surfaces this near to a ray's origin do not stop it, in metres, nor does what continues their
/// plane: a sensor drawn on a wall looks out of it, on both sides and along it. A ray that ends
/// this near to a surface reaches its end.
constexpr double kContact = 1e-4;

/// An Embree scene of a slice or of the whole mesh.
///
/// Surfaces are closed sets without thickness: one seen exactly from its edge (within the rounding
/// of float32) stops nothing. The scene is ROBUST, so that no ray slips between surfaces that share
/// an edge or a corner, and that the packet width changes no range by more than rounding.
/// Coordinates are kept relative to the middle of the plan: float32 then is exact to micrometres in
/// a building, wherever its coordinates are counted from. Thread-safe once built; the number of
/// threads changes nothing.
class RayWorld {
  public:
    /// What a level sensor at `slice.height` meets: rays must start at that height and be level.
    /// \param packet_width rays traced together: 4, 8, 16, or 0 for what the processor does best
    /// \throws std::runtime_error if Embree fails (no memory)
    static RayWorld ofSlice(const Slice& slice, int packet_width = 0);
    /// All bodies and the floor, for rays of any direction.
    static RayWorld ofEnvironment(const Environment& environment, int packet_width = 0);
    RayWorld(RayWorld&&) noexcept;
    RayWorld& operator=(RayWorld&&) noexcept;
    ~RayWorld();

    /// Distance to the first surface along each unit vector, up to max_range inclusive; +infinity
    /// if there is none. Fastest for neighbouring directions (coherent packets).
    /// \pre ranges.size() == directions.size()
    void cast(Point3 origin, std::span<const Vec3> directions, double max_range,
              std::span<float> ranges) const;

    /// seen[i] = 1 if nothing stands between origin and target i, the last kContact metres left
    /// out. Targets in any order; neighbours are fastest.
    /// \pre seen.size() == targets.size()
    void look(Point3 origin, std::span<const Point3> targets, std::span<std::uint8_t> seen) const;

  private:
    struct Data;
    explicit RayWorld(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
