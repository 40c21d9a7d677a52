// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/trace: rays against triangles and round bodies that do not move, by Embree.
//
//     const EmbreeScene built(soup, kRayEpsilon, 0);
//     built.cast({2, 1, 0.3}, directions, 8, {ranges, {}});  // metres; +infinity without return
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "trace/embree_device.h"
#include "trace/rays.h"
#include "trace/triangle_set.h"

namespace ispace {

/// A built Embree scene: ROBUST and of high quality (I. Wald et al., Embree: a kernel framework for
/// efficient CPU ray tracing, 2014).
///
/// Accuracy: Embree finds the triangle of a ray in float32; the range is computed in doubles. The
/// result is therefore that of a ray within a few TriangleSet::tolerance()s of the requested one,
/// each 2^-21 of the scene's diagonal: 5 micrometres in a room of 10 m, 50 in a building of 100 m.
/// From an origin outside the scene the error grows in proportion to the distance. Well inside a
/// surface the range is exact to the last bit of float32. A ray that touches a rim meets it, and
/// rays cannot slip between touching surfaces. A ray that passes an edge within the tolerance may
/// get the range and cosine of either side, depending on packet width and neighbouring rays.
/// Surfaces narrower than a few tolerances may be missed.
///
/// Rays ignore surfaces within `ray_epsilon` of their origin, continuations of their planes, and
/// surfaces seen exactly edge-on. Each scene creates an Embree device, which takes some 50
/// microseconds; scenes share no state. Thread-safe once built.
class EmbreeScene {
  public:
    /// \param packet_width rays traced together: 1, 4, 8 or 16; 0 for the processor's native width
    /// \throws std::runtime_error if Embree fails, std::bad_alloc if it is out of memory
    EmbreeScene(const TriangleSoup& soup, double ray_epsilon, int packet_width);

    /// Output arrays: ranges, +infinity without return, and, if not empty, |cosines| of ray and
    /// normal, 1 without return.
    struct Results {
        std::span<float> ranges, cosines;
    };

    /// Computes the distance to the first surface along unit vectors. Surfaces up to most * (1 +
    /// 1e-6) count; ranges never exceed `most`. Fastest if neighbouring directions are similar.
    void cast(Point3 origin, const Directions& directions, double most,
              const Results& results) const;
    void cast(std::span<const Point3> origins, const Directions& directions, double most,
              const Results& results) const;
    /// The same in multiples of a picture's rays, row by row, traced in square tiles.
    void cast(Point3 origin, const RayGrid& grid, double most, const Results& results) const;
    /// Sets seen[i] = 1 if the way from the origin to target i is free, ignoring its last
    /// `ray_epsilon`.
    void query(Point3 origin, std::span<const Point3> targets, std::span<std::uint8_t> seen) const;

  private:
    struct Caster;
    /// Returns all surfaces within ray_epsilon_ of an origin, and others near them.
    [[nodiscard]] std::vector<std::size_t> surfacesAbout(std::span<const Point3> origins) const;
    /// True if an origin lies within ray_epsilon_ of a surface. Fastest for runs of equal origins.
    [[nodiscard]] bool touches(std::span<const Point3> origins) const;

    TriangleSet set_;
    double ray_epsilon_;
    EmbreeDevice device_;
    EmbreeSceneHandle scene_;
    std::size_t width_ = 4;
};

}  // namespace ispace
