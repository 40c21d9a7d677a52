// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility/mesh_tiles.h"

#include <gtest/gtest.h>

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "geom/visibility/visibility.h"
#include "geom/visibility/visibility_query.h"
#include "support/test_plans.h"

namespace ispace {
namespace mesh_tiles_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Short walls all over a plan of 400 m x 300 m, of which many cross, and a long one.
std::vector<Segment2> largePlan(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const Box2 box{{-100, 50}, {300, 350}};
    std::vector<Segment2> lines = {{{-90, 60}, {290, 340}}};
    for (int i = 0; i < 9000; ++i) {
        const Point2 a = test::randomIn(random, box);
        lines.push_back({a, a + (test::randomIn(random, {{-4, -4}, {4, 4}}) - Point2{})});
    }
    return lines;
}

/// The view within a range from a point strictly inside a triangle.
VisibleRegion viewIn(const ExpansionMesh& mesh, Point2 p, double range) {
    VisibleRegion view{.viewpoint = p, .max_range = range, .is_whole = true, .edges = {}};
    const double farthest = length(mesh.box.high - mesh.box.low);
    Expansion<true, false> search(mesh.portals.data(), p, range, farthest, {}, view.edges);
    const std::uint32_t triangle = mesh.locate(p);
    for (std::uint32_t i = 0; i < 3; ++i) search.throughEdge(3 * triangle + i);
    search.run();
    search.out().finish();
    return view;
}

void mustBeSame(const VisibleRegion& view, const VisibleRegion& wanted) {
    EXPECT_EQ(view.viewpoint, wanted.viewpoint);
    ASSERT_EQ(view.edges.size(), wanted.edges.size());
    for (std::size_t i = 0; i < view.edges.size(); ++i) {
        EXPECT_EQ(view.edges[i].from, wanted.edges[i].from);
        EXPECT_EQ(view.edges[i].to, wanted.edges[i].to);
        EXPECT_EQ(view.edges[i].line, wanted.edges[i].line);
    }
}

TEST(MeshTiles, ViewsAreThoseOfTheWholePlanToTheBit) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const std::vector<Segment2> lines = largePlan(seed);
        const std::vector<Ellipse> rounds = {{{100, 200}, 2, 1, Angle::degrees(30)}};
        const VisibilityMap map(lines, rounds);
        std::mt19937_64 random(seed);
        const auto must_match = [&](Point2 p) {
            VisibleRegion view, wanted;
            for (const double range : {0.3, 1.1, 4.0, 8.0}) {
                SCOPED_TRACE(testing::Message() << p.x << ',' << p.y << " up to " << range);
                map.query(p, range, view, range);
                map.query(p, range, wanted);
                mustBeSame(view, wanted);
                EXPECT_NEAR(area(view), area(map.query(p, range)), 1e-9);
            }
        };
        for (int i = 0; i < 200; ++i) {
            must_match(test::randomIn(random, {{-115, 35}, {315, 365}}));
            // On a line, beside it, and at its end.
            const auto& [a, b] = lines[random() % lines.size()];
            must_match(a + 0.3 * (b - a));
            must_match(a + 0.6 * (b - a) + Vec2{5e-5, 0});
            must_match(b);
        }
        must_match({100, 202});
    }
}

TEST(MeshTiles, ArcsDependOnNoTriangle) {
    // A whole circle, and one that a wall cuts, far from all else.
    std::vector<Segment2> lines = largePlan(1);
    lines.push_back({{300, 1000}, {304, 1000}});
    const VisibilityMap map(lines);
    VisibleRegion view;
    map.query({100, 600}, 2, view, 2);
    ASSERT_EQ(view.edges.size(), 4U);
    EXPECT_EQ(view.edges[0].from, (Point2{102, 600}));
    EXPECT_NEAR(area(view), 4 * M_PI, 1e-12);
    map.query({302, 999}, 2, view, 2);
    ASSERT_FALSE(view.edges.empty());
    EXPECT_EQ(view.edges[0].line, lines.size() - 1);
    // Two thirds of a turn: two quarters and the rest.
    EXPECT_EQ(view.edges.size(), 4U);
    EXPECT_NEAR(area(view), 4 * M_PI * 2 / 3 + std::sqrt(3), 1e-9);
}

TEST(MeshTiles, FreeQuarterTurnsAreThoseOfASmallPlan) {
    // Walls on whole metres, seen from whole and half ones: many free directions span whole
    // quarter turns, but for rounding.
    std::mt19937_64 random(7);
    const auto whole = [&](int most) { return static_cast<double>(random() % most); };
    for (int plan = 0; plan < 20; ++plan) {
        std::vector<Segment2> few;
        for (int i = 0; i < 12; ++i) {
            const Point2 a{whole(12), whole(12)};
            const double length = 1 + whole(3);
            few.push_back({a, a + (i % 2 == 0 ? Vec2{length, 0} : Vec2{0, length})});
        }
        std::vector<Segment2> many = few;
        for (const Segment2& far : largePlan(1))
            many.push_back({far.a + Vec2{2000, 0}, far.b + Vec2{2000, 0}});
        const VisibilityMap small(few), large(many);
        for (int i = 0; i < 100; ++i) {
            const Point2 p{whole(24) / 2, whole(24) / 2};
            const double range = 1 + whole(6);
            SCOPED_TRACE(testing::Message() << p.x << ',' << p.y << " up to " << range);
            const VisibleRegion wanted = small.query(p, range), view = large.query(p, range);
            EXPECT_NEAR(area(view), area(wanted), 1e-9);
            EXPECT_NEAR(signedArea(outlineOf(view)), signedArea(outlineOf(wanted)), 1e-9);
            for (const VisibilityEdge& edge : view.edges)
                EXPECT_GT(cross(edge.from - view.viewpoint, edge.to - view.viewpoint), 0);
            for (int k = 0; k < 8; ++k) {
                const Angle first = Angle::degrees(45 * k), span = Angle::degrees(30 + whole(300));
                EXPECT_NEAR(area(sectorOf(view, first, span)), area(sectorOf(wanted, first, span)),
                            1e-9);
            }
        }
    }
}

TEST(MeshTiles, SmallPlansAndFarViewsHaveOneMesh) {
    const std::vector<Segment2> few = {{{0, 0}, {900, 0}}, {{0, 900}, {900, 900}}};
    const MeshTiles small(few);
    EXPECT_EQ(&small.meshFor({0, 0}, 1), &small.meshFor({900, 900}, kInfinity));
    const MeshTiles large(largePlan(1));
    EXPECT_EQ(&large.meshFor({0, 100}, 60), &large.meshFor({200, 300}, kInfinity));
    EXPECT_EQ(&large.meshFor({0, 100}, 1e70), &large.meshFor({200, 300}, kInfinity));
    EXPECT_NE(&large.meshFor({0, 100}, 8), &large.meshFor({200, 300}, 8));
    EXPECT_EQ(&large.meshFor({0, 100}, 8), &large.meshFor({0, 100}, 7));
    EXPECT_LT(large.meshFor({0, 100}, 8).portals.size(),
              large.meshFor({}, kInfinity).portals.size() / 2);
    EXPECT_TRUE(large.isDivided());
    EXPECT_FALSE(small.isDivided());
    // The nearest tile.
    EXPECT_EQ(&large.meshFor({-100, 50}, 8), &large.meshFor({-1e9, -1e75}, 8));
    const MeshTiles empty({});
    EXPECT_NEAR(area(viewIn(empty.meshFor({0, 0}, 1), {0.2, 0.1}, 0.5)), 0.25 * M_PI, 1e-9);
}

TEST(MeshTiles, FlatAndHatchedPlansAreServed) {
    // All on one line; then long lines side by side, each of which meets most tiles.
    std::vector<Segment2> flat, hatched;
    for (int i = 0; i < 10'000; ++i) {
        flat.push_back({{0.1 * i, 7}, {0.1 * i + 0.05, 7}});
        hatched.push_back({{0, 0.1 * i}, {10'000, 0.1 * i}});
    }
    const MeshTiles row(flat), hatch(hatched);
    EXPECT_LT(row.meshFor({500, 7}, 4).portals.size(), 30'000U);
    EXPECT_NEAR(area(viewIn(row.meshFor({500, 8}, 0.5), {500, 8}, 0.5)), 0.25 * M_PI, 1e-3);
    EXPECT_EQ(&hatch.meshFor({500, 500}, 4), &hatch.meshFor({}, kInfinity));
}

TEST(MeshTiles, FarWallsDoNotSlowDownADensePlan) {
    // All short walls lie in one cell of any even grid over the plan: names of lines are looked up
    // by their ends, or 20 000 walls would take half a minute.
    std::vector<Segment2> lines = {{{-2e4, 0}, {-2e4, 1}}, {{2e4, 0}, {2e4, 1}}};
    for (int i = 0; i < 20'000; ++i) {
        const Point2 a{0.01 * (i % 200), 0.02 * (i / 200)};
        lines.push_back({a, a + Vec2{0.004, 0.007}});
    }
    const VisibilityMap map(lines);
    for (const double range : {1.0, kInfinity}) {
        const VisibleRegion view = map.query({1.0085, 1.009}, range);
        EXPECT_FALSE(view.edges.empty());
        for (const VisibilityEdge& edge : view.edges) {
            if (edge.line == VisibilityEdge::kArc) continue;
            ASSERT_LT(edge.line, lines.size());
            EXPECT_LT(distance(edge.from, lines[edge.line]), 1e-6);
        }
    }
}

TEST(MeshTiles, ThreadsShareMeshes) {
    const MeshTiles tiles(largePlan(2));
    std::vector<const ExpansionMesh*> found(2000);
    tbb::parallel_for(0, 2000, [&](int i) {
        found[static_cast<std::size_t>(i)] =
            &tiles.meshFor({-100 + 0.2 * i, 50 + 0.15 * ((7 * i) % 2000)}, 4);
    });
    for (int i = 0; i < 2000; ++i)
        EXPECT_EQ(found[static_cast<std::size_t>(i)],
                  &tiles.meshFor({-100 + 0.2 * i, 50 + 0.15 * ((7 * i) % 2000)}, 4));
}

}  // namespace mesh_tiles_test
}  // namespace ispace
