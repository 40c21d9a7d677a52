// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "trace/embree_device.h"
#include "trace/rays.h"
#include "trace/triangle_set.h"

namespace ispace {

/// A built Embree scene: ROBUST and of high quality.
///
/// Accuracy: Embree decides in float32 which triangle a ray meets; the range is computed in
/// doubles. So the answer is that of some ray within a few TriangleSet::tolerance()s of the one
/// asked for, each 2^-21 of the scene's diagonal: 5 micrometres in a room of 10 m, 50 in a building
/// of 100 m. From an origin outside the scene the error grows in proportion to the distance. Well
/// inside a surface the range is exact to the last bit of float32. A ray that touches a rim meets
/// it, and none slips between surfaces that touch. One that passes an edge within the tolerance may
/// get the range and cosine of either side, depending on packet width and neighbouring rays.
/// Surfaces narrower than a few tolerances may be missed.
///
/// Surfaces within `ray_epsilon` of a ray's origin do not stop it, nor do those that continue their
/// plane, nor those seen exactly edge-on. Each scene has a device of its own, which costs some 50
/// microseconds; scenes share nothing.
class EmbreeScene {
  public:
    /// `packet_width`: 1, 4, 8 or 16 rays together, 0 for what the processor traces natively.
    /// \throws std::runtime_error if Embree fails, std::bad_alloc if it has no memory
    EmbreeScene(const TriangleSoup& soup, double ray_epsilon, int packet_width);

    /// Where results go: ranges, +infinity without return, and, if not empty, |cosines| of ray and
    /// normal, 1 without return.
    struct Results {
        std::span<float> ranges, cosines;
    };

    /// Distance to the first surface along unit vectors. Surfaces up to most * (1 + 1e-6) count;
    /// ranges never exceed `most`. Neighbouring directions should be alike.
    void cast(Point3 origin, const Directions& directions, double most,
              const Results& results) const;
    void cast(std::span<const Point3> origins, const Directions& directions, double most,
              const Results& results) const;
    /// The same in multiples of a picture's rays, row by row, in square tiles.
    void cast(Point3 origin, const RayGrid& grid, double most, const Results& results) const;
    /// seen[i] = 1 if nothing stands between origin and target i, the last `ray_epsilon` left out.
    void query(Point3 origin, std::span<const Point3> targets, std::span<std::uint8_t> seen) const;

  private:
    struct Caster;
    /// True if one of these may lie within ray_epsilon_ of a surface.
    [[nodiscard]] bool mayTouch(std::span<const Point3> origins) const;

    TriangleSet set_;
    double ray_epsilon_;
    EmbreeDevice device_;
    EmbreeSceneHandle scene_;
    std::size_t width_ = 4;
};

}  // namespace ispace
