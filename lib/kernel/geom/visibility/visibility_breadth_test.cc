// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility/visibility_breadth.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>

#include "support/test_plans.h"

namespace ispace {
namespace visibility_breadth_test {

using test::makePlan;
using test::randomInside;

/// A query from within a triangle.
template <typename Search>
void expandFrom(Search& search, std::uint32_t triangle) {
    for (std::uint32_t i = 0; i < 3; ++i) search.throughEdge(3 * triangle + i);
    search.run();
}

template <bool kBounded>
std::vector<VisibilityEdge> depthFirst(const ExpansionMesh& mesh, Point2 p, double range,
                                       double farthest) {
    std::vector<VisibilityEdge> edges;
    Expansion<kBounded, false> search(mesh.portals.data(), p, range, farthest, {}, edges);
    expandFrom(search, mesh.locate(p));
    search.out().finish();
    return edges;
}

template <bool kBounded>
std::vector<VisibilityEdge> breadthFirst(const ExpansionMesh& mesh, Point2 p, double range,
                                         double farthest) {
    std::vector<VisibilityEdge> edges;
    Expansion<kBounded, false> search(mesh.portals.data(), p, range, farthest, {}, edges);
    BreadthFirst<kBounded> breadth(mesh.portals.data(), p, farthest, search);
    expandFrom(breadth, mesh.locate(p));
    search.out().finish();
    return edges;
}

void mustHaveSameBits(Point2 a, Point2 b) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.x), std::bit_cast<std::uint64_t>(b.x));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.y), std::bit_cast<std::uint64_t>(b.y));
}

void mustBeSame(const std::vector<VisibilityEdge>& edges,
                const std::vector<VisibilityEdge>& wanted) {
    ASSERT_EQ(edges.size(), wanted.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        mustHaveSameBits(edges[i].from, wanted[i].from);
        mustHaveSameBits(edges[i].to, wanted[i].to);
        EXPECT_EQ(edges[i].line, wanted[i].line);
    }
}

TEST(VisibilityBreadth, GivesTheBitsOfDepth) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Region plan = makePlan(seed, {5, 4, 60, 9, 120});
        const ExpansionMesh mesh(sightPieces(test::linesOf(plan)));
        const double farthest = length(mesh.box.high - mesh.box.low);
        std::mt19937_64 random(seed);
        for (int i = 0; i < 200; ++i) {
            const Point2 p = randomInside(random, plan);
            SCOPED_TRACE(testing::Message() << "seed " << seed << " from " << p.x << ',' << p.y);
            mustBeSame(breadthFirst<false>(mesh, p, farthest, farthest),
                       depthFirst<false>(mesh, p, farthest, farthest));
            for (const double range : {0.01, 0.3, 1.0, 2.5, 4.0, 8.0, 15.0, 30.0})
                mustBeSame(breadthFirst<true>(mesh, p, range, farthest),
                           depthFirst<true>(mesh, p, range, farthest));
        }
    }
}

TEST(VisibilityBreadth, PrunesInTheOpen) {
    // Hardly anything is within range: views end at edges of triangles.
    const std::vector<Segment2> lines = {{{-40, -3}, {40, -3}}, {{50, 60}, {60, 50}}};
    const ExpansionMesh mesh(sightPieces(lines));
    const double farthest = length(mesh.box.high - mesh.box.low);
    for (const double range : {1.0, 3.0, 3.5, 20.0, 500.0}) {
        const auto edges = breadthFirst<true>(mesh, {1, 2}, range, farthest);
        mustBeSame(edges, depthFirst<true>(mesh, {1, 2}, range, farthest));
        EXPECT_FALSE(edges.empty());
    }
}

}  // namespace visibility_breadth_test
}  // namespace ispace
