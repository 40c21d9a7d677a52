// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility/mesh_tiles.h"

#include <gtest/gtest.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <vector>

#include "geom/visibility/visibility_query.h"
#include "support/test_plans.h"

namespace ispace {
namespace {

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

/// The edges on lines as numbers, in an order that does not depend on the first one.
std::vector<std::array<double, 5>> wallsOf(const VisibleRegion& view) {
    std::vector<std::array<double, 5>> walls;
    for (const VisibilityEdge& edge : view.edges)
        if (edge.line != VisibilityEdge::kArc)
            walls.push_back({static_cast<double>(edge.line), edge.from.x, edge.from.y, edge.to.x,
                             edge.to.y});
    std::sort(walls.begin(), walls.end());
    return walls;
}

TEST(MeshTiles, ViewsAreThoseOfTheWholePlan) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const MeshTiles tiles(largePlan(seed));
        const ExpansionMesh& whole = tiles.meshFor({}, kInfinity);
        std::mt19937_64 random(seed);
        for (int i = 0; i < 300; ++i) {
            const Point2 p = test::randomIn(random, {{-110, 40}, {310, 360}});
            for (const double range : {0.3, 1.1, 2.5, 4.0, 8.0}) {
                const ExpansionMesh& tile = tiles.meshFor(p, range);
                EXPECT_LT(tile.portals.size(), whole.portals.size() / 2);
                if (!tile.box.contains(p)) continue;
                const VisibleRegion view = viewIn(tile, p, range), wanted = viewIn(whole, p, range);
                SCOPED_TRACE(testing::Message() << p.x << ',' << p.y << " up to " << range);
                EXPECT_EQ(wallsOf(view), wallsOf(wanted));
                EXPECT_NEAR(area(view), area(wanted), 1e-9);
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

}  // namespace
}  // namespace ispace
