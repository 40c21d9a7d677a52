// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/body_arc.h"

#include <algorithm>
#include <cmath>
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

ISPACE_SIMD_CLONES
void see(const BodyTable& table, std::size_t begin, const ArcView& view, Seen& seen) {
    const double* const x = table.x.data() + begin;
    const double* const y = table.y.data() + begin;
    const double* const reach = table.reach.data() + begin;
    const double* const bottom = table.bottom.data() + begin;
    const double* const top = table.top.data() + begin;
    double low[kLanes], high[kLanes], other_low[kLanes], other_high[kLanes];
    ISPACE_LANES for (int i = 0; i < kLanes; ++i) {
        const double wx = x[i] - view.x, wy = y[i] - view.y;
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
    const std::size_t end = std::min((block + 1) * kBlock, directions_.size());
    float farthest = 0;
    for (std::size_t k = block * kBlock; k < end; ++k) farthest = std::max(farthest, ranges_[k]);
    farthest_[block] = std::min(farthest, static_cast<float>(far_ * (1 + kFarSlack)));
}

Box2 BodyArc::view() const {
    Box2 box;
    box.add(origin_.onFloor());
    const std::size_t count = directions_.size();
    for (std::size_t block = 0; block < farthest_.size(); ++block) {
        const double far = static_cast<double>(farthest_[block]) * (1 + kFarSlack);
        const std::size_t end = std::min((block + 1) * kBlock, count);
        for (std::size_t k = block * kBlock; k < end; ++k)
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
        see(table, i, view, seen);
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

void BodyArc::meetBeams(const BodyFrom& body, std::int32_t first, std::int32_t last,
                        double nearest) {
    if (first > last) return;
    const auto begin = static_cast<std::size_t>(first), end = static_cast<std::size_t>(last) + 1;
    for (std::size_t k = begin; k < end; ++k)
        if (static_cast<double>(ranges_[k]) > nearest)
            ranges_.shorten(k, body.meet(directions_[k]), 1);
    for (std::size_t block = begin / kBlock; block <= (end - 1) / kBlock; ++block)
        findFarthest(block);
}

}  // namespace ispace
