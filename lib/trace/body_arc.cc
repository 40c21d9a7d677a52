// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/body_arc.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/simd.h"
#include "trace/flat_kernels.h"

namespace ispace {

namespace {

constexpr int kLanes = static_cast<int>(BodyTable::kLanes);
constexpr double kTurn = 2 * std::numbers::pi;
/// Radians added to each side of a body as a sensor sees it: more than angleOf() errs three times.
constexpr double kAngularSlack = 5e-5;

/// The level arc that looks at bodies.
struct ArcView {
    double x, y, z;      // where it looks from
    double cos, sin;     // of its middle
    double rate, count;  // beams a radian, and of all
    double far;

    /// The number of beams before this angle from the middle, and a fraction.
    [[nodiscard]] ISPACE_INLINE double beam(double angle) const {
        return flatMin(flatMax(angle * rate + (count - 1) * 0.5 + 1, 0.0), count);
    }
};

/// Of bodies one after the other, a figure an array. Beams: first > last if there are none.
struct alignas(64) Seen {
    double nearest[BodyTable::kLanes];
    std::int32_t first[BodyTable::kLanes], last[BodyTable::kLanes];
    std::int32_t other_first[BodyTable::kLanes], other_last[BodyTable::kLanes];
};

template <bool kLeans>
ISPACE_INLINE void seeBodies(const BodyTable& table, std::size_t begin, const ArcView& view,
                             Seen& seen) {
    const double* const x = table.x.data() + begin;
    const double* const y = table.y.data() + begin;
    const double* const reach = table.reach.data() + begin;
    const double* const bottom = table.bottom.data() + begin;
    const double* const top = table.top.data() + begin;
    const double* const lean_x = kLeans ? table.lean_x.data() + begin : nullptr;
    const double* const lean_y = kLeans ? table.lean_y.data() + begin : nullptr;
    double low[kLanes], high[kLanes], other_low[kLanes], other_high[kLanes];
    ISPACE_LANES for (int i = 0; i < kLanes; ++i) {
        const double wx = (kLeans ? x[i] + lean_x[i] * view.z : x[i]) - view.x;
        const double wy = (kLeans ? y[i] + lean_y[i] * view.z : y[i]) - view.y;
        const double square = wx * wx + wy * wy;
        const double distance = std::sqrt(square);
        seen.nearest[i] = distance - reach[i];
        const double wide = reach[i] * (1 + kFarSlack);
        const double angle = angleOf(wx * view.cos + wy * view.sin, wy * view.cos - wx * view.sin);
        // Half of the angle that its circle takes up; all of the turn from within.
        const double tangent = std::sqrt(flatMax(square - wide * wide, 0.0));
        const double around = distance <= wide ? kTurn : 0.0;
        const double half = angleOf(tangent, wide) + kAngularSlack + around;
        const bool is_met =
            (view.z >= bottom[i]) & (view.z <= top[i]) & (seen.nearest[i] <= view.far);
        const double from = angle - half, to = angle + half;
        // What crosses the turn's cut behind the middle is there again at the other end.
        const double back = from < -std::numbers::pi ? kTurn : 1e9;
        const double shift = to > std::numbers::pi ? -kTurn : back;
        const double hidden = is_met ? 0.0 : 1e12;
        low[i] = view.beam(from + hidden);
        high[i] = view.beam(to + hidden);
        other_low[i] = view.beam(from + shift + hidden);
        other_high[i] = view.beam(to + shift + hidden);
    }
    ISPACE_LANES for (int i = 0; i < kLanes; ++i) {
        seen.first[i] = static_cast<std::int32_t>(low[i]);
        seen.last[i] = static_cast<std::int32_t>(high[i]) - 1;
        seen.other_first[i] = static_cast<std::int32_t>(other_low[i]);
        seen.other_last[i] = static_cast<std::int32_t>(other_high[i]) - 1;
    }
}

ISPACE_SIMD_CLONES
void seeUpright(const BodyTable& table, std::size_t begin, const ArcView& view, Seen& seen) {
    seeBodies<false>(table, begin, view, seen);
}

ISPACE_SIMD_CLONES
void seeLeaning(const BodyTable& table, std::size_t begin, const ArcView& view, Seen& seen) {
    seeBodies<true>(table, begin, view, seen);
}

/// What of a body's outline level beams meet: in its frame, as BodyFrom has it.
struct OutlineFrom {
    double cos, sin;  // of its heading
    double x, y;      // where beams leave
    double half_length, half_width, radius;
};

/// Where a beam enters and leaves a slab, or misses it. Zero directions divide by zero, and what
/// that gives is not chosen.
struct SlabCut {
    double near, far;
    ISPACE_INLINE SlabCut(double origin, double direction, double half) {
        constexpr double kNone = std::numeric_limits<double>::infinity();
        const double a = (-half - origin) / direction, b = (half - origin) / direction;
        const double miss = ((origin < -half) | (origin > half)) ? kNone : -kNone;
        const bool crosses = direction != 0;
        near = flatChoice(crosses, b < a ? b : a, miss);
        far = flatChoice(crosses, a < b ? b : a, -miss);
    }
};

/// BodyFrom::meet for blocks of level beams at a height where the body is: the same to the last
/// bit.
template <typename Cut>
ISPACE_INLINE void meetLevel(const OutlineFrom& from, const double* x, const double* y,
                             std::size_t blocks, double* range, double* slope, Cut cut) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    for (std::size_t at = 0; at < blocks * BodyTable::kLanes; at += BodyTable::kLanes) {
        ISPACE_LANES for (std::size_t i = at; i < at + BodyTable::kLanes; ++i) {
            const double ahead = from.cos * x[i] + from.sin * y[i];
            const double aside = from.cos * y[i] - from.sin * x[i];
            double begin, end, slope_begin, slope_end;
            cut(ahead, aside, begin, end, slope_begin, slope_end);
            const bool outside = begin >= 0;
            const bool misses = (begin > end) | (end < 0);
            range[i] = flatChoice(misses, kNone, flatChoice(outside, begin, end));
            slope[i] = flatChoice(misses, 0.0, flatChoice(outside, slope_begin, slope_end));
        }
    }
}

ISPACE_SIMD_CLONES
void meetBox(const OutlineFrom& from, const double* x, const double* y, std::size_t blocks,
             double* range, double* slope) {
    meetLevel(
        from, x, y, blocks, range, slope,
        [&from](double ahead, double aside, double& begin, double& end, double& slope_begin,
                double& slope_end) __attribute__((always_inline)) {
            const SlabCut one(from.x, ahead, from.half_length);
            const SlabCut other(from.y, aside, from.half_width);
            const double steep = std::fabs(ahead), flat = std::fabs(aside);
            const bool enters_other = other.near > one.near;
            begin = flatChoice(enters_other, other.near, one.near);
            slope_begin = flatChoice(enters_other, flat, steep);
            const bool leaves_other = other.far < one.far;
            end = flatChoice(leaves_other, other.far, one.far);
            slope_end = flatChoice(leaves_other, flat, steep);
        });
}

ISPACE_SIMD_CLONES
void meetDisc(const OutlineFrom& from, const double* x, const double* y, std::size_t blocks,
              double* range, double* slope) {
    meetLevel(
        from, x, y, blocks, range, slope,
        [&from](double ahead, double aside, double& begin, double& end, double& slope_begin,
                double& slope_end) __attribute__((always_inline)) {
            constexpr double kNone = std::numeric_limits<double>::infinity();
            const double a = ahead * ahead + aside * aside;
            const double b = from.x * ahead + from.y * aside;
            const double side = from.x * aside - from.y * ahead;
            const double root = a * from.radius * from.radius - side * side;
            const double half = std::sqrt(flatMax(root, 0.0));
            const bool misses = root < 0;
            begin = flatChoice(misses, kNone, (-b - half) / a);
            end = flatChoice(misses, -kNone, (-b + half) / a);
            slope_begin = slope_end = half / from.radius;
        });
}

/// The greatest of a block, in pairs, which need not wait for each other.
ISPACE_INLINE float greatestOf(const float* range) {
    const auto greater = [](float a, float b) { return a > b ? a : b; };
    return greater(greater(greater(range[0], range[1]), greater(range[2], range[3])),
                   greater(greater(range[4], range[5]), greater(range[6], range[7])));
}

/// ShortenedRanges::shorten for blocks of beams without cosines whose range is above `nearest`;
/// then the greatest range of each block, at most `most`.
ISPACE_SIMD_CLONES
void shortenBlocks(const double* multiple, std::size_t blocks, double nearest, float farthest,
                   float* range, float most, float* greatest) {
    for (std::size_t block = 0; block < blocks; ++block) {
        const std::size_t begin = block * BodyTable::kLanes;
        ISPACE_LANES for (std::size_t i = begin; i < begin + BodyTable::kLanes; ++i) {
            const float old = range[i], met = static_cast<float>(multiple[i]);
            const bool is_shorter =
                (met <= farthest) & (met < old) & (static_cast<double>(old) > nearest);
            range[i] = simd::choose(is_shorter, met, old);
        }
        const float left = greatestOf(range + begin);
        greatest[block] = left < most ? left : most;
    }
}

/// Kept for its memory: threads read many scans.
std::vector<float>& farthestOfThread() {
    thread_local std::vector<float> farthest;
    return farthest;
}

}  // namespace

BodyArc::BodyArc(Point3 origin, const Directions& directions, double max_range,
                 std::span<const MovingBody> bodies, std::span<const BodyExtent> extents,
                 const ShortenedRanges& ranges)
    : origin_(origin),
      directions_(directions),
      bodies_(bodies),
      extents_(extents),
      far_(max_range),
      most_(static_cast<float>(max_range * (1 + kFarSlack))),
      ranges_(ranges),
      count_(static_cast<double>(directions.size())),
      farthest_(farthestOfThread()) {
    const auto& [first, step] = *directions.arc;
    middle_ = cosSin(first + ((count_ - 1) / 2) * step);
    rate_ = 1 / step.radians();
    farthest_.resize((directions.size() + kBlock - 1) / kBlock);
    for (std::size_t block = 0; block < farthest_.size(); ++block) findFarthest(block);
}

void BodyArc::findFarthest(std::size_t block) {
    const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, directions_.size());
    float farthest = 0;
    if (end - begin == kBlock)
        farthest = greatestOf(ranges_.all().data() + begin);
    else
        for (std::size_t k = begin; k < end; ++k) farthest = std::max(farthest, ranges_[k]);
    farthest_[block] = std::min(farthest, most_);
}

Box2 BodyArc::view() const {
    Box2 box;
    box.add(origin_.onFloor());
    constexpr double kWide = 1;  // radians
    const double half = (kBlock - 1) / (2 * rate_);
    if (half > kWide) {
        const Vec2 margin{far_ * (1 + kFarSlack), far_ * (1 + kFarSlack)};
        return {origin_.onFloor() - margin, origin_.onFloor() + margin};
    }
    // The ends of a block, so far away that the chord between them lies behind its arc.
    const double beyond = (1 + kFarSlack) / std::cos(half);
    for (std::size_t block = 0; block < farthest_.size(); ++block) {
        const double far = static_cast<double>(farthest_[block]) * beyond;
        const std::size_t begin = block * kBlock;
        for (const std::size_t k : {begin, std::min(begin + kBlock, directions_.size()) - 1})
            box.add(origin_.onFloor() + far * Vec2{directions_.x[k], directions_.y[k]});
    }
    return box;
}

void BodyArc::meetFrom(const FloorGrid& grid, const BodyTable& table, std::uint32_t own) {
    // A few cells at first, then four times as many each time.
    constexpr double kCells = 2.5;
    const auto within = [](const Box2& a, const Box2& b) {
        return Box2{{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
                    {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
    };
    Box2 done;
    for (double half = kCells * grid.cellSize();; half *= 2) {
        const Point2 middle = origin_.onFloor();
        const Box2 view = this->view();
        const Box2 box = within(view, {middle - Vec2{half, half}, middle + Vec2{half, half}});
        grid.forEachRun(box, done,
                        [&](std::size_t begin, std::size_t end) { look(table, begin, end, own); });
        meetCollected();
        if (box.low == view.low && box.high == view.high) return;
        done = box;
    }
}

bool BodyArc::isSeen(std::int32_t first, std::int32_t last, double nearest) const {
    if (first > last) return false;
    const auto begin = static_cast<std::size_t>(first) / kBlock;
    const auto end = static_cast<std::size_t>(last) / kBlock;
    for (std::size_t block = begin; block <= end; ++block)
        if (static_cast<double>(farthest_[block]) > nearest) return true;
    return false;
}

bool BodyArc::isSeen(const Waiting& waiting) const {
    return isSeen(waiting.first, waiting.last, waiting.nearest) ||
           isSeen(waiting.other_first, waiting.other_last, waiting.nearest);
}

void BodyArc::look(const BodyTable& table, std::size_t begin, std::size_t end, std::uint32_t own) {
    const ArcView view{origin_.x,   origin_.y, origin_.z, middle_.cos,
                       middle_.sin, rate_,     count_,    far_ * (1 + kFarSlack)};
    Seen seen;
    for (std::size_t i = begin; i < end; i += BodyTable::kLanes) {
        (table.lean_x.empty() ? seeUpright : seeLeaning)(table, i, view, seen);
        for (std::size_t k = 0; k < std::min(BodyTable::kLanes, end - i); ++k) {
            const Waiting waiting{seen.nearest[k], table.index[i + k],  seen.first[k],
                                  seen.last[k],    seen.other_first[k], seen.other_last[k]};
            if (!isSeen(waiting) || bodies_[waiting.body].owner == own) continue;
            if (size_ == kMost) meetCollected();
            waiting_[size_++] = waiting;
        }
    }
}

void BodyArc::meetCollected() {
    std::sort(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(size_),
              [](const Waiting& a, const Waiting& b) { return a.nearest < b.nearest; });
    for (std::size_t i = 0; i < size_; ++i) {
        const Waiting& waiting = waiting_[i];
        if (!isSeen(waiting)) continue;
        const BodyFrom body(bodies_[waiting.body], extents_[waiting.body].axes, origin_);
        meetBeams(body, waiting.first, waiting.last, waiting.nearest);
        meetBeams(body, waiting.other_first, waiting.other_last, waiting.nearest);
    }
    size_ = 0;
}

/// In whole blocks as far as there are any: beams that are not asked for pass the body, and cost
/// nothing more.
void BodyArc::meetBeams(const BodyFrom& body, std::int32_t first, std::int32_t last,
                        double nearest) {
    if (first > last) return;
    const auto begin = static_cast<std::size_t>(first), end = static_cast<std::size_t>(last) + 1;
    constexpr std::size_t kBlocks = 8;
    double multiples[kBlocks * kBlock], slopes[kBlocks * kBlock];
    const auto shorten = [&](std::size_t k, const BodyMeeting& meeting) {
        if (static_cast<double>(ranges_[k]) > nearest) ranges_.shorten(k, meeting, 1);
    };
    // Blocks take balls for cylinders, and normals to be level.
    const MovingBody& met = body.body();
    const bool is_single = met.is_ball || (met.lean != 0 && ranges_.hasCosines());
    const std::size_t whole = is_single ? 0 : directions_.size() / kBlock;
    const OutlineFrom outline{body.axes().cos, body.axes().sin, body.offset().x, body.offset().y,
                              met.half_length, met.half_width,  met.radius};
    std::size_t block = begin / kBlock;
    for (; block < whole && block * kBlock < end; block += kBlocks) {
        const std::size_t at = block * kBlock;
        const std::size_t blocks =
            std::min({kBlocks, whole - block, (end - 1) / kBlock + 1 - block});
        (outline.radius > 0 ? meetDisc : meetBox)(outline, directions_.x.data() + at,
                                                  directions_.y.data() + at, blocks, multiples,
                                                  slopes);
        if (!ranges_.hasCosines()) {
            shortenBlocks(multiples, blocks, nearest, ranges_.farthest(), ranges_.all().data() + at,
                          most_, farthest_.data() + block);
            continue;
        }
        for (std::size_t k = 0; k < blocks * kBlock; ++k)
            shorten(at + k, {multiples[k], slopes[k]});
        for (std::size_t k = 0; k < blocks; ++k) findFarthest(block + k);
    }
    if (end <= whole * kBlock) return;
    const std::size_t rest = std::max(begin, whole * kBlock);
    for (std::size_t k = rest; k < end; ++k) shorten(k, body.meet(directions_[k]));
    for (block = rest / kBlock; block * kBlock < end; ++block) findFarthest(block);
}

}  // namespace ispace
