// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/poses/pose_search.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "extensions/proofs/poses/pose_boxes.h"
#include "geom/arrangement.h"
#include "geom/visibility/visibility.h"
#include "support/test_problems.h"

namespace ispace::proofs {
namespace pose_search_test {

constexpr double kPi = std::numbers::pi;

using poses::PoseFloor;
using poses::Sector;

PoseBound boundOf(const Region& region, const Sector& sector, PoseSearchOptions options,
                  int rounds = 60) {
    const PoseFloor floor({&region, 1}, 3000);
    StopWhen stop(afterAsking(rounds));
    return boundOverPoses(floor, sector, options, stop);
}

Region rectangle(double width, double depth) {
    return {{{0, 0}, {width, 0}, {width, depth}, {0, depth}}, {}};
}
Region letterL() { return {{{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 6}, {0, 6}}, {}}; }
/// Two rooms and a door.
Region twoRooms() {
    return {{{0, 0},
             {4, 0},
             {4, 1},
             {4.2, 1},
             {4.2, 0},
             {8, 0},
             {8, 4},
             {4.2, 4},
             {4.2, 2},
             {4, 2},
             {4, 4},
             {0, 4}},
            {}};
}

TEST(PoseSearch, ASectorThatFitsHasItsClosedForm) {
    const Sector sector{2, 2 * kPi / 3, -kPi / 3};
    const double one = 4 * kPi / 3;
    for (const int sensors : {1, 2, 3}) {
        const PoseBound found =
            boundOf(rectangle(9, 7), sector, {.sensors = sensors, .found = sensors * one});
        EXPECT_NEAR(found.bound, sensors * one, 1e-9);
        EXPECT_TRUE(found.is_complete);
    }
}

TEST(PoseSearch, TheLargestPartOfADiscInAStrip) {
    // In a strip 2 m wide a disc of 3 m around any point on the middle line sees most.
    const double half = std::sqrt(8.0);
    const double most = 2 * (half + 9 * std::asin(1.0 / 3));
    const PoseBound found =
        boundOf(rectangle(20, 2), {3, 2 * kPi, 0}, {.sensors = 1, .found = most, .gap = 0.01}, 400);
    EXPECT_TRUE(found.is_complete);
    EXPECT_GE(found.bound, most - 1e-9);
    EXPECT_LE(found.bound, most / 0.99 + 1e-9);
}

TEST(PoseSearch, WithoutLimitsOfSightAgreesWithGuards) {
    // One guard sees all of the L, and two all of the two rooms, but one does not.
    const Sector around{20, 2 * kPi, 0};
    EXPECT_NEAR(boundOf(letterL(), around, {.sensors = 1, .found = 20}).bound, 20, 0.1);
    const double all = twoRooms().area();
    const PoseBound one = boundOf(twoRooms(), around, {.sensors = 1, .found = 0, .gap = 0}, 40);
    EXPECT_LT(one.bound, 0.98 * all);
    EXPECT_NEAR(boundOf(twoRooms(), around, {.sensors = 2, .found = all}).bound, all, 0.1);
}

/// Area that lasers at random poses see, the best of many.
double bestOfRandom(const Region& region, const Sector& sector, int sensors, int tries) {
    std::vector<Segment2> walls;
    region.forEachEdge([&](const Segment2& edge) { walls.push_back(edge); });
    const VisibilityMap map(walls);
    const Box2 box = bounds(region.outline);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> x(box.low.x, box.high.x), y(box.low.y, box.high.y),
        turn(0, 360);
    double best = 0;
    for (int i = 0; i < tries; ++i) {
        std::vector<Polygon> views;
        while (views.size() < static_cast<std::size_t>(sensors)) {
            const Point2 p{x(random), y(random)};
            if (region.locate(p) != Side::Inside) continue;
            const VisibleRegion seen =
                sectorOf(map.query(p, sector.range), Angle::degrees(turn(random)),
                         Angle::radians(sector.field));
            Polygon view;  // chords lie within the view
            if (!seen.is_whole) view.push_back(p);
            for (const VisibilityEdge& edge : seen.edges) {
                view.push_back(edge.from);
                view.push_back(edge.to);
            }
            views.push_back(std::move(view));
        }
        best = std::max(best, totalArea(unite(views)));
    }
    return best;
}

TEST(PoseSearch, NeverBelowRandomLayouts) {
    for (const Region& region : {letterL(), twoRooms()})
        for (const double field : {kPi / 2, 4.0})
            for (const int sensors : {1, 2, 3}) {
                const Sector sector{2.5, field, 0};
                const double best = bestOfRandom(region, sector, sensors, 400);
                for (const int rounds : {0, 3, 40}) {
                    const PoseBound found =
                        boundOf(region, sector, {.sensors = sensors, .found = 0, .gap = 0}, rounds);
                    EXPECT_GE(found.bound, best) << sensors << ' ' << field << ' ' << rounds;
                    EXPECT_LE(found.bound, region.area() * 1.01);
                }
            }
}

TEST(PoseSearch, TheBoundFallsWithTime) {
    double before = std::numeric_limits<double>::infinity();
    for (const int rounds : {0, 10, 100, 300}) {
        const double bound =
            boundOf(twoRooms(), {2.5, 2, 0}, {.sensors = 2, .found = 0, .gap = 0}, rounds).bound;
        EXPECT_LE(bound, before);
        before = bound;
    }
    const double sectors = 2 * 2.5 * 2.5;  // two of 2 rad, 2.5 m
    EXPECT_LE(before, sectors);
}

TEST(PoseSearch, TheSameForAnyNumberOfThreads) {
    const auto run = [](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return boundOf(letterL(), {2.5, 2, 0}, {.sensors = 3, .found = 10, .gap = 0.02}, 30);
    };
    const PoseBound one = run(1), four = run(4);
    EXPECT_EQ(one.bound, four.bound);
    EXPECT_EQ(one.boxes, four.boxes);
    EXPECT_EQ(one.tuples, four.tuples);
}

TEST(PoseSearch, ABetterLayoutRaisesWhatIsFound) {
    int calls = 0;
    PoseSearchOptions options{.sensors = 1, .found = 1, .gap = 0};
    options.improve = [&calls](std::span<const poses::PoseBox> boxes) {
        EXPECT_EQ(boxes.size(), 1U);
        ++calls;
        return PosedLayout{5.0, {Pose2{{1, 1}, {}}}};
    };
    const PosedLayout found = boundOf(letterL(), {2, 2, 0}, options, 40).found;
    EXPECT_EQ(found.area, 5);
    EXPECT_EQ(found.poses.size(), 1U);
    EXPECT_GT(calls, 0);
}

TEST(PoseSearch, MemoryCountsEachViewOnce) {
    const Region region = letterL();
    const PoseFloor floor({&region, 1}, 3000);
    const Sector sector{2, 2, 0};
    poses::PoseBoxes boxes(floor, sector);
    const auto expect_sum = [&boxes] {
        std::size_t bytes = 0;
        for (poses::BoxId id = 1; id < boxes.size(); ++id) {
            const poses::BoxNode& node = boxes[id];
            bytes += sizeof(poses::BoxNode);
            for (const poses::CellParts* view :
                 {&node.parts, &node.core, &node.large_parts, &node.large_core, &node.centre})
                bytes += view->parts.size();
        }
        EXPECT_EQ(boxes.bytes(), bytes);
    };
    boxes.splitWithLarge({0});
    expect_sum();
    const poses::BoxId child = boxes[0].child;
    boxes.splitWithLarge({0, child, child + 1});
    expect_sum();
    boxes.splitWithViews({0, child});
    expect_sum();
    boxes.splitWithLarge({child, boxes[child].child});
    expect_sum();
}

TEST(PoseSearch, AFloorWithoutAreaIsSeenByNone) {
    const PoseFloor floor({}, 100);
    SilentProgress silent;
    EXPECT_EQ(boundOverPoses(floor, {2, 2, 0}, {}, silent).bound, 0);
}

}  // namespace pose_search_test
}  // namespace ispace::proofs
