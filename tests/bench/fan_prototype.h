// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "trace/rays.h"

namespace ispace::bench {

/// Prototype of level fans, a yardstick for FlatWorld: computes in float32, without cosines and
/// without rules for lines in contact or seen from their edge, whose beams may be wrong. It
/// traverses a hierarchy over the lines front to back, maps the angles of a line's ends to its
/// beams, clips its range along each of them to its nearest and farthest point, and skips lines
/// behind the maximum of a block of beams.
class FanPrototype {
  public:
    explicit FanPrototype(std::span<const Segment2> lines);

    /// Unit vectors of a fan as it wants them.
    struct Fan {
        static constexpr int kBlock = 16;
        std::vector<float> x, y;  ///< whole blocks, the last one filled up with the last beam
        float cos = 1, sin = 0;   ///< of its middle
        float rate = 0;           ///< beams a radian
        int count = 0;
        explicit Fan(const Directions& directions);
    };

    /// Ranges of all whole blocks, +infinity beyond `max_range`. \pre at most 2048 beams
    void cast(Point2 origin, const Fan& fan, float max_range, std::span<float> ranges) const;

  private:
    static constexpr int kWidth = 8;
    struct alignas(32) Node {
        float left[kWidth], right[kWidth], low[kWidth], high[kWidth];
        std::int32_t child[kWidth];
        std::int32_t count;
    };
    struct alignas(32) Leaf {
        float ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth];
        std::int32_t count;
    };
    struct Walk;

    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
};

}  // namespace ispace::bench
