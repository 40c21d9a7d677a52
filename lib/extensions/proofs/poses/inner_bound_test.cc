// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/poses/inner_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "extensions/proofs/poses/box_views.h"
#include "extensions/proofs/test_pose_floors.h"
#include "geom/visibility/visibility.h"

namespace ispace::proofs::poses {
namespace inner_bound_test {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kCells = 5000;

/// A box of poses on a floor, and what single poses see.
class Poses {
  public:
    Poses(const Region& region, std::uint64_t seed) : region_(region), random_(seed) {
        region.forEachEdge([this](const Segment2& edge) { walls_.push_back(edge); });
    }

    double draw(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    PoseBox box(double most_size, double most_span) {
        const Point2 low{draw(0, 11), draw(0, 5)};
        const Vec2 size{std::pow(draw(0.05, 1), 2) * most_size,
                        std::pow(draw(0.05, 1), 2) * most_size};
        return {{low, low + size}, draw(0, 2 * kPi), draw(0, most_span)};
    }

    /// Expects that poses of the box see random points of whole cells. Returns how many it checked.
    int expectSeen(const PoseFloor& floor, const Sector& sector, const PoseBox& box,
                   const std::vector<std::uint8_t>& core) {
        const VisibilityMap map(walls_);
        const double side = std::sqrt(floor.partArea() * kParts);
        int checked = 0;
        for (int k = 0; k < 10; ++k) {
            const bool is_corner = k < 4;
            const Point2 p = is_corner ? Point2{k % 2 == 0 ? box.at.low.x : box.at.high.x,
                                                k / 2 == 0 ? box.at.low.y : box.at.high.y}
                                       : Point2{draw(box.at.low.x, box.at.high.x),
                                                draw(box.at.low.y, box.at.high.y)};
            if (region_.locate(p) != Side::Inside) continue;
            const double turn = k % 3 == 0 ? 0 : k % 3 == 1 ? box.span : draw(0, box.span);
            VisibleRegion seen = map.query(p, sector.range);
            if (!sector.isRound())
                seen = sectorOf(seen, Angle::radians(box.from + turn + sector.first),
                                Angle::radians(sector.field));
            for (std::size_t cell = 0; cell < core.size(); ++cell) {
                if (core[cell] < kParts) continue;
                const auto row = static_cast<double>(cell / floor.columns());
                const auto column = static_cast<double>(cell % floor.columns());
                const Point2 q = floor.box().low + Vec2{(column + draw(0.001, 0.999)) * side,
                                                        (row + draw(0.001, 0.999)) * side};
                EXPECT_TRUE(holds(seen, q)) << p.x << ',' << p.y << " -> " << q.x << ',' << q.y;
                EXPECT_GE(distance(p, q), sector.near);
                if (::testing::Test::HasFailure()) return checked;
                ++checked;
            }
        }
        return checked;
    }

  private:
    const Region& region_;
    std::mt19937_64 random_;
    std::vector<Segment2> walls_;
};

double sumOf(const std::vector<std::uint8_t>& parts) {
    double sum = 0;
    for (const std::uint8_t part : parts) sum += part;
    return sum;
}

TEST(InnerBound, EachPoseOfTheBoxSeesIt) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, kCells);
    Poses poses(region, 3);
    int checked = 0;
    for (const double field : {0.6, kPi / 2, kPi, 4.0, 2 * kPi})
        for (int i = 0; i < 60; ++i) {
            const Sector sector{poses.draw(1, 8), field, -field / 2, i % 4 == 0 ? 0.5 : 0};
            const PoseBox box = poses.box(1.5, std::min(field, 3.0));
            checked += poses.expectSeen(floor, sector, box, innerBoundOf(floor, sector, box));
            if (HasFailure()) return;
        }
    EXPECT_GT(checked, 100'000);
}

TEST(InnerBound, OfOnePoseIsNearlyItsView) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, 20'000);
    Poses poses(region, 4);
    for (const double field : {kPi / 2, kPi, 4.0, 2 * kPi})
        for (int i = 0; i < 20; ++i) {
            const Sector sector{3, field, -field / 2};
            PoseBox box = poses.box(0, 0);
            const OuterBound view = outerBoundOf(floor, sector, box);
            if (view.area < 1) continue;
            const std::vector<std::uint8_t> core = innerBoundOf(floor, sector, box);
            // Cells on the rim are rounded up in one and down in the other, but not out of it.
            EXPECT_GT(sumOf(core), 0.9 * sumOf(view.parts)) << box.at.low.x << ' ' << box.at.low.y;
            for (std::size_t cell = 0; cell < core.size(); ++cell)
                ASSERT_LE(core[cell], view.parts[cell]);
        }
}

TEST(InnerBound, OfTheCheckIsNoSmallerAndLiesInItsView) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, kCells);
    Poses poses(region, 5);
    for (const double field : {0.6, kPi / 2, kPi, 4.0, 2 * kPi}) {
        const Sector sector{3.5, field, -field / 2, 0.2};
        const BoxViews views({&region, 1}, kCells, sector);
        for (int i = 0; i < 60; ++i) {
            const PoseBox box = poses.box(1.5, std::min(field, 3.0));
            const std::vector<std::uint8_t> core = innerBoundOf(floor, sector, box);
            const BoxCore checked = views.coreOf(box);
            const BoxView view = views.viewOf(box);
            const auto at = [](const auto& parts, std::size_t cell) {
                const bool is_in = cell >= parts.first && cell - parts.first < parts.parts.size();
                return is_in ? int{parts.parts[cell - parts.first]} : 0;
            };
            const double scale = double{BoxViews::kParts} / kParts;
            for (std::size_t cell = 0; cell < core.size(); ++cell) {
                ASSERT_GE(at(checked, cell) + 1, core[cell] * scale - 1) << i << ' ' << cell;
                ASSERT_LE(at(checked, cell), at(view, cell)) << i << ' ' << cell;
            }
        }
    }
}

/// Beyond the near edges of a pocket, the two sides of a line of sight may cross: there is no view,
/// least of all behind the box.
TEST(InnerBound, OfTheCheckEndsWhereLinesOfSightEnd) {
    const Region region{
        {{-5, 1}, {2, -1.2}, {2, 0.5}, {1, 0.5}, {-0.2, 0.5}, {-0.2, -0.1}, {1, -0.1}, {1, -0.4}},
        {}};
    const PoseFloor floor({&region, 1}, kCells);
    const Sector sector{30, 2 * kPi, 0};
    const BoxViews views({&region, 1}, kCells, sector);
    const PoseBox box{{{0.28, -0.07}, {0.32, -0.03}}, 0, 0};
    const BoxCore core = views.coreOf(box);
    const BoxView one = views.viewOf({{{0.3, -0.05}, {0.3, -0.05}}, 0, 0});
    ASSERT_FALSE(core.parts.empty());
    for (std::size_t i = 0; i < core.parts.size(); ++i) {
        const std::size_t cell = core.first + i;
        const bool is_in = cell >= one.first && cell - one.first < one.parts.size();
        ASSERT_LE(core.parts[i], is_in ? one.parts[cell - one.first] : 0) << cell;
    }
}

}  // namespace inner_bound_test
}  // namespace ispace::proofs::poses
