// SPDX-License-Identifier: GPL-3.0-or-later
// Private to FlatWorld: three ways to find what level rays meet first, which agree to the last bit.
#pragma once

#include "geom/point.h"
#include "trace/flat_shapes.h"
#include "trace/flat_tree.h"

namespace ispace {

/// What lines are seen from.
struct FlatView {
    double x, y;
    double ray_epsilon;
};

/// False if nothing at this distance or beyond is as near as what was met, whatever the rounding.
ISPACE_INLINE bool mayBeNearer(double distance, double inverse_range_met) {
    return distance * inverse_range_met <= 1 + 1e-12;
}

/// Children of nodes to be visited, the nearest of a node first.
class FlatStack {
  public:
    struct Entry {
        double distance;
        std::int32_t child;
    };

    [[nodiscard]] bool empty() const { return count_ == 0; }
    ISPACE_INLINE Entry pop() { return entries_[--count_]; }
    /// Those whose distance is not negative.
    ISPACE_INLINE void push(const FlatTree::Node& node, const double* distances) {
        const int bottom = count_;
        for (int i = 0; i < node.count; ++i) {
            if (distances[i] < 0) continue;
            int place = count_++;
            for (; place > bottom && entries_[place - 1].distance < distances[i]; --place)
                entries_[place] = entries_[place - 1];
            entries_[place] = {distances[i], node.child[i]};
        }
    }

  private:
    Entry entries_[FlatTree::kStack];
    int count_ = 0;
};

/// Beams from one origin at equal steps counter-clockwise, at most a full turn, and what they have
/// met so far.
struct alignas(64) FlatScan {
    static constexpr int kBlock = 8;  ///< beams whose least inverse range is kept
    static constexpr int kMax = 2048;
    /// Least number of beams, and most of the step in radians: the middle of a scan is that of its
    /// middle beams.
    static constexpr int kMin = 3;
    static constexpr double kMaxStep = 3, kMinStep = 1e-10;

    double x[kMax], y[kMax];     ///< unit vectors, as the ranges shall be for
    double inverse_range[kMax];  ///< one over the range
    double cosine[kMax];         ///< only if wanted
    double least[kMax / kBlock];
    int count;
    double cos, sin;  ///< a vector along the middle
    double rate;      ///< beams a radian

    /// Readies it for drawing, once count, x and y are set.
    void begin(double step_radians, double min_inverse_range);
    [[nodiscard]] int blocks() const { return (count + kBlock - 1) / kBlock; }
};

/// Draws all lines into the scan, front to back.
void drawLines(const FlatTree& tree, const FlatView& view, FlatScan& scan);
/// The same with cosines: the largest among lines met at the same place.
void drawLinesAndCosines(const FlatTree& tree, const FlatView& view, FlatScan& scan);

/// Rays with an origin each, and what they have met so far.
struct alignas(64) FlatPacket {
    static constexpr int kBlock = 8;  ///< rays drawn to at once
    static constexpr int kMax = 64;
    /// Fewer are quicker alone.
    static constexpr int kMin = 3;

    double x[kMax], y[kMax];  ///< unit vectors, as the ranges shall be for
    double origin_x[kMax], origin_y[kMax];
    double inverse_range[kMax];  ///< one over the range
    double cosine[kMax];         ///< only if wanted
    int count;                   ///< a multiple of kBlock, not 0; rays may be repeated to get there
};

/// How far origins may lie apart for a packet to be quicker than rays alone.
double widestPacket(const FlatTree& tree);

struct FlatPacketLimits {
    double ray_epsilon;
    double min_inverse_range;
    double widest;
};

/// Draws all lines into the packet, front to back. Its rays meet what they would alone, if that is
/// nearer than min_inverse_range. False if it is too wide for that to be quick, or not of finite
/// numbers; then nothing is done.
bool drawLines(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet);
/// The same with cosines: the largest among lines met at the same place.
bool drawLinesAndCosines(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet);

/// What a ray met first.
struct FlatHit {
    double inverse_range;  ///< one over the range
    double cosine = 0;     ///< the largest among lines met at the same place
};

/// The nearest line or round body along the unit vector (x, y), if it is nearer than
/// `min_inverse_range`.
FlatHit firstLine(const FlatTree& tree, const FlatView& view, double x, double y,
                  double min_inverse_range);

}  // namespace ispace
