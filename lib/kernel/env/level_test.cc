// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/level.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <thread>

#include "geom/predicates.h"
#include "support/test_scene.h"

namespace ispace {
namespace level_test {

using testing::environment;

constexpr const char* kRoom =
    "ispace at=0,0 size=8,6\n"
    "wall from=-1,-1 to=1,-1 height=1\n"
    "cube at=2,2 size=1,1,0.5\n"
    "cube at=-2,2,0.5 size=1,1,0.5\n"
    "pillar at=-2,-2 kind=round\n";

TEST(Lazy, MakesOnceAndAgainAfterAFailure) {
    const Lazy<int> lazy;
    EXPECT_EQ(lazy.peek(), nullptr);
    EXPECT_THROW(lazy.get([]() -> int { throw std::runtime_error("no"); }), std::runtime_error);
    EXPECT_EQ(lazy.get([] { return 3; }), 3);
    EXPECT_EQ(lazy.get([] { return 4; }), 3);
    EXPECT_EQ(*lazy.peek(), 3);
}

// As where another task of a loop finds no memory: loops within that loop are left out.
TEST(Level, IsWholeIfWhatAsksForItIsCancelled) {
    const Environment room = environment(kRoom);
    const auto level = room.level(0.15);
    const Point2 viewpoint{0.5, 0.25};
    VisibleRegion seen;
    tbb::task_group_context context;
    tbb::parallel_for(
        0, 1,
        [&](int) {
            context.cancel_group_execution();
            level->query(viewpoint, 0, seen);
            static_cast<void>(level->freeFloor());
        },
        context);
    const VisibilityMap map(level->slice().straightLines(), level->slice().curves());
    level->query(viewpoint, 10, seen);
    EXPECT_EQ(seen.edges.size(), map.query(viewpoint, 10).edges.size());
    EXPECT_GT(seen.edges.size(), 4U);
    double area = 0;
    for (const Region& region : level->freeFloor()) area += region.area();
    EXPECT_NEAR(area, 48 - testing::areaOf(level->slice().solids), 1e-9);
}

TEST(Level, AnswersAsItsSliceDoes) {
    const Environment room = environment(kRoom);
    // Between things, where some end and begin, at the very top, above all, below the floor.
    for (const double height : {0.0, 0.15, 0.5, 0.7, 1.0, 2.5, 2.6, -0.1}) {
        const auto level = room.level(height);
        const Slice slice = room.slice(height);
        EXPECT_EQ(level->height(), height);
        EXPECT_EQ(level->slice().sheets, slice.sheets);
        EXPECT_EQ(level->slice().solids, slice.solids);
        EXPECT_EQ(level->slice().sheet_owners, slice.sheet_owners);
        EXPECT_EQ(level->slice().solid_owners.size(), slice.solids.size());
        double area = 0;
        for (const Region& region : level->freeFloor()) area += region.area();
        EXPECT_NEAR(area, 48 - testing::areaOf(slice.solids), 1e-9);
        for (double x = -5; x <= 5; x += 0.25)
            for (double y = -4; y <= 4; y += 0.25) {
                const Point2 p{x, y};
                bool is_free = room.indoor().locate(p) == Side::Inside && !slice.blocked(p);
                for (const Segment2& sheet : slice.sheets)
                    is_free = is_free && !intersects(sheet, {p, p});
                EXPECT_EQ(level->isFree(p), is_free) << x << ' ' << y << " at " << height;
                if (level->isInsideSolid(p)) {
                    EXPECT_TRUE(slice.blocked(p));
                }
            }
    }
}

TEST(Level, KnowsWhoseItsPartsAre) {
    const Environment room = environment(kRoom);
    const auto level = room.level(0.5);
    EXPECT_EQ(level->slice().sheet_owners, (std::vector<std::size_t>{0, 0, 0, 0, 1}));
    EXPECT_EQ(level->slice().solid_owners, (std::vector<std::size_t>{2, 3, 4}));
    ASSERT_EQ(level->slice().rounds.size(), 1U);
    EXPECT_EQ(level->slice().rounds[0].solid, 2U);
}

TEST(Level, SeesAsAVisibilityMapAndNothingFromWithinSolids) {
    const Environment room = environment(kRoom);
    const auto level = room.level(0.15);
    const VisibilityMap map(level->slice().straightLines(), level->slice().curves());
    VisibleRegion region;
    for (const Point2 p : {Point2{0, 0}, {3, -2}, {2.5, 2}, {2.5 - 1e-5, 2}}) {
        level->query(p, 4, region);
        EXPECT_EQ(area(region), area(map.query(p, 4)));
        EXPECT_GT(area(region), 0);
    }
    EXPECT_EQ(level->solidsTouching({2.5, 2}).size(), 1U);
    level->query({2, 2}, 4, region);
    EXPECT_TRUE(level->isInsideSolid({2, 2}));
    EXPECT_TRUE(region.edges.empty());
    EXPECT_TRUE(region.is_whole);
    EXPECT_EQ(region.max_range, 4);
    room.level(9)->query({2, 2}, 4, region);
    EXPECT_NEAR(area(region), 16 * M_PI, 1e-6) << "above the walls";
}

TEST(Level, IsTheSameOneForAll) {
    std::optional<Environment> room = environment(kRoom);
    const auto level = room->level(0.15);
    EXPECT_EQ(room->level(0.15), level);
    EXPECT_NE(room->level(0.2), level);
    const Environment copy = *room;
    EXPECT_EQ(copy.level(0.15), level);
    // Not a number is no height, but does no harm.
    EXPECT_TRUE(room->level(std::numeric_limits<double>::quiet_NaN())->slice().sheets.empty());
    room.reset();
    EXPECT_EQ(copy.level(0.15), level);
    EXPECT_EQ(level->freeFloor().size(), 1U);
}

TEST(Level, EqualCutsAreShared) {
    const Environment room = environment(kRoom);
    // The low cube alone, both cubes at the height where they touch, the upper one, the walls.
    const auto low = room.level(0.1), also_low = room.level(0.3), both = room.level(0.5);
    const auto high = room.level(0.7), above = room.level(1.2);
    EXPECT_NE(low, also_low);
    EXPECT_EQ(also_low->height(), 0.3);
    EXPECT_EQ(&low->slice(), &also_low->slice());
    EXPECT_EQ(&low->freeFloor(), &also_low->freeFloor());
    for (const auto& other : {both, high, above}) EXPECT_NE(&low->slice(), &other->slice());
    // As many solids, elsewhere.
    EXPECT_EQ(low->slice().solids.size(), high->slice().solids.size());
    const Environment edited = environment(std::string(kRoom) + "cube at=3,0 size=0.2,0.2,0.2\n");
    EXPECT_NE(&edited.level(0.1)->slice(), &edited.level(0.3)->slice());
}

TEST(Level, OutlivesItsEnvironment) {
    const auto level = environment(kRoom).level(0.15);
    EXPECT_TRUE(level->isFree({0, 0}));
    EXPECT_EQ(level->freeFloor().size(), 1U);
}

TEST(Level, FewAreKept) {
    const Environment room = environment(kRoom);
    const std::weak_ptr<const Level> first = room.level(0.001), used = room.level(0.002);
    const auto held = used.lock();
    for (int i = 10; i < 1000; ++i) EXPECT_EQ(room.level(0.001 * i)->height(), 0.001 * i);
    EXPECT_TRUE(first.expired());
    EXPECT_TRUE(held->isFree({0, 0}));
}

TEST(Level, IsFoundAgainWhileSomebodyHoldsIt) {
    const Environment room = environment(kRoom);
    const auto held = room.level(0.001);
    for (int i = 0; i < 200; ++i) static_cast<void>(room.level(0.01 + 0.001 * i));
    EXPECT_EQ(room.level(0.001), held);
}

TEST(Level, LargeOnesAreKeptOneByOne) {
    std::string lines = "ispace at=0,0 size=80,60\n";
    for (int i = 0; i < 100; ++i)
        for (int j = 0; j < 40; ++j)
            lines += "cylinder at=" + std::to_string(0.5 * i - 37) + ',' + std::to_string(j - 20) +
                     " size=0.2,0.2,1\n";
    const Environment room = environment(lines);
    // One is less than the 500,000 lines that are kept, two are more.
    const auto of = [&](double height) {
        const auto level = room.level(height);
        EXPECT_EQ(level->slice().solids.size(), 4000U);
        EXPECT_GT(level->linesMade(), 250'000U);
        EXPECT_LE(level->linesMade(), 500'000U);
        return std::weak_ptr(level);
    };
    const auto a = of(0.1), b = of(0.2);
    EXPECT_FALSE(a.expired());
    const auto c = of(0.3);
    EXPECT_TRUE(a.expired());
    EXPECT_FALSE(b.expired());
    EXPECT_FALSE(c.expired());
}

TEST(Level, ManyThreadsShareOne) {
    for (int round = 0; round < 20; ++round) {
        const Environment room = environment(kRoom);
        std::vector<std::thread> threads;
        std::atomic<int> right = 0;
        for (int thread = 0; thread < 4; ++thread)
            threads.emplace_back([&] {
                VisibleRegion region;
                for (int i = 0; i < 100; ++i) {
                    const auto level = room.level(0.01 * (i % 3));
                    level->query({0, 0}, 3, region);
                    const bool is_right = level->isFree({0, 0}) && !level->isFree({2, 2}) &&
                                          level->freeFloor().size() == 1 && !region.edges.empty();
                    right += is_right ? 1 : 0;
                }
            });
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(right, 400);
    }
}

}  // namespace level_test
}  // namespace ispace
