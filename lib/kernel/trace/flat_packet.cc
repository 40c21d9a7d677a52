// SPDX-License-Identifier: GPL-3.0-or-later
// Packets of rays of similar directions traverse the tree together (I. Wald et al., Interactive
// rendering with coherent ray tracing, 2001): a box about their origins and a cone about their
// directions skip nodes and lines, with slack for rounding. Each ray is decided in doubles by
// flat_kernels.h, so that results do not depend on its packet.
#include "trace/flat_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/simd.h"

namespace ispace {

namespace {

constexpr int kWidth = FlatTree::kWidth;
constexpr int kBlock = FlatPacket::kBlock;
/// Minimum cosine between a ray and the middle of its packet, for one block and for more: wide
/// packets are fast only if they are small. Not less than cos 45 degrees.
constexpr double kMinAlongOfBlock = 0.72, kMinAlong = 0.975;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

ISPACE_INLINE double leastOf(const double* eight) {
    double four[4];
    for (int i = 0; i < 4; ++i) four[i] = flatMin(eight[i], eight[i + 4]);
    return flatMin(flatMin(four[0], four[2]), flatMin(four[1], four[3]));
}

ISPACE_INLINE double sumOf(const double* eight) {
    double four[4];
    for (int i = 0; i < 4; ++i) four[i] = eight[i] + eight[i + 4];
    return (four[0] + four[2]) + (four[1] + four[3]);
}

/// Exceeds the distance beyond an end at which rays meet a line, seen along the sides of a cone,
/// plus the rounding of cross products with these.
ISPACE_INLINE double slackOf(double x, double y) {
    return 4 * kFlatEdge + 1e-12 * (std::fabs(x) + std::fabs(y));
}

/// Bounds of a packet's rays: a box around the origins, and a cone around the directions.
struct Cone {
    double left, right, low, high;
    double x, y, half_width, half_height;  ///< of the box
    double right_x, right_y, left_x, left_y, ahead_x, ahead_y;
    /// Maximum change of products with these when the origin moves within its box.
    double right_reach, left_reach, ahead_reach;

    ISPACE_INLINE void setOrigins(const FlatPacket& packet);
    /// \return minimum cosine between a ray and the middle of the cone, infinite without a cone
    ISPACE_INLINE double setDirections(const FlatPacket& packet);
};

void Cone::setOrigins(const FlatPacket& packet) {
    double least_x[kBlock], least_y[kBlock], less_x[kBlock], less_y[kBlock];
    ISPACE_LANES for (int i = 0; i < kBlock; ++i) least_x[i] = least_y[i] = less_x[i] = less_y[i] =
        kInfinity;
    for (int begin = 0; begin < packet.count; begin += kBlock) {
        const double* const ox = packet.origin_x + begin;
        const double* const oy = packet.origin_y + begin;
        ISPACE_LANES for (int i = 0; i < kBlock; ++i) {
            least_x[i] = flatMin(ox[i], least_x[i]);
            least_y[i] = flatMin(oy[i], least_y[i]);
            less_x[i] = flatMin(-ox[i], less_x[i]);
            less_y[i] = flatMin(-oy[i], less_y[i]);
        }
    }
    left = leastOf(least_x);
    low = leastOf(least_y);
    right = -leastOf(less_x);
    high = -leastOf(less_y);
    x = 0.5 * (left + right);
    y = 0.5 * (low + high);
    half_width = flatMax(right - x, x - left);
    half_height = flatMax(high - y, y - low);
}

double Cone::setDirections(const FlatPacket& packet) {
    double x_sum[kBlock], y_sum[kBlock], along[kBlock], least[kBlock], less[kBlock];
    ISPACE_LANES for (int i = 0; i < kBlock; ++i) {
        x_sum[i] = y_sum[i] = 0;
        along[i] = least[i] = less[i] = kInfinity;
    }
    for (int begin = 0; begin < packet.count; begin += kBlock) {
        const double* const dx = packet.x + begin;
        const double* const dy = packet.y + begin;
        ISPACE_LANES for (int i = 0; i < kBlock; ++i) {
            x_sum[i] += dx[i];
            y_sum[i] += dy[i];
        }
    }
    ahead_x = sumOf(x_sum);
    ahead_y = sumOf(y_sum);
    const double over = 1 / std::sqrt(ahead_x * ahead_x + ahead_y * ahead_y);
    ahead_x *= over;
    ahead_y *= over;
    for (int begin = 0; begin < packet.count; begin += kBlock) {
        const double* const dx = packet.x + begin;
        const double* const dy = packet.y + begin;
        ISPACE_LANES for (int i = 0; i < kBlock; ++i) {
            const double here = ahead_x * dx[i] + ahead_y * dy[i];
            const double aside = (ahead_x * dy[i] - ahead_y * dx[i]) / here;
            along[i] = flatMin(here, along[i]);
            least[i] = flatMin(aside, least[i]);
            less[i] = flatMin(-aside, less[i]);
        }
    }
    const double to_right = leastOf(least), to_left = -leastOf(less);
    right_x = ahead_x - to_right * ahead_y;
    right_y = ahead_y + to_right * ahead_x;
    left_x = ahead_x - to_left * ahead_y;
    left_y = ahead_y + to_left * ahead_x;
    right_reach = std::fabs(right_x) * half_height + std::fabs(right_y) * half_width;
    left_reach = std::fabs(left_x) * half_height + std::fabs(left_y) * half_width;
    ahead_reach = std::fabs(ahead_x) * half_width + std::fabs(ahead_y) * half_height;
    return leastOf(along);
}

template <bool kCosines>
class Walk {
  public:
    ISPACE_INLINE Walk(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet)
        : tree_(tree), limits_(limits), packet_(packet) {}

    /// False if the packet is too wide.
    ISPACE_INLINE bool run();

  private:
    ISPACE_INLINE bool enclose();
    ISPACE_INLINE void visit(const FlatTree::Node& node);
    ISPACE_INLINE void meetLeaf(const FlatTree::Leaf& leaf);
    template <bool kRayEpsilon>
    ISPACE_INLINE void draw(const FlatTree::Leaf& leaf, int i);
    template <bool kRayEpsilon>
    ISPACE_INLINE double drawBlock(const FlatTree::Leaf& leaf, int i, int begin);
    ISPACE_INLINE void drawRound(const FlatTree::Round& round);
    bool mayTouch();

    const FlatTree& tree_;
    const FlatPacketLimits& limits_;
    FlatPacket& packet_;
    Cone cone_;
    double least_;  ///< inverse range of the ray with the farthest hit
    FlatStack stack_;
    /// True if a line may touch an origin; computed on first use.
    enum class Contact : std::uint8_t { Unknown, None, Some } touching_ = Contact::Unknown;
};

template <bool kCosines>
bool Walk<kCosines>::enclose() {
    cone_.setOrigins(packet_);
    const double along = cone_.setDirections(packet_);
    return along < 2 && along > (packet_.count > kBlock ? kMinAlong : kMinAlongOfBlock) &&
           cone_.right - cone_.left < limits_.widest && cone_.high - cone_.low < limits_.widest;
}

/// Pushes the children that rays may meet, the nearest on top.
template <bool kCosines>
void Walk<kCosines>::visit(const FlatTree::Node& node) {
    const Cone cone = cone_;
    const double least = least_;
    alignas(64) double distance[kWidth];
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        // Valid for all origins.
        const double left = node.left[i] - cone.right, right = node.right[i] - cone.left;
        const double low = node.low[i] - cone.high, high = node.high[i] - cone.low;
        const double right_side = flatMax(cone.right_x * low, cone.right_x * high) -
                                  flatMin(cone.right_y * left, cone.right_y * right);
        const double left_side = flatMin(cone.left_x * low, cone.left_x * high) -
                                 flatMax(cone.left_y * left, cone.left_y * right);
        const double ahead = flatMax(cone.ahead_x * left, cone.ahead_x * right) +
                             flatMax(cone.ahead_y * low, cone.ahead_y * high);
        const double slack = slackOf(flatMax(std::fabs(left), std::fabs(right)),
                                     flatMax(std::fabs(low), std::fabs(high)));
        const double far = distanceOf(left, right, low, high);
        const bool meets = (right_side >= -slack) & (left_side <= slack) & (ahead >= -slack) &
                           mayBeNearer(far, least);
        distance[i] = simd::choose(meets, far, -1.0);
    }
    stack_.push(node, distance);
}

/// For all origins at once: exact enough, since each candidate is tested afterwards.
template <bool kCosines>
bool Walk<kCosines>::mayTouch() {
    if (touching_ != Contact::Unknown) return touching_ == Contact::Some;
    touching_ = Contact::None;
    const double ray_epsilon = limits_.ray_epsilon * (1 + 1e-6);
    const auto is_near = [&](double left, double right, double low, double high) {
        return left - cone_.right <= ray_epsilon && cone_.left - right <= ray_epsilon &&
               low - cone_.high <= ray_epsilon && cone_.low - high <= ray_epsilon;
    };
    std::int32_t waiting[FlatTree::kStack];
    int count = 0;
    waiting[count++] = 0;
    while (count > 0 && touching_ == Contact::None) {
        const FlatTree::Node& node = tree_.node(waiting[--count]);
        for (int k = 0; k < node.count; ++k) {
            if (!is_near(node.left[k], node.right[k], node.low[k], node.high[k])) continue;
            if (node.child[k] >= 0) {
                waiting[count++] = node.child[k];
                continue;
            }
            const FlatTree::Leaf& leaf = tree_.leaf(node.child[k]);
            for (int j = 0, end = leaf.count(); j < end; ++j)
                if (is_near(leaf.ax[j], leaf.bx[j], std::min(leaf.ay[j], leaf.by[j]),
                            std::max(leaf.ay[j], leaf.by[j])))
                    touching_ = Contact::Some;
        }
    }
    return touching_ == Contact::Some;
}

/// Draws a line into a block. \returns the block's minimum inverse range
template <bool kCosines>
template <bool kRayEpsilon>
double Walk<kCosines>::drawBlock(const FlatTree::Leaf& leaf, int i, int begin) {
    const double* const x = packet_.x + begin;
    const double* const y = packet_.y + begin;
    const double* const ox = packet_.origin_x + begin;
    const double* const oy = packet_.origin_y + begin;
    double* const inverse_range = packet_.inverse_range + begin;
    double* const cosine = packet_.cosine + begin;
    alignas(64) double least[kBlock];
    const auto meet = [=, &least](int k, double here, [[maybe_unused]] double height) {
        const double old = inverse_range[k];
        if constexpr (kCosines) {
            const double incidence = here * height;
            const double tied = simd::choose(here == old, flatMax(incidence, cosine[k]), cosine[k]);
            cosine[k] = simd::choose(here > old, incidence, tied);
        }
        least[k] = flatMax(here, old);
        inverse_range[k] = least[k];
    };
    alignas(64) double all_here[kBlock], heights[kBlock];
    ISPACE_LANES for (int k = 0; k < kBlock; ++k) {
        const FlatLine line = lineFrom(leaf, i, ox[k], oy[k]);
        const double here = simd::choose(line.stops, inverseRangeAlong(line, x[k], y[k]), 0.0);
        if constexpr (kRayEpsilon) {
            all_here[k] = here;
            heights[k] = line.height;
        } else {
            meet(k, here, line.height);
        }
    }
    if constexpr (kRayEpsilon)
        for (int k = 0; k < kBlock; ++k) {
            const bool is_new = all_here[k] > 0 && all_here[k] >= inverse_range[k];
            const bool is_contact =
                is_new && mayContinueTouched(heights[k], limits_.ray_epsilon) &&
                continuesTouched(tree_, leaf, i, ox[k], oy[k], limits_.ray_epsilon);
            meet(k, is_contact ? 0 : all_here[k], heights[k]);
        }
    return leastOf(least);
}

template <bool kCosines>
template <bool kRayEpsilon>
void Walk<kCosines>::draw(const FlatTree::Leaf& leaf, int i) {
    double least = kInfinity;
    for (int begin = 0; begin < packet_.count; begin += kBlock)
        least = flatMin(least, drawBlock<kRayEpsilon>(leaf, i, begin));
    least_ = least;
}

template <bool kCosines>
void Walk<kCosines>::meetLeaf(const FlatTree::Leaf& leaf) {
    const Cone cone = cone_;
    const double least = least_;
    const double ray_epsilon = limits_.ray_epsilon * (1 + 1e-6);
    alignas(64) double far[kWidth], clear[kWidth];
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        const double px = leaf.ax[i] - cone.x, py = leaf.ay[i] - cone.y;
        const double qx = leaf.bx[i] - cone.x, qy = leaf.by[i] - cone.y;
        const double right_side =
            flatMax(cone.right_x * py - cone.right_y * px, cone.right_x * qy - cone.right_y * qx);
        const double left_side =
            flatMin(cone.left_x * py - cone.left_y * px, cone.left_x * qy - cone.left_y * qx);
        const double ahead =
            flatMax(cone.ahead_x * px + cone.ahead_y * py, cone.ahead_x * qx + cone.ahead_y * qy);
        const double width = flatMax(std::fabs(px), std::fabs(qx)) + cone.half_width;
        const double height = flatMax(std::fabs(py), std::fabs(qy)) + cone.half_height;
        const double slack = slackOf(width, height);
        const double distance = distanceOf(flatMin(leaf.ax[i], leaf.bx[i]) - cone.right,
                                           flatMax(leaf.ax[i], leaf.bx[i]) - cone.left,
                                           flatMin(leaf.ay[i], leaf.by[i]) - cone.high,
                                           flatMax(leaf.ay[i], leaf.by[i]) - cone.low);
        const bool meets = (right_side + cone.right_reach >= -slack) &
                           (left_side - cone.left_reach <= slack) &
                           (ahead + cone.ahead_reach >= -slack) & mayBeNearer(distance, least);
        far[i] = simd::choose(meets, distance, -1.0);
        // How far its continuation is from any origin and contact, times its length.
        const double ex = leaf.bx[i] - leaf.ax[i], ey = leaf.by[i] - leaf.ay[i];
        const double reach = cone.half_width * std::fabs(ey) + cone.half_height * std::fabs(ex);
        const double rounding = 1e-12 * (width * std::fabs(ey) + height * std::fabs(ex));
        clear[i] = std::fabs(px * ey - py * ex) - reach - rounding - ray_epsilon * leaf.length[i];
    }
    for (int i = 0, end = leaf.count(); i < end; ++i) {
        if (far[i] < 0 || !mayBeNearer(far[i], least_)) continue;
        if (clear[i] > 0 || !mayTouch())
            draw<false>(leaf, i);
        else
            draw<true>(leaf, i);
    }
}

template <bool kCosines>
void Walk<kCosines>::drawRound(const FlatTree::Round& round) {
    double least = kInfinity;
    for (int k = 0; k < packet_.count; ++k) {
        const RoundFrom from(round, packet_.origin_x[k], packet_.origin_y[k], limits_.ray_epsilon);
        const RoundFrom::Hit met = from.meet<kCosines>(packet_.x[k], packet_.y[k]);
        const double old = packet_.inverse_range[k];
        if (kCosines && met.inverse_range >= old)
            packet_.cosine[k] =
                met.inverse_range > old ? met.cosine : std::max(met.cosine, packet_.cosine[k]);
        packet_.inverse_range[k] = std::max(met.inverse_range, old);
        least = std::min(least, packet_.inverse_range[k]);
    }
    least_ = least;
}

template <bool kCosines>
bool Walk<kCosines>::run() {
    if (!enclose()) return false;
    std::fill_n(packet_.inverse_range, packet_.count, limits_.min_inverse_range);
    if constexpr (kCosines) std::fill_n(packet_.cosine, packet_.count, 0.0);
    least_ = limits_.min_inverse_range;
    if (tree_.nodes.empty()) return true;
    visit(tree_.nodes.front());
    while (!stack_.empty()) {
        const FlatStack::Entry box = stack_.pop();
        if (!mayBeNearer(box.distance, least_)) continue;
        if (box.child >= 0)
            visit(tree_.node(box.child));
        else
            meetLeaf(tree_.leaf(box.child));
    }
    if (tree_.round_root < 0) return true;
    visit(tree_.node(tree_.round_root));
    while (!stack_.empty()) {
        const FlatStack::Entry box = stack_.pop();
        if (!mayBeNearer(box.distance, least_)) continue;
        if (box.child >= 0)
            visit(tree_.node(box.child));
        else
            drawRound(tree_.round(box.child));
    }
    return true;
}

}  // namespace

double widestPacket(const FlatTree& tree) {
    if (tree.nodes.empty()) return 0;
    const FlatTree::Node& root = tree.nodes.front();
    double left = root.left[0], right = root.right[0], low = root.low[0], high = root.high[0];
    for (int i = 1; i < root.count; ++i) {
        left = std::min(left, root.left[i]);
        right = std::max(right, root.right[i]);
        low = std::min(low, root.low[i]);
        high = std::max(high, root.high[i]);
    }
    // Typical distance between leaves.
    const auto leaves = static_cast<double>(tree.leaves.size());
    return 0.35 * (right - left + high - low) / std::sqrt(std::max(leaves, 1.0));
}

ISPACE_SIMD_CLONES
bool drawLines(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet) {
    return Walk<false>(tree, limits, packet).run();
}

ISPACE_SIMD_CLONES
bool drawLinesAndCosines(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet) {
    return Walk<true>(tree, limits, packet).run();
}

}  // namespace ispace
