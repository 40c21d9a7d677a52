// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/poses/outer_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "extensions/proofs/test_pose_floors.h"
#include "geom/visibility/visibility.h"

namespace ispace::proofs::poses {
namespace outer_bound_test {

constexpr double kPi = std::numbers::pi;

double areaOf(const PoseFloor& floor, const std::vector<std::uint8_t>& parts) {
    return static_cast<double>(std::accumulate(parts.begin(), parts.end(), std::uint64_t{0})) *
           floor.partArea();
}

struct Seen {
    std::vector<Segment2> walls;
    VisibilityMap map;
    explicit Seen(const Region& region) : walls(wallsOf(region)), map(walls) {}
    static std::vector<Segment2> wallsOf(const Region& region) {
        std::vector<Segment2> walls;
        region.forEachEdge([&](const Segment2& edge) { walls.push_back(edge); });
        return walls;
    }
    [[nodiscard]] VisibleRegion from(Point2 p, const Sector& sector, double heading) const {
        const VisibleRegion whole = map.query(p, sector.range);
        if (sector.isRound()) return whole;
        return sectorOf(whole, Angle::radians(heading + sector.first),
                        Angle::radians(sector.field));
    }
};

TEST(OuterBound, AFloorInCellsHasItsArea) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, 5000);
    EXPECT_NEAR(floor.area(), region.area(), 1e-12);
    EXPECT_GE(areaOf(floor, floor.parts()), region.area() - 1e-9);
    EXPECT_LE(areaOf(floor, floor.parts()), region.area() * 1.005);
}

TEST(OuterBound, AViewFromAPointHasItsExactArea) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, 5000);
    const Seen seen(region);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(0.1, 10.9), y(0.1, 4.9), turn(0, 2 * kPi);
    for (const double field : {0.5, kPi / 2, kPi, 4.0, 2 * kPi})
        for (int i = 0; i < 40; ++i) {
            const Point2 p{x(random), y(random)};
            if (region.locate(p) != Side::Inside) continue;
            const Sector sector{3, field, -field / 2};
            const double heading = turn(random);
            const double exact = area(seen.from(p, sector, heading));
            const OuterBound view = outerBoundOf(floor, sector, {{p, p}, heading, 0});
            EXPECT_GE(view.area, exact - 1e-9);
            EXPECT_LE(view.area, exact * 1.01 + 0.02) << p.x << ' ' << p.y << ' ' << field;
            EXPECT_GE(areaOf(floor, view.parts), exact - 1e-6);
        }
}

TEST(OuterBound, HoldsAllViewsOfItsPosesAndLittleElse) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, 5000);
    const Seen seen(region);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> x(0.1, 10), y(0.1, 4), turn(0, 2 * kPi), unit(0, 1);
    for (const double field : {0.5, 2.5, 4.0, 2 * kPi})
        for (const double side : {0.05, 0.5, 1.5})
            for (int i = 0; i < 6; ++i) {
                const Sector sector{3.5, field, -field / 2};
                const Point2 low{x(random), y(random)};
                const PoseBox box{{low, low + Vec2{side, side}}, turn(random), side / 2};
                const OuterBound view = outerBoundOf(floor, sector, box);
                std::vector<std::uint8_t> all(floor.parts().size());
                double largest = 0;
                for (int k = 0; k < 300; ++k) {
                    const Point2 p = low + Vec2{side * unit(random), side * unit(random)};
                    if (region.locate(p) != Side::Inside) continue;
                    const double heading = box.from + unit(random) * box.span;
                    largest = std::max(largest, area(seen.from(p, sector, heading)));
                    const OuterBound one = outerBoundOf(floor, sector, {{p, p}, heading, 0});
                    for (std::size_t c = 0; c < all.size(); ++c) {
                        all[c] = std::max(all[c], one.parts[c]);
                        // Parts are rounded up.
                        ASSERT_GE(int{view.parts[c]} + 1, int{one.parts[c]});
                    }
                }
                EXPECT_GE(view.area, largest - 1e-9);
                // Few samples of a large box miss the corners of its poses.
                EXPECT_LE(areaOf(floor, view.parts), 1.35 * areaOf(floor, all) + 0.3);
                if (side < 0.1) {
                    EXPECT_LE(areaOf(floor, view.parts), 1.03 * areaOf(floor, all) + 0.05);
                }
            }
}

TEST(OuterBound, AFieldOfAHalfTurnWithItsHeadings) {
    const Region region = roomsWithPillar();
    const PoseFloor floor({&region, 1}, 5000);
    const Seen seen(region);
    for (const double span : {kPi / 2 - 1e-9, kPi / 2, kPi / 2 + 1e-9})
        for (int turn = 0; turn < 4; ++turn) {
            const Sector sector{2, kPi / 2, 0};
            const double heading = turn * kPi / 2;
            const OuterBound view = outerBoundOf(floor, sector, {{{2, 2}, {3, 3}}, heading, span});
            // The sector in the middle of these headings, from the middle of the box.
            EXPECT_GE(view.area, area(seen.from({2.5, 2.5}, sector, heading + kPi / 4)));
            EXPECT_GE(areaOf(floor, view.parts), kPi * 2 * 2 / 2 + 1);
        }
}

}  // namespace outer_bound_test
}  // namespace ispace::proofs::poses
