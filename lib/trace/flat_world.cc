// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "trace/flat_kernels.h"
#include "trace/flat_tree.h"
#include "trace/rays.h"

namespace ispace {

namespace {

/// Ranges end at max_range as float32, so that what rounds to it is met. \pre max_range >= 0
struct Limit {
    float range;
    double inverse_range;  ///< of the first float32 beyond

    explicit Limit(double max_range)
        : range(static_cast<float>(max_range)),
          inverse_range(1 / static_cast<double>(std::nextafter(range, kNoReturn))) {}
    [[nodiscard]] float rangeOf(double inverse_range_met) const {
        const auto met = static_cast<float>(1 / inverse_range_met);
        if (met > range) return kNoReturn;
        return met;
    }
    [[nodiscard]] float cosineOf(float range_met, double cosine) const {
        return range_met < kNoReturn ? static_cast<float>(std::min(cosine, 1.0)) : 1.0F;
    }
};

/// Rays, and where their readings go.
struct Cast {
    const Point2* origins;
    bool is_one_origin;
    const Directions& directions;
    double ray_epsilon;
    Limit limit;
    float* ranges;
    float* cosines;  ///< or null

    [[nodiscard]] Point2 origin(std::size_t i) const { return origins[is_one_origin ? 0 : i]; }
};

bool isScan(const Directions& directions) {
    if (!directions.arc || directions.size() < FlatScan::kMin) return false;
    const double step = std::fabs(directions.arc->step.radians());
    return step >= FlatScan::kMinStep && step <= FlatScan::kMaxStep;
}

}  // namespace

struct FlatWorld::Data {
    FlatTree tree;

    double widest_packet;

    Data(std::span<const Segment2> lines, std::span<const Ellipse> rounds)
        : tree(lines, rounds), widest_packet(widestPacket(tree)) {}

    void castRay(const Cast& cast, std::size_t i) const {
        const Point2 origin = cast.origin(i);
        const FlatHit hit =
            firstLine(tree, {origin.x, origin.y, cast.ray_epsilon}, cast.directions.x[i],
                      cast.directions.y[i], cast.limit.inverse_range);
        cast.ranges[i] = cast.limit.rangeOf(hit.inverse_range);
        if (cast.cosines != nullptr)
            cast.cosines[i] = cast.limit.cosineOf(cast.ranges[i], hit.cosine);
    }

    /// Rays begin .. begin + count - 1; false, and nothing done, if they are better cast singly.
    [[nodiscard]] bool castPacket(const Cast& cast, std::size_t begin, std::size_t count) const {
        if (count < FlatPacket::kMin) return false;
        constexpr std::size_t kBlock = FlatPacket::kBlock;
        const std::size_t lanes = (count + kBlock - 1) / kBlock * kBlock;
        FlatPacket packet;
        packet.count = static_cast<int>(lanes);
        const auto set = [&](std::size_t lane, std::size_t i) {
            packet.x[lane] = cast.directions.x[i];
            packet.y[lane] = cast.directions.y[i];
            const Point2 origin = cast.origin(i);
            packet.origin_x[lane] = origin.x;
            packet.origin_y[lane] = origin.y;
        };
        for (std::size_t i = 0; i < count; ++i) set(i, begin + i);
        for (std::size_t i = count; i < lanes; ++i) set(i, begin + count / 2);
        const FlatPacketLimits limits{cast.ray_epsilon, cast.limit.inverse_range, widest_packet};
        if (!(cast.cosines == nullptr ? drawLines(tree, limits, packet)
                                      : drawLinesAndCosines(tree, limits, packet)))
            return false;
        float* const ranges = cast.ranges + begin;
        for (std::size_t i = 0; i < count; ++i)
            ranges[i] = cast.limit.rangeOf(packet.inverse_range[i]);
        if (cast.cosines != nullptr)
            for (std::size_t i = 0; i < count; ++i)
                cast.cosines[begin + i] = cast.limit.cosineOf(ranges[i], packet.cosine[i]);
        return true;
    }

    /// In packets as large as rays are near to one another.
    void castRays(const Cast& cast) const {
        const std::size_t size = cast.directions.size();
        std::size_t most = FlatPacket::kMax;
        int before_more = 0;
        for (std::size_t begin = 0; begin < size;) {
            const std::size_t count = std::min(most, size - begin);
            if (castPacket(cast, begin, count)) {
                begin += count;
                if (--before_more > 0 || most == FlatPacket::kMax) continue;
                most *= 2;
            } else if (count > FlatPacket::kBlock) {
                while (most >= count) most /= 2;
                before_more = 8;
            } else {
                for (const std::size_t end = begin + count; begin < end; ++begin)
                    castRay(cast, begin);
            }
        }
    }

    /// Beams begin .. begin + count - 1 of a scan.
    void castScan(const FlatView& view, const Directions& directions, const Limit& limit,
                  std::size_t begin, std::size_t count, float* ranges, float* cosines) const {
        FlatScan scan;
        scan.count = static_cast<int>(count);
        const double step = directions.arc->step.radians();
        const double* const x = directions.x.data() + begin;
        const double* const y = directions.y.data() + begin;
        if (step > 0) {
            std::copy_n(x, count, scan.x);
            std::copy_n(y, count, scan.y);
        } else {
            std::reverse_copy(x, x + count, scan.x);
            std::reverse_copy(y, y + count, scan.y);
        }
        scan.begin(std::fabs(step), limit.inverse_range);
        cosines == nullptr ? drawLines(tree, view, scan) : drawLinesAndCosines(tree, view, scan);
        for (std::size_t i = 0; i < count; ++i)
            ranges[begin + i] = limit.rangeOf(scan.inverse_range[i]);
        if (cosines != nullptr)
            for (std::size_t i = 0; i < count; ++i)
                cosines[begin + i] = limit.cosineOf(ranges[begin + i], scan.cosine[i]);
        if (step > 0) return;
        std::reverse(ranges + begin, ranges + begin + count);
        if (cosines != nullptr) std::reverse(cosines + begin, cosines + begin + count);
    }
};

FlatWorld::FlatWorld(std::span<const Segment2> lines, std::span<const Ellipse> rounds)
    : data_(new Data(lines, rounds)) {}
FlatWorld::FlatWorld(FlatWorld&&) noexcept = default;
FlatWorld& FlatWorld::operator=(FlatWorld&&) noexcept = default;
FlatWorld::~FlatWorld() = default;

void FlatWorld::cast(Point2 origin, const Directions& directions, double max_range,
                     double ray_epsilon, std::span<float> ranges, std::span<float> cosines) const {
    assert(ranges.size() == directions.size());
    assert(cosines.empty() || cosines.size() == directions.size());
    if (!(static_cast<float>(max_range) >= 0)) {
        std::fill(ranges.begin(), ranges.end(), kNoReturn);
        std::fill(cosines.begin(), cosines.end(), 1.0F);
        return;
    }
    const Limit limit(max_range);
    const FlatView view{origin.x, origin.y, ray_epsilon};
    const std::size_t size = directions.size();
    if (isScan(directions)) {
        // Of one size, so that none has too few beams.
        const std::size_t parts = (size + FlatScan::kMax - 1) / FlatScan::kMax;
        for (std::size_t part = 0; part < parts; ++part) {
            const std::size_t begin = size * part / parts, end = size * (part + 1) / parts;
            data_->castScan(view, directions, limit, begin, end - begin, ranges.data(),
                            cosines.empty() ? nullptr : cosines.data());
        }
        return;
    }
    data_->castRays({&origin, true, directions, ray_epsilon, limit, ranges.data(),
                     cosines.empty() ? nullptr : cosines.data()});
}

void FlatWorld::cast(std::span<const Point2> origins, const Directions& directions,
                     double max_range, double ray_epsilon, std::span<float> ranges,
                     std::span<float> cosines) const {
    assert(ranges.size() == directions.size() && origins.size() == directions.size());
    assert(cosines.empty() || cosines.size() == directions.size());
    if (!(static_cast<float>(max_range) >= 0)) {
        std::fill(ranges.begin(), ranges.end(), kNoReturn);
        std::fill(cosines.begin(), cosines.end(), 1.0F);
        return;
    }
    data_->castRays({origins.data(), false, directions, ray_epsilon, Limit(max_range),
                     ranges.data(), cosines.empty() ? nullptr : cosines.data()});
}

}  // namespace ispace
