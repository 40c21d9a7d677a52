// SPDX-License-Identifier: GPL-3.0-or-later
#include "random_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "env/level.h"
#include "geom/arrangement.h"
#include "plan_scene.h"

namespace ispace::testing {
namespace {

PlanOptions optionsOf(std::uint64_t seed) {
    PlanOptions options;
    options.seed = seed;
    options.area = 25 + 15 * static_cast<double>(seed);
    options.is_askew = seed % 2 == 0;
    return options;
}

std::map<std::string, int> countsOf(const Environment& environment) {
    std::map<std::string, int> counts;
    for (const Element& element : environment.elements()) ++counts[element.record.keyword()];
    return counts;
}

TEST(RandomPlan, CompilesToOneRegionOfAboutTheArea) {
    std::size_t holes = 0;
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(seed);
        const PlanOptions options = optionsOf(seed);
        const Environment plan = environmentOf(randomPlan(options));
        // All rooms are joined: each door is open.
        EXPECT_NEAR(plan.indoor().area(), options.area, 0.06 * options.area);
        auto counts = countsOf(plan);
        const double rooms = options.area / options.room_area;
        EXPECT_GE(counts["wall"] + 1, 0.5 * rooms);
        EXPECT_LE(counts["wall"] + 1, 2 * rooms);
        EXPECT_EQ(counts["door"], counts["wall"]);
        const int pieces = counts["desk"] + counts["table"] + counts["chair"] + counts["cube"];
        EXPECT_GE(pieces, 0.15 * options.area);
        // Closed fences are holes of the region, things of the free floor.
        EXPECT_GE(plan.indoor().parts.at(0).holes.size(),
                  static_cast<std::size_t>(counts["fence"] - 1));
        holes += plan.indoor().parts.at(0).holes.size();
        EXPECT_LT(totalArea(plan.level(kScanHeight)->freeFloor()), plan.indoor().area());
    }
    EXPECT_GT(holes, 60U);
}

TEST(RandomPlan, ThingsStandClearOfEachOther) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Environment plan = environmentOf(randomPlan(optionsOf(seed)));
        constexpr double kHeight = 0.5;
        double sum = 0;
        for (const Element& element : plan.elements()) {
            std::vector<Polygon> solids;
            for (const Prism& prism : element.body.prisms)
                if (prism.bottom <= kHeight && kHeight <= prism.top)
                    solids.push_back(prism.curve ? outlineOf(*prism.curve) : prism.footprint);
            sum += totalArea(unite(solids));
        }
        const double free_area = totalArea(plan.level(kHeight)->freeFloor());
        EXPECT_NEAR(plan.indoor().area() - free_area, sum, 1e-6) << seed;
    }
}

TEST(RandomPlan, DependsOnTheOptionsAlone) {
    const PlanOptions options = optionsOf(4);
    EXPECT_EQ(randomPlan(options), randomPlan(options));
    PlanOptions other = options;
    other.seed = 5;
    EXPECT_NE(randomPlan(options), randomPlan(other));
}

TEST(RandomPlan, MayBeTinyOrLarge) {
    const Environment tiny = environmentOf(randomPlan({.seed = 3, .area = 6}));
    EXPECT_NEAR(tiny.indoor().area(), 6, 0.01);
    const Environment large = environmentOf(randomPlan({.seed = 3, .area = 3000}));
    EXPECT_NEAR(large.indoor().area(), 3000, 100);
    EXPECT_GT(countsOf(large)["wall"], 100);
}

}  // namespace
}  // namespace ispace::testing
