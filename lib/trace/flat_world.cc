// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "trace/flat_fan.h"
#include "trace/flat_ray.h"
#include "trace/flat_tree.h"

namespace ispace {

namespace {

constexpr float kNoReturn = std::numeric_limits<float>::infinity();

/// Ranges end at max_range as float32, so that what rounds to it is met. \pre max_range >= 0
struct Limit {
    float range;
    double nearness;  ///< of the first float32 beyond

    explicit Limit(double max_range)
        : range(static_cast<float>(max_range)),
          nearness(1 / static_cast<double>(std::nextafter(range, kNoReturn))) {}
    [[nodiscard]] float rangeOf(double nearness_met) const {
        const auto met = static_cast<float>(1 / nearness_met);
        if (met > range) return kNoReturn;
        return met;
    }
    [[nodiscard]] float cosineOf(float range_met, double cosine) const {
        return range_met < kNoReturn ? static_cast<float>(std::min(cosine, 1.0)) : 1.0F;
    }
};

bool isFan(const Directions& directions) {
    if (!directions.arc || directions.size() < FlatFan::kLeast) return false;
    const double step = std::fabs(directions.arc->step.radians());
    return step >= FlatFan::kFinestStep && step <= FlatFan::kWidestStep;
}

}  // namespace

struct FlatWorld::Data {
    FlatTree tree;

    void castRay(const FlatView& view, double x, double y, const Limit& limit, float& range,
                 float* cosine) const {
        const FlatHit hit = firstLine(tree, view, x, y, limit.nearness);
        range = limit.rangeOf(hit.nearness);
        if (cosine != nullptr) *cosine = limit.cosineOf(range, hit.cosine);
    }

    /// Beams begin .. begin + count - 1 of a fan.
    void castFan(const FlatView& view, const Directions& directions, const Limit& limit,
                 std::size_t begin, std::size_t count, float* ranges, float* cosines) const {
        FlatFan fan;
        fan.count = static_cast<int>(count);
        const double step = directions.arc->step.radians();
        const double* const x = directions.x.data() + begin;
        const double* const y = directions.y.data() + begin;
        if (step > 0) {
            std::copy_n(x, count, fan.x);
            std::copy_n(y, count, fan.y);
        } else {
            std::reverse_copy(x, x + count, fan.x);
            std::reverse_copy(y, y + count, fan.y);
        }
        fan.begin(std::fabs(step), limit.nearness);
        cosines == nullptr ? drawLines(tree, view, fan) : drawLinesAndCosines(tree, view, fan);
        for (std::size_t i = 0; i < count; ++i) ranges[begin + i] = limit.rangeOf(fan.nearness[i]);
        if (cosines != nullptr)
            for (std::size_t i = 0; i < count; ++i)
                cosines[begin + i] = limit.cosineOf(ranges[begin + i], fan.cosine[i]);
        if (step > 0) return;
        std::reverse(ranges + begin, ranges + begin + count);
        if (cosines != nullptr) std::reverse(cosines + begin, cosines + begin + count);
    }
};

FlatWorld::FlatWorld(std::span<const Segment2> lines) : data_(new Data{FlatTree(lines)}) {}
FlatWorld::FlatWorld(FlatWorld&&) noexcept = default;
FlatWorld& FlatWorld::operator=(FlatWorld&&) noexcept = default;
FlatWorld::~FlatWorld() = default;

void FlatWorld::cast(Point2 origin, const Directions& directions, double max_range, double contact,
                     std::span<float> ranges, std::span<float> cosines) const {
    assert(ranges.size() == directions.size());
    assert(cosines.empty() || cosines.size() == directions.size());
    if (!(static_cast<float>(max_range) >= 0)) {
        std::fill(ranges.begin(), ranges.end(), kNoReturn);
        std::fill(cosines.begin(), cosines.end(), 1.0F);
        return;
    }
    const Limit limit(max_range);
    const FlatView view{origin.x, origin.y, contact};
    const std::size_t size = directions.size();
    if (isFan(directions)) {
        // Of one size, so that none has too few beams.
        const std::size_t parts = (size + FlatFan::kMost - 1) / FlatFan::kMost;
        for (std::size_t part = 0; part < parts; ++part) {
            const std::size_t begin = size * part / parts, end = size * (part + 1) / parts;
            data_->castFan(view, directions, limit, begin, end - begin, ranges.data(),
                           cosines.empty() ? nullptr : cosines.data());
        }
        return;
    }
    for (std::size_t i = 0; i < size; ++i)
        data_->castRay(view, directions.x[i], directions.y[i], limit, ranges[i],
                       cosines.empty() ? nullptr : &cosines[i]);
}

void FlatWorld::cast(std::span<const Point2> origins, const Directions& directions,
                     double max_range, double contact, std::span<float> ranges,
                     std::span<float> cosines) const {
    assert(ranges.size() == directions.size() && origins.size() == directions.size());
    assert(cosines.empty() || cosines.size() == directions.size());
    if (!(static_cast<float>(max_range) >= 0)) {
        std::fill(ranges.begin(), ranges.end(), kNoReturn);
        std::fill(cosines.begin(), cosines.end(), 1.0F);
        return;
    }
    const Limit limit(max_range);
    for (std::size_t i = 0; i < directions.size(); ++i)
        data_->castRay({origins[i].x, origins[i].y, contact}, directions.x[i], directions.y[i],
                       limit, ranges[i], cosines.empty() ? nullptr : &cosines[i]);
}

}  // namespace ispace
