// SPDX-License-Identifier: GPL-3.0-or-later
// lib/trace: rays against everything that stands still. Uses layout and below; Embree inside.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "env/environment.h"
#include "env/mesh.h"
#include "geom/point.h"
#include "geom/visibility.h"  // kRayEpsilon
#include "trace/rays.h"

namespace ispace {

/// Rays against a slice (a FlatWorld) or against the whole mesh (an EmbreeScene).
///
/// Surfaces are closed sets without thickness: one seen exactly from its edge stops nothing (within
/// the rounding of float32 in the mesh). Surfaces within kRayEpsilon of a ray's origin do not stop
/// it, nor does what continues their plane: a sensor drawn on a wall looks out of it, on both sides
/// and along it. No ray slips between surfaces that touch; what a ray meets decides its range,
/// computed in doubles. Round bodies are met on their curves. Coordinates are kept relative to the
/// middle of the plan: float32, in which the mesh is searched, then is exact to micrometres in a
/// building, wherever its coordinates are counted from. Thread-safe once built; the number of
/// threads changes nothing.
class RayWorld {
  public:
    /// What a level sensor at `slice.height` meets: rays must start at that height and be level (z
    /// does not count).
    static RayWorld ofSlice(const Slice& slice);
    /// These surfaces of all bodies and the floor, for rays of any direction: of light unless told
    /// otherwise, which pass clear glass as level ones do.
    /// \param packet_width rays Embree traces together: 1, 4, 8, 16, or 0 for what the processor
    ///        does best; it changes no result but as cast() says
    /// \throws std::runtime_error if Embree fails (no memory)
    static RayWorld ofEnvironment(const Environment& environment,
                                  Surfaces surfaces = Surfaces::Opaque, int packet_width = 0);
    RayWorld(RayWorld&&) noexcept;
    RayWorld& operator=(RayWorld&&) noexcept;
    ~RayWorld();

    /// Distance to the first surface along each direction, up to max_range inclusive; +infinity if
    /// there is none. Fastest for neighbouring directions (coherent packets), and in a slice for
    /// directions with an arc. The same for any packet width and however rays are put together, but
    /// for rays of the mesh that pass an edge within what float32 tells: see EmbreeScene, which
    /// says what a range is good to. In a slice it is exact to rounding of doubles.
    /// `cosines`, if not empty: |cosine| of the angle between ray and surface normal, 1 without
    /// return. \pre ranges.size() == directions.size(), cosines.size() as well or 0
    void cast(Point3 origin, const Directions& directions, double max_range,
              std::span<float> ranges, std::span<float> cosines = {}) const;
    /// The same with an origin for each ray.
    void cast(std::span<const Point3> origins, const Directions& directions, double max_range,
              std::span<float> ranges, std::span<float> cosines = {}) const;
    /// The same for the rays of a picture, row by row: how many times a ray's vector reaches to the
    /// first surface, up to `most` times inclusive. Traced in square tiles. \pre not of a slice
    void cast(Point3 origin, const RayGrid& grid, double most, std::span<float> multiples,
              std::span<float> cosines = {}) const;

    /// seen[i] = 1 if nothing stands between origin and target i, the last kRayEpsilon metres left
    /// out. Targets in any order; neighbours are fastest.
    /// \pre not of a slice; seen.size() == targets.size()
    void look(Point3 origin, std::span<const Point3> targets, std::span<std::uint8_t> seen) const;

  private:
    struct Data;
    explicit RayWorld(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
