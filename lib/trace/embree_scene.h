// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "trace/directions.h"
#include "trace/ray_grid.h"
#include "trace/triangle_set.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace ispace {

/// A built Embree scene: ROBUST, so that no ray slips between triangles with a common edge (corners
/// in the same places, whether or not they are the same vertices); high quality.
///
/// Embree finds the triangle that a ray meets, in float32. Near an edge, where rounding may choose
/// another, the choice is made again in doubles, and the range is computed in doubles from the
/// triangle's plane: results do not depend on which rays are traced together. (Where surfaces
/// without a common edge cross or touch, float32 alone decides which of them is met by a ray that
/// passes that line within the rounding of the scene, one in some ten millions. Other packets, or
/// another processor, then may give the cosine of the other surface, and a range that differs by
/// some millionths of the scene's extent: 10 micrometres in a room.)
///
/// Surfaces within `contact` of a ray's origin do not stop it, nor do those that continue them, nor
/// those seen exactly from their edge. Each scene has a device of its own: one costs some 50
/// microseconds, and scenes share nothing.
class EmbreeScene {
  public:
    /// `packet_width`: 1, 4, 8 or 16 rays together, 0 for what the processor traces natively.
    /// \throws std::runtime_error if Embree fails, std::bad_alloc if it has no memory
    EmbreeScene(TriangleSoup soup, double contact, int packet_width);

    /// Where results go: ranges, +infinity without return, and |cosines| of ray and normal if they
    /// are wanted, 1 without return.
    struct Results {
        std::span<float> ranges, cosines;
    };

    /// Distance to the first surface along unit vectors, up to most * (1 + 1e-6), but never
    /// written as more than `most`. Neighbouring directions should be alike.
    void cast(Point3 origin, const Directions& directions, double most,
              const Results& results) const;
    void cast(std::span<const Point3> origins, const Directions& directions, double most,
              const Results& results) const;
    /// The same in multiples of a picture's rays, row by row, in square tiles.
    void cast(Point3 origin, const RayGrid& grid, double most, const Results& results) const;
    /// seen[i] = 1 if nothing stands on the first reach[i] metres.
    void look(Point3 origin, const Directions& directions, std::span<const double> reach,
              std::span<std::uint8_t> seen) const;

  private:
    struct Caster;
    struct Release {
        void operator()(RTCDeviceTy* device) const;
        void operator()(RTCSceneTy* scene) const;
    };
    /// If not, no ray from the ball starts in contact with a surface, or so near to one that it
    /// crowds the origin; otherwise one may.
    [[nodiscard]] bool mayTouch(const Ball& origins) const;

    TriangleSet set_;
    double contact_;
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    std::size_t width_ = 4;
};

}  // namespace ispace
