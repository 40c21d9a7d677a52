// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/gallery/gallery.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "extensions/proofs/gallery/witness_sets.h"
#include "geom/arrangement.h"
#include "geom/visibility/visibility.h"
#include "support/test_problems.h"

namespace ispace::proofs {
namespace gallery_test {

GalleryCover guarded(const Polygon& outline, const std::vector<Polygon>& holes = {}) {
    const std::vector<Region> floor{{outline, holes}};
    SilentProgress progress;
    return guardGallery(floor, progress);
}

/// The number of guards, if it is proven; else 0.
std::size_t provenCount(const Polygon& outline, const std::vector<Polygon>& holes = {}) {
    const GalleryCover cover = guarded(outline, holes);
    return cover.isProven() ? cover.guards.size() : 0;
}

/// Chvatal's comb: floor(n / 3) guards for n = 3 * teeth corners.
Polygon comb(int teeth) {
    Polygon outline;
    for (int i = 0; i < teeth; ++i) {
        outline.push_back({2.0 * i, 0});
        outline.push_back({2.0 * i + 0.5, 5});
        outline.push_back({2.0 * i + 1, 0});
    }
    // Teeth point upwards from a flat bar.
    outline.push_back({2.0 * teeth - 1, -0.3});
    outline.push_back({0, -0.3});
    std::reverse(outline.begin(), outline.end());
    return outline;
}

/// An orthogonal staircase with equal steps.
Polygon stairs(int steps) {
    Polygon outline{{0, 0}, {static_cast<double>(steps), 0}};
    for (int i = 0; i < steps; ++i) {
        outline.push_back({static_cast<double>(steps - i), i + 1.0});
        outline.push_back({static_cast<double>(steps - i - 1), i + 1.0});
    }
    outline.pop_back();
    outline.push_back({0, static_cast<double>(steps)});
    return outline;
}

TEST(Gallery, ConvexRoomsTakeOneGuard) {
    EXPECT_EQ(provenCount({{0, 0}, {4, 0}, {4, 3}, {0, 3}}), 1U);
    EXPECT_EQ(provenCount({{0, 0}, {1, 0}, {0, 1e-3}}), 1U);
    EXPECT_EQ(provenCount({{1e5, 1e5}, {1e5 + 4, 1e5}, {1e5 + 5, 1e5 + 3}, {1e5, 1e5 + 3}}), 1U);
}

TEST(Gallery, StarShapedRoomsTakeOneGuard) {
    EXPECT_EQ(provenCount({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}), 1U);
    // The kernel is one point: four spikes whose sides meet in the origin.
    EXPECT_EQ(provenCount({{2, 0}, {1, 1}, {0, 2}, {-1, 1}, {-2, 0}, {-1, -1}, {0, -2}, {1, -1}}),
              1U);
    EXPECT_EQ(provenCount(stairs(6)), 1U);
}

TEST(Gallery, KernelOfOnePoint) {
    // Both arms must be seen along the lines of their inner walls, which meet in (0, 0) alone.
    const Polygon arms{{-1, -1}, {3, -1}, {3, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}, {0, 3}, {-1, 3}};
    EXPECT_EQ(provenCount(arms), 1U);
}

TEST(Gallery, ChvatalsCombs) {
    for (const int teeth : {2, 3, 5, 8})
        EXPECT_EQ(provenCount(comb(teeth)), static_cast<std::size_t>(teeth)) << teeth;
}

TEST(Gallery, UShapeTakesTwo) {
    EXPECT_EQ(provenCount({{0, 0}, {6, 0}, {6, 9}, {5, 9}, {5, 1}, {1, 1}, {1, 9}, {0, 9}}), 2U);
}

TEST(Gallery, Holes) {
    const Polygon room{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    EXPECT_EQ(provenCount(room, {{{4, 4}, {4, 6}, {6, 6}, {6, 4}}}), 2U);
    EXPECT_EQ(
        provenCount(room, {{{2, 2}, {2, 3}, {3, 3}, {3, 2}}, {{7, 7}, {7, 8}, {8, 8}, {8, 7}}}),
        2U);
}

TEST(Gallery, RoomsApartNeedGuardsEach) {
    const std::vector<Region> floor{{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}},
                                    {{{3, 0}, {4, 0}, {4, 1}, {3, 1}}, {}}};
    SilentProgress progress;
    const GalleryCover cover = guardGallery(floor, progress);
    EXPECT_EQ(cover.guards.size(), 2U);
    EXPECT_EQ(cover.bound, 2U);
}

TEST(Gallery, CollinearAndDoubledCorners) {
    EXPECT_EQ(provenCount({{0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 3}, {2, 3}, {0, 3}, {0, 1}}), 1U);
}

TEST(Gallery, NoFloorNeedsNoGuard) {
    SilentProgress progress;
    EXPECT_TRUE(guardGallery({}, progress).guards.empty());
}

Polygon randomStar(std::mt19937& random, int corners) {
    std::uniform_real_distribution<double> share(0, 1);
    Polygon outline;
    for (int i = 0; i < corners; ++i) {
        const double turn = 2 * std::numbers::pi * (i + 0.8 * share(random)) / corners;
        const double reach = 2 + 8 * share(random);
        outline.push_back({reach * std::cos(turn), reach * std::sin(turn)});
    }
    return outline;
}

TEST(Gallery, GuardsSeeTheFloor) {
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
        const Region floor{randomStar(random, 12 + round), {}};
        const GalleryCover cover = guarded(floor.outline);
        ASSERT_EQ(cover.guards.size(), 1U);  // the origin sees all
        std::vector<Segment2> walls;
        floor.forEachEdge([&](const Segment2& wall) { walls.push_back(wall); });
        const VisibilityMap map(walls);
        const VisibleRegion seen = map.query(cover.guards[0], 100);
        const std::vector<Polygon> solids{chords(outlineOf(seen))};
        EXPECT_LE(totalArea(difference(floor, solids)), 1e-9 * floor.area());
    }
}

TEST(WitnessSets, HoldTheWitnessesOfEachPoint) {
    std::mt19937 random(3);
    for (int round = 0; round < 10; ++round) {
        const std::vector<Region> regions{{randomStar(random, 40), {}}};
        const gallery::Floor floor(regions);
        std::vector<gallery::Witness> witnesses;
        for (const Segment2& wall : floor.walls()) {
            const VisibleRegion view = floor.viewFrom(wall.a);
            if (auto windows = floor.windowsOf(view))
                witnesses.push_back({gallery::StarView(view, floor.walls()), *windows});
        }
        ASSERT_GT(witnesses.size(), 20U);
        SilentProgress progress;
        const auto sets = gallery::largestWitnessSets(floor, witnesses, progress).value();
        std::uniform_real_distribution<double> at(-gallery::kScaledExtent, gallery::kScaledExtent);
        for (int i = 0; i < 2000; ++i) {
            const Point2 p{at(random), at(random)};
            if (floor.regions()[0].locate(p) != Side::Inside) continue;
            const VisibleRegion seen = floor.viewFrom(p);
            std::vector<std::uint32_t> own;
            for (std::uint32_t w = 0; w < witnesses.size(); ++w)
                if (holds(seen, witnesses[w].view.viewpoint() +
                                    1e-9 * (p - witnesses[w].view.viewpoint())))
                    own.push_back(w);
            EXPECT_TRUE(std::any_of(sets.begin(), sets.end(), [&](const auto& set) {
                return std::includes(set.witnesses.begin(), set.witnesses.end(), own.begin(),
                                     own.end());
            }));
        }
    }
}

TEST(Gallery, SameForAnyNumberOfThreads) {
    const auto solve = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return guarded(comb(9));
    };
    const GalleryCover one = solve(1), two = solve(2);
    EXPECT_EQ(one.guards, two.guards);
    EXPECT_EQ(one.witnesses, two.witnesses);
}

TEST(Gallery, StoppedKeepsAnHonestInterval) {
    const std::vector<Region> floor{{comb(6), {}}};
    for (const int queries : {0, 1, 5, 20, 40, 60, 100, 200}) {
        StopWhen progress(afterAsking(queries));
        const GalleryCover cover = guardGallery(floor, progress);
        EXPECT_GE(cover.guards.size(), 6U) << queries;
        EXPECT_GE(cover.bound, 1U) << queries;
        EXPECT_LE(cover.bound, 6U) << queries;
        EXPECT_FALSE(cover.witnesses.empty()) << queries;
        EXPECT_LE(cover.missed, kMissedShare * floor[0].area());
    }
}

}  // namespace gallery_test
}  // namespace ispace::proofs
