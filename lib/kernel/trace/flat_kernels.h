// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and round bodies relative to the origin of a ray, and three algorithms for the first hit of
// level rays, which agree to the last bit. Private to lib/kernel/trace.
//
// castScan() rasterises lines into an arc of beams, packets take rays of similar direction
// together, single rays traverse the tree alone: each the fastest for some case, all by the same
// decisions below, in the same order of operations. flat_kernels_test, flat_packet_test and
// flat_world_test compare them bit by bit. Compiled for several vector widths (ISPACE_SIMD_CLONES),
// with the same bits. Error: some ulp of the range; a line's end counts within kFlatEdge.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "base/simd.h"
#include "geom/point.h"
#include "trace/flat_world.h"
#include "trace/rays.h"

namespace ispace {

// All decisions about rays and lines, in plain doubles. Scans and single rays compute in the same
// order, so that they agree to the last bit. Coordinates are relative to the origin; distances are
// inverse ranges: the nearest is the largest, and lines need no division per beam.

/// Prevents a loop over lanes from being unrolled, so that it is vectorised.
#define ISPACE_LANES _Pragma("GCC unroll 1")

/// A line whose straight continuation passes within this distance of the origin is seen edge-on; a
/// ray that passes within it of a line's end meets the line. Exceeds the rounding of coordinates of
/// a town.
constexpr double kFlatEdge = 1e-9;
/// Rays meet ends within at most this fraction of the distance from the origin to the line's
/// straight continuation: an almost edge-on line would otherwise be met far before or behind its
/// end. It also bounds that angle, in radians.
constexpr double kFlatEdgeAngle = 1e-6;
/// Minimum |cosine| between parallel lines.
constexpr double kFlatParallel = 1 - 1e-6;

template <typename Real>
ISPACE_INLINE Real flatMin(Real a, Real b) {
    return a < b ? a : b;
}
template <typename Real>
ISPACE_INLINE Real flatMax(Real a, Real b) {
    return a > b ? a : b;
}

/// Computes a lower bound of the distance to a box, 0 if the origin is inside, at most 8 % too
/// small: that of the octagon about the origin that touches the box. Monotone even with rounding: a
/// box inside another is never nearer, so skipping boxes does not change results.
template <typename Real>
ISPACE_INLINE Real distanceOf(Real left, Real right, Real low, Real high) {
    constexpr auto kDiagonal = static_cast<Real>(0.70710678);
    const Real x = flatMax(flatMax(left, -right), Real{0});
    const Real y = flatMax(flatMax(low, -high), Real{0});
    return flatMax(flatMax(x, y), kDiagonal * (x + y));
}

/// Computes the direction of (x, y) in [-pi, pi], within 1e-5; 0 for the null vector (Abramowitz &
/// Stegun, 4.4.47 and the quadrants).
template <typename Real>
ISPACE_INLINE Real angleOf(Real x, Real y) {
    constexpr auto kPi = std::numbers::pi_v<Real>;
    constexpr Real kTiny = sizeof(Real) == sizeof(float) ? Real(1e-30) : Real(1e-300);
    const Real far = std::fabs(x), wide = std::fabs(y);
    const Real ratio = flatMin(far, wide) / flatMax(flatMax(far, wide), kTiny);
    const Real square = ratio * ratio;
    const Real octant =
        ratio * (Real(0.9998660) +
                 square * (Real(-0.3302995) +
                           square * (Real(0.1801410) +
                                     square * (Real(-0.0851330) + square * Real(0.0208351)))));
    // Selecting between constants needs no branches.
    const bool is_steep = wide > far, is_behind = x < 0;
    const Real quarter = (is_steep ? kPi / 2 : Real{0}) + (is_steep ? Real{-1} : Real{1}) * octant;
    const Real half = (is_behind ? kPi : Real{0}) + (is_behind ? Real{-1} : Real{1}) * quarter;
    return std::copysign(half, y);
}

/// A line relative to an origin.
struct FlatLine {
    double ax, ay, bx, by;  ///< its ends, counter-clockwise about the origin
    double ux, uy;          ///< from a to b, times the inverse range of the line at a unit angle
    double nearest;         ///< upper bound of the inverse range
    double height;          ///< distance of the straight continuation
    double edge;            ///< distance from an end within which a ray meets it
    bool stops;             ///< false: seen edge-on
};

ISPACE_INLINE FlatLine lineFrom(const FlatTree::Leaf& leaf, int i, double ox, double oy) {
    const double px = leaf.ax[i] - ox, py = leaf.ay[i] - oy;
    const double qx = leaf.bx[i] - ox, qy = leaf.by[i] - oy;
    const double ex = leaf.bx[i] - leaf.ax[i], ey = leaf.by[i] - leaf.ay[i];
    const double area = px * ey - py * ex;
    const double size = std::fabs(area), over = 1 / area;
    const bool turned = area < 0;
    FlatLine line;
    line.ax = turned ? qx : px;
    line.ay = turned ? qy : py;
    line.bx = turned ? px : qx;
    line.by = turned ? py : qy;
    line.ux = ex * over;
    line.uy = ey * over;
    line.nearest =
        1 / distanceOf(flatMin(px, qx), flatMax(px, qx), flatMin(py, qy), flatMax(py, qy));
    line.height = size / leaf.length[i];
    line.edge = flatMin(kFlatEdge, kFlatEdgeAngle * line.height);
    line.stops = size > kFlatEdge * leaf.length[i];
    return line;
}

/// Computes the inverse range at which a ray along (x, y), between the line's ends, meets the line.
ISPACE_INLINE double inverseRangeBetween(const FlatLine& line, double x, double y) {
    return flatMin(x * line.uy - y * line.ux, line.nearest);
}

/// Computes the inverse range at which a ray along (x, y) meets the closed line; not positive if it
/// misses.
ISPACE_INLINE double inverseRangeAlong(const FlatLine& line, double x, double y) {
    const double from_a = line.ax * y - line.ay * x, to_b = x * line.by - y * line.bx;
    const bool is_between = (from_a >= -line.edge) & (to_b >= -line.edge);
    return simd::choose(is_between, inverseRangeBetween(line, x, y), 0.0);
}

/// True if the straight continuation of a line may pass within `ray_epsilon` of the origin;
/// continuesTouched() decides.
inline bool mayContinueTouched(double height, double ray_epsilon) {
    // Distances of lines and of their continuations round differently.
    return height < ray_epsilon * (1 + 1e-9);
}

inline bool touches(const FlatTree::Leaf& leaf, int i, double ox, double oy, double ray_epsilon) {
    const double ax = leaf.ax[i] - ox, ay = leaf.ay[i] - oy;
    const double ex = leaf.bx[i] - leaf.ax[i], ey = leaf.by[i] - leaf.ay[i];
    const double along = -(ax * ex + ay * ey) / (ex * ex + ey * ey);
    const double s = std::clamp(along, 0.0, 1.0);
    const double x = ax + s * ex, y = ay + s * ey;
    return x * x + y * y < ray_epsilon * ray_epsilon;
}

inline bool areParallel(const FlatTree::Leaf& leaf, int i, const FlatTree::Leaf& other, int j) {
    const double cosine = (leaf.bx[i] - leaf.ax[i]) * (other.bx[j] - other.ax[j]) +
                          (leaf.by[i] - leaf.ay[i]) * (other.by[j] - other.ay[j]);
    return std::fabs(cosine) >= kFlatParallel * leaf.length[i] * other.length[j];
}

inline bool isNear(const FlatTree::Node& node, int i, double ox, double oy, double ray_epsilon) {
    return node.left[i] - ox <= ray_epsilon && ox - node.right[i] <= ray_epsilon &&
           node.low[i] - oy <= ray_epsilon && oy - node.high[i] <= ray_epsilon;
}

/// True if a line nearer to the origin than `ray_epsilon` is parallel to line i of the leaf.
inline bool continuesTouched(const FlatTree& tree, const FlatTree::Leaf& leaf, int i, double ox,
                             double oy, double ray_epsilon) {
    std::int32_t waiting[FlatTree::kStack];
    int count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const FlatTree::Node& node = tree.node(waiting[--count]);
        for (int k = 0; k < node.count; ++k) {
            if (!isNear(node, k, ox, oy, ray_epsilon)) continue;
            if (node.child[k] >= 0) {
                waiting[count++] = node.child[k];
                continue;
            }
            const FlatTree::Leaf& near = tree.leaf(node.child[k]);
            for (int j = 0, end = near.count(); j < end; ++j)
                if (areParallel(leaf, i, near, j) && touches(near, j, ox, oy, ray_epsilon))
                    return true;
        }
    }
    return false;
}

/// A round body relative to an origin. Rays meet the exact curve, from outside at the entry, from
/// inside at the exit. From an origin within `ray_epsilon` of the curve, outgoing rays pass and
/// ingoing rays meet the far side.
///
/// Computed in the frame where the body is the unit disc. There the ray q + t d meets the curve
/// where a t^2 + 2 b t + c = 0, solved so that neither root cancels.
class RoundFrom {
  public:
    ISPACE_INLINE RoundFrom(const FlatTree::Round& round, double ox, double oy, double ray_epsilon)
        : round_(round), touching_(ray_epsilon) {
        const double x = ox - round.cx, y = oy - round.cy;
        qx_ = round.xx * x + round.xy * y;
        qy_ = round.yx * x + round.yy * y;
        c_ = qx_ * qx_ + qy_ * qy_ - 1;
        // Near the curve, c is the distance from it times the length of its gradient.
        touches_ = std::fabs(c_) <= 2 * ray_epsilon * gradientAt(qx_, qy_);
    }

    /// Inverse distance along the unit vector (x, y), and the |cosine| there; the inverse range is
    /// not positive if the ray misses.
    struct Hit {
        double inverse_range, cosine;
    };
    template <bool kCosine>
    [[nodiscard]] ISPACE_INLINE Hit meet(double x, double y) const {
        const double dx = round_.xx * x + round_.xy * y, dy = round_.yx * x + round_.yy * y;
        const double a = dx * dx + dy * dy, b = qx_ * dx + qy_ * dy;
        const double side = qx_ * dy - qy_ * dx;
        const double square = a - side * side;
        if (square < 0) return {0, 0};
        const double root = std::sqrt(square), far = root - b;
        double inverse_range = 0;
        if (touches_)
            inverse_range = b < 0 && far > touching_ * a ? a / far : 0;
        else
            inverse_range = (std::copysign(root, c_) - b) / c_;
        if constexpr (!kCosine) return {inverse_range, 0};
        if (!(inverse_range > 0)) return {0, 0};
        const double t = 1 / inverse_range;
        return {inverse_range, root / gradientAt(qx_ + t * dx, qy_ + t * dy)};
    }

  private:
    /// Half the length of the gradient of c, in the world.
    [[nodiscard]] ISPACE_INLINE double gradientAt(double ux, double uy) const {
        const double x = round_.xx * ux + round_.yx * uy, y = round_.xy * ux + round_.yy * uy;
        return std::sqrt(x * x + y * y);
    }

    const FlatTree::Round& round_;
    double touching_;
    double qx_, qy_, c_;
    bool touches_;
};

/// The viewpoint from which lines are seen.
struct FlatView {
    double x, y;
    double ray_epsilon;
};

/// False if lines at this distance or beyond cannot be nearer than the current hit, allowing for
/// rounding.
ISPACE_INLINE bool mayBeNearer(double distance, double inverse_range_met) {
    return distance * inverse_range_met <= 1 + 1e-12;
}

/// Stack of nodes to visit, pushing the children of a node nearest last.
class FlatStack {
  public:
    struct Entry {
        double distance;
        std::int32_t child;
    };

    [[nodiscard]] bool empty() const { return count_ == 0; }
    ISPACE_INLINE Entry pop() { return entries_[--count_]; }
    /// Pushes the children at a distance of at least 0.
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

/// Ranges end at max_range as float32, so that hits that round to it count. \pre max_range >= 0
struct FlatLimit {
    float range;
    double inverse_range;  ///< of the first float32 above

    explicit FlatLimit(double max_range)
        : range(static_cast<float>(max_range)),
          inverse_range(1 / static_cast<double>(std::nextafter(range, kNoReturn))) {}
    [[nodiscard]] ISPACE_INLINE float rangeOf(double inverse_range_met) const {
        const auto met = static_cast<float>(1 / inverse_range_met);
        if (met > range) return kNoReturn;
        return met;
    }
    [[nodiscard]] ISPACE_INLINE float cosineOf(float range_met, double cosine) const {
        const double most = cosine < 1.0 ? cosine : 1.0;
        return range_met < kNoReturn ? static_cast<float>(most) : 1.0F;
    }
};

/// Beams from one origin at equal steps counter-clockwise, at most a full turn, and their hits so
/// far.
struct alignas(64) FlatScan {
    static constexpr int kBlock = 8;  ///< beams that share one minimum of the inverse range
    static constexpr int kMax = 2048;
    /// Minimum number of beams, and maximum step in radians: the centre of a scan is that of its
    /// central beams.
    static constexpr int kMin = 3;
    static constexpr double kMaxStep = 3, kMinStep = 1e-10;
    /// Maximum coordinate, of lines and origin, that float32 leaves room for.
    static constexpr double kMaxCoordinate = 1e15;

    const double *x, *y;                    ///< unit vectors, for which the ranges are computed
    double inverse_range[kMax];             ///< one over the range
    double* cosine;                         ///< kMax of them, or null
    double last_x[kBlock], last_y[kBlock];  ///< the last block if it is not full
    /// Minimum of a block's inverse ranges: a line with a smaller one does not shorten its beams.
    float least[kMax / kBlock];
    int count;
    float cos, sin;  ///< a vector along the centre of the scan
    float rate;      ///< beams per radian

    [[nodiscard]] int blocks() const { return (count + kBlock - 1) / kBlock; }
    [[nodiscard]] ISPACE_INLINE const double* blockOfX(int block) const {
        return (block + 1) * kBlock <= count ? x + std::ptrdiff_t{block} * kBlock : last_x;
    }
    [[nodiscard]] ISPACE_INLINE const double* blockOfY(int block) const {
        return (block + 1) * kBlock <= count ? y + std::ptrdiff_t{block} * kBlock : last_y;
    }
};

/// Arguments of castScan(): unit vectors, and output arrays.
struct FlatBeams {
    const double *x, *y;
    int count;
    double step;  ///< radians, positive
    float* ranges;
    float* cosines;  ///< or null
};

/// Casts a scan: rasterises all lines into it, front to back. Cosines are the largest among lines
/// met at the same point. \pre no coordinate exceeds FlatScan::kMaxCoordinate
void castScan(const FlatTree& tree, const FlatView& view, const FlatLimit& limit,
              const FlatBeams& beams);

/// Rays with an origin each, and their hits so far.
struct alignas(64) FlatPacket {
    static constexpr int kBlock = 8;  ///< rays updated at once
    static constexpr int kMax = 64;
    /// Fewer rays are faster one by one.
    static constexpr int kMin = 3;

    double x[kMax], y[kMax];  ///< unit vectors, for which the ranges are computed
    double origin_x[kMax], origin_y[kMax];
    double inverse_range[kMax];  ///< one over the range
    double cosine[kMax];         ///< only if requested
    int count;                   ///< a positive multiple of kBlock, padded by repeated rays
};

/// Computes the maximum distance between origins for which a packet is faster than single rays.
double widestPacket(const FlatTree& tree);

struct FlatPacketLimits {
    double ray_epsilon;
    double min_inverse_range;
    double widest;
};

/// Rasterises all lines into the packet, front to back, with the results of single rays.
/// \returns false, without changes, if the packet is too wide to be fast or holds numbers that are
/// not finite
bool drawLines(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet);
/// The same with cosines: the largest among lines met at the same point.
bool drawLinesAndCosines(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet);

/// First hit of a ray.
struct FlatHit {
    double inverse_range;  ///< one over the range
    double cosine = 0;     ///< the largest among lines met at the same point
};

/// Finds the nearest line or round body along the unit vector (x, y) if its inverse range exceeds
/// `min_inverse_range`.
FlatHit firstLine(const FlatTree& tree, const FlatView& view, double x, double y,
                  double min_inverse_range);

}  // namespace ispace
