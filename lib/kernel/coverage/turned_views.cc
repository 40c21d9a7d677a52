// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/turned_views.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "base/simd.h"
#include "geom/interval.h"

namespace ispace {

namespace {

using HeldVerdict = HeldViews::Verdict;

/// By which a bin is wider on either side, in bins: more than the errors of find().
constexpr double kDilation = 0.02;

/// Returns the middle and half the sides of the box around a bin.
/// \pre the angles are in one quadrant, up to their dilation
std::pair<Vec2, Vec2> boxAround(Interval ring, Interval angle) {
    constexpr double kSlack = 1e-6;
    Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
    for (const double radius : {ring.low, ring.high})
        for (const double at : {angle.low, angle.high}) {
            const Vec2 corner{radius * std::cos(at), radius * std::sin(at)};
            low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
            high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
        }
    const double slack = kSlack * ring.high;
    return {0.5 * (low + high), 0.5 * (high - low) + Vec2{slack, slack}};
}

/// Decides for all points of a bin. Bins at the edge of a view are split: boxes are larger than
/// their part of a ring.
HeldVerdict verdictOf(const HeldViews& view, Point3 foot, Interval radii, Interval angles,
                      int splits) {
    const auto [middle, half] = boxAround(radii, angles);
    const HeldVerdict whole = view.decide({foot.x + middle.x, foot.y + middle.y, foot.z}, half, 1);
    if (whole.unsure == 0 || splits == 0) return whole;
    const double radius = (radii.low + radii.high) / 2, angle = (angles.low + angles.high) / 2;
    bool is_held = true, is_out = true;
    for (const Interval part : {Interval{radii.low, radius}, Interval{radius, radii.high}})
        for (const Interval of : {Interval{angles.low, angle}, Interval{angle, angles.high}}) {
            const HeldVerdict one = verdictOf(view, foot, part, of, splits - 1);
            is_held = is_held && one.held != 0;
            is_out = is_out && (one.held | one.unsure) == 0;
            if (!is_held && !is_out) return {0, 1};
        }
    return {is_held ? 1U : 0U, 0};
}

/// A float32 angle in [0, 2 pi], accurate to 2e-5; its branches are selections.
ISPACE_INLINE float angleOf(float x, float y) {
    constexpr float kPi = std::numbers::pi_v<float>;
    const float ax = std::fabs(x), ay = std::fabs(y);
    const float z = std::min(ax, ay) / (std::max(ax, ay) + std::numeric_limits<float>::min());
    const float s = z * z;
    // Abramowitz and Stegun, 4.4.47.
    float t = z * (0.9998660F +
                   s * (-0.3302995F + s * (0.1801410F + s * (-0.0851330F + s * 0.0208351F))));
    t = ay > ax ? kPi / 2 - t : t;
    t = x < 0 ? kPi - t : t;
    return y < 0 ? 2 * kPi - t : t;
}

}  // namespace

TurnedViews::TurnedViews(const FieldOfView& ahead, std::span<const Angle> headings, double plane,
                         double reach)
    : headings_(headings.begin(), headings.end()),
      rings_per_metre_(static_cast<float>(kRings / std::max(reach, 1e-6))) {
    assert(!headings.empty() && headings.size() <= HeldViews::kMax);
    constexpr double kSector = 2 * std::numbers::pi / kSectors;
    const double ring_width = 1 / static_cast<double>(rings_per_metre_);
    const HeldViews view({&ahead, 1});
    const Point3 foot{ahead.frame.origin.x, ahead.frame.origin.y, plane};
    const HeldVerdict unknown{0, ~std::uint64_t{0} >> (HeldViews::kMax - headings.size())};
    verdicts_ = {unknown};
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint16_t> numbers;
    // A heading turns a sector by whole sectors, or onto two of them.
    struct Turn {
        std::size_t first, second;
    };
    std::vector<Turn> turns;
    for (const Angle heading : headings) {
        constexpr double kWhole = 1e-6;  // covered by the dilation
        const double sectors = wrapped(-heading).degrees() / 360 * kSectors + kSectors;
        const double whole = std::round(sectors);
        const bool is_whole = std::fabs(sectors - whole) < kWhole;
        const double first = is_whole ? whole : std::floor(sectors);
        turns.push_back({static_cast<std::size_t>(first) % kSectors,
                         static_cast<std::size_t>(is_whole ? first : first + 1) % kSectors});
    }
    pattern_.assign(index(kRings + 1, 0), 0);
    // Whole blocks of bins are decided first.
    constexpr int kBlockRings = 4, kBlockSectors = 16, kSplits = 2;
    const auto verdict_of = [&](int ring, int rings, int sector, int sectors, int splits) {
        return verdictOf(view, foot,
                         {std::max(0.0, (ring - kDilation) * ring_width),
                          (ring + rings + kDilation) * ring_width},
                         {(sector - kDilation) * kSector, (sector + sectors + kDilation) * kSector},
                         splits);
    };
    std::array<HeldVerdict, kSectors> ahead_of{};
    std::array<HeldVerdict, kSectors / kBlockSectors> blocks{};
    for (int ring = 0; ring < kRings; ++ring) {
        if (ring % kBlockRings == 0)
            for (int i = 0; i < kSectors / kBlockSectors; ++i)
                blocks[static_cast<std::size_t>(i)] =
                    verdict_of(ring, kBlockRings, i * kBlockSectors, kBlockSectors, 0);
        for (int sector = 0; sector < kSectors; ++sector) {
            const HeldVerdict& block = blocks[static_cast<std::size_t>(sector / kBlockSectors)];
            ahead_of[static_cast<std::size_t>(sector)] =
                block.unsure == 0 ? block : verdict_of(ring, 1, sector, 1, kSplits);
        }
        for (std::size_t sector = 0; sector < kSectors; ++sector) {
            HeldVerdict all;
            for (std::size_t k = 0; k < turns.size(); ++k) {
                const HeldVerdict& one = ahead_of[(sector + turns[k].first) % kSectors];
                const HeldVerdict& other = ahead_of[(sector + turns[k].second) % kSectors];
                const std::uint64_t bit = std::uint64_t{1} << k;
                if ((one.held & other.held) != 0)
                    all.held |= bit;
                else if ((one.held | one.unsure | other.held | other.unsure) != 0)
                    all.unsure |= bit;
            }
            const auto [known, is_new] = numbers.try_emplace(
                {all.held, all.unsure}, static_cast<std::uint16_t>(verdicts_.size()));
            if (is_new && verdicts_.size() > std::numeric_limits<std::uint16_t>::max())
                known->second = 0;
            else if (is_new)
                verdicts_.push_back(all);
            pattern_[index(ring, static_cast<int>(sector))] = known->second;
        }
    }
}

namespace {

/// Rings and sectors of a table.
struct Bins {
    float rings_per_metre;
    std::int32_t rings, sectors;
};

constexpr std::size_t kBlock = 64;  // points

/// Finds the bins of points in a row, numbered ring by ring.
ISPACE_SIMD_CLONES void findBins(const Bins& bins, float first, float apart, float up,
                                 std::array<std::int32_t, kBlock>& places) {
    const float per_radian = static_cast<float>(bins.sectors) / (2 * std::numbers::pi_v<float>);
    const auto rings = static_cast<float>(bins.rings);
    const auto last_sector = static_cast<float>(bins.sectors - 1);
    for (std::size_t i = 0; i < kBlock; ++i) {
        const float right = first + apart * static_cast<float>(static_cast<std::int32_t>(i));
        const float far = std::sqrt(right * right + up * up) * bins.rings_per_metre;
        const auto ring = static_cast<std::int32_t>(std::min(far, rings));
        const auto sector =
            static_cast<std::int32_t>(std::min(angleOf(right, up) * per_radian, last_sector));
        places[i] = ring * bins.sectors + sector;
    }
}

}  // namespace

void TurnedViews::find(double x, double step, double y, std::span<const HeldVerdict*> row) const {
    const Bins bins{rings_per_metre_, kRings, kSectors};
    std::array<std::int32_t, kBlock> places;  // NOLINT: filled by blocks
    const auto from = static_cast<float>(x), apart = static_cast<float>(step);
    const auto up = static_cast<float>(y);
    for (std::size_t begin = 0; begin < row.size(); begin += kBlock) {
        const std::size_t count = std::min(kBlock, row.size() - begin);
        const float first = from + apart * static_cast<float>(begin);
        findBins(bins, first, apart, up, places);
        for (std::size_t i = 0; i < count; ++i)
            row[begin + i] = &verdicts_[pattern_[static_cast<std::size_t>(places[i])]];
    }
}

}  // namespace ispace
