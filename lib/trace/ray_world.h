// SPDX-License-Identifier: GPL-3.0-or-later
// lib/trace: rays against everything that stands still. Uses layout and below; Embree, TBB inside.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "env/environment.h"
#include "geom/point.h"

namespace ispace {

/// Surfaces that lie this near to a ray's origin do not stop it, in metres: a sensor drawn on a
/// wall looks out of it, on both sides and along it. A ray that ends this near to a surface
/// reaches its end.
constexpr double kContact = 1e-4;

class FacetIndex;

/// An Embree scene (ROBUST flag) of a slice or of the whole mesh.
///
/// Embree finds in float32 which surface a ray meets, with coordinates relative to the middle of
/// the plan; the distance is then computed in doubles from the surface itself, so that it is as
/// exact as the drawing at any place of origin of its coordinates. In a slice, lines are closed
/// sets: a ray through an end point or a common corner is stopped, never slips through. A line or
/// triangle seen exactly from its edge stops nothing by itself. For plans of up to a kilometre.
///
/// Thread-safe once built; the same results for any packet width and number of threads.
class RayWorld {
  public:
    /// What a level sensor at `slice.height` meets: rays must start at that height and be level.
    /// \param packet_width rays traced together: 1, 4, 8, 16 or, for the widest of the processor, 0
    /// \throws std::runtime_error if Embree fails (no memory)
    static RayWorld ofSlice(const Slice& slice, int packet_width = 0);
    /// All bodies and the floor, for rays of any direction.
    static RayWorld ofEnvironment(const Environment& environment, int packet_width = 0);
    RayWorld(RayWorld&&) noexcept;
    RayWorld& operator=(RayWorld&&) noexcept;
    ~RayWorld();

    /// Distance to the first surface along each unit vector, up to max_range inclusive (compared
    /// as float32); +infinity if there is none. Surfaces in contact with the origin are left out.
    /// Fastest for neighbouring directions (16-wide coherent packets).
    /// \pre ranges.size() == directions.size()
    void cast(Point3 origin, std::span<const Vec3> directions, double max_range,
              std::span<float> ranges) const;

    /// seen[i] = 1 if nothing stands between origin and target i, the last kContact metres and
    /// surfaces in contact with the origin left out. Targets in any order; neighbours are fastest.
    /// \pre seen.size() == targets.size()
    void look(Point3 origin, std::span<const Point3> targets, std::span<std::uint8_t> seen) const;

  private:
    explicit RayWorld(std::unique_ptr<FacetIndex> index);
    std::unique_ptr<FacetIndex> index_;
};

}  // namespace ispace
