// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay/overlay_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace ispace::lattice {
namespace overlay_snap_test {

/// Closed curves of so many layers between random points.
struct Drawing {
    PointTable table;
    SetStore sets;
    std::vector<Edge> edges;

    explicit Drawing(Index layers) : sets(layers) {}
    void add(Index layer, const std::vector<Point>& curve) {
        for (std::size_t i = 0; i < curve.size(); ++i) {
            edges.push_back({table.add(curve[i]), table.add(curve[(i + 1) % curve.size()]), layer,
                             kNone, false});
        }
    }
    void snap() { edges = snapRounded(merged(edges, table.points(), sets), table, sets); }
};

Drawing randomDrawing(std::mt19937_64& random, Index layers, std::size_t corners,
                      std::int32_t size) {
    std::uniform_int_distribution<std::int32_t> at(-size, size);
    Drawing drawing(layers);
    for (Index layer = 0; layer < layers; ++layer) {
        std::vector<Point> curve(corners);
        for (Point& p : curve) p = {at(random), at(random)};
        drawing.add(layer, curve);
    }
    return drawing;
}

bool between(Point a, Point b, Point p) {
    return p != a && p != b && cross(a, b, p) == 0 && dot(a, b, p) > 0 && dot(b, a, p) > 0;
}

bool meetAtEndsOnly(Point a, Point b, Point c, Point d) {
    if (between(a, b, c) || between(a, b, d) || between(c, d, a) || between(c, d, b)) return false;
    const auto sign = [](std::int64_t v) { return v > 0 ? 1 : v < 0 ? -1 : 0; };
    return sign(cross(a, b, c)) * sign(cross(a, b, d)) >= 0 ||
           sign(cross(c, d, a)) * sign(cross(c, d, b)) >= 0;
}

void expectPlane(const Drawing& drawing) {
    const auto& points = drawing.table.points();
    for (std::size_t i = 0; i < drawing.edges.size(); ++i) {
        const Edge& e = drawing.edges[i];
        ASSERT_TRUE(lexLess(points[e.from], points[e.to]));
        for (std::size_t k = i + 1; k < drawing.edges.size(); ++k) {
            const Edge& f = drawing.edges[k];
            ASSERT_FALSE(e.from == f.from && e.to == f.to);
            ASSERT_TRUE(meetAtEndsOnly(points[e.from], points[e.to], points[f.from], points[f.to]));
        }
    }
}

/// Around each point the boundary of each layer comes and goes.
void expectClosed(const Drawing& drawing) {
    std::map<std::pair<Index, Index>, int> degree;
    for (const Edge& e : drawing.edges) {
        for (const Index layer : drawing.sets[e.set]) {
            ++degree[{e.from, layer}];
            ++degree[{e.to, layer}];
        }
    }
    for (const auto& [key, count] : degree) ASSERT_EQ(count % 2, 0);
}

TEST(SnapRounding, twoCrossingSquares) {
    Drawing drawing(2);
    drawing.add(0, {{0, 0}, {100, 0}, {100, 100}, {0, 100}});
    drawing.add(1, {{50, 50}, {150, 50}, {150, 150}, {50, 150}});
    drawing.snap();
    EXPECT_EQ(drawing.edges.size(), 12U);
    expectPlane(drawing);
    expectClosed(drawing);
}

TEST(SnapRounding, equalPartsBecomeOne) {
    Drawing drawing(2);
    drawing.add(0, {{0, 0}, {100, 0}, {100, 100}, {0, 100}});
    // Its left side is a step off the right side of the first one, and shorter.
    drawing.add(1, {{101, 20}, {200, 20}, {200, 80}, {101, 80}});
    drawing.snap();
    std::size_t shared = 0;
    for (const Edge& e : drawing.edges) shared += drawing.sets[e.set].size() == 2 ? 1 : 0;
    EXPECT_EQ(shared, 1U);
    expectPlane(drawing);
    expectClosed(drawing);
}

TEST(SnapRounding, whatCoversItselfTwiceIsGone) {
    Drawing drawing(1);
    drawing.add(0, {{0, 0}, {100, 30}, {0, 0}, {50, 15}});
    drawing.snap();
    EXPECT_TRUE(drawing.edges.empty());
}

// On a lattice of few points everything that can coincide does.
TEST(SnapRounding, edgesMeetAtEndsOnly) {
    std::mt19937_64 random(1);
    for (Index round = 0; round < 600; ++round) {
        const std::int32_t size = 3 << (round % 8);
        Drawing drawing = randomDrawing(random, 1 + round % 5, 3 + round % 7, size);
        drawing.snap();
        expectPlane(drawing);
        expectClosed(drawing);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
}

// Enough of them for many cells.
TEST(SnapRounding, manyEdgesMeetAtEndsOnly) {
    std::mt19937_64 random(6);
    for (int round = 0; round < 24; ++round) {
        Drawing drawing = randomDrawing(random, 6, 12, 8 << (round % 12));
        drawing.snap();
        expectPlane(drawing);
        expectClosed(drawing);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
}

// Crossings right between two pixels, some of which doubles put on the wrong side.
TEST(SnapRounding, halvesAreRoundedUp) {
    for (std::int32_t length = 8; length < 100; ++length) {
        for (std::int32_t k = 3; k < length - 4; ++k) {
            Drawing drawing(2);
            drawing.add(0, {{k - 1, -3}, {k + 2, 3}, {k + 2, 50}, {k - 1, 50}});
            drawing.add(1, {{0, 0}, {length, 0}, {length, 200}});
            drawing.snap();
            expectPlane(drawing);
            const std::vector<Point>& points = drawing.table.points();
            EXPECT_NE(std::find(points.begin(), points.end(), Point{k + 1, 0}), points.end());
            if (HasFatalFailure()) FAIL() << length << ' ' << k;
        }
    }
}

TEST(SnapRounding, greatestCoordinates) {
    constexpr std::int32_t kMax = 1 << kBits;
    std::mt19937_64 random(2);
    for (int round = 0; round < 60; ++round) {
        Drawing drawing = randomDrawing(random, 4, 6, kMax);
        drawing.add(0, {{-kMax, -kMax}, {kMax, -kMax}, {kMax, kMax}, {-kMax, kMax}});
        drawing.add(1, {{-kMax, -kMax}, {kMax, kMax}, {-kMax, kMax}, {kMax, -kMax}});
        drawing.snap();
        expectPlane(drawing);
        expectClosed(drawing);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
}

// Needles through one place: crossings that are hard to round, cells that are hard to divide.
TEST(SnapRounding, bundles) {
    std::mt19937_64 random(3);
    std::uniform_int_distribution<std::int32_t> far(1 << 20, 1 << kBits), near(-3, 3);
    for (int round = 0; round < 20; ++round) {
        Drawing drawing(12);
        for (Index layer = 0; layer < 12; ++layer) {
            const std::int32_t x = far(random), y = far(random);
            drawing.add(
                layer,
                {{x, y + near(random)}, {-x, -y + near(random)}, {near(random), near(random)}});
            drawing.add(
                layer,
                {{-(1 << kBits), near(random)}, {1 << kBits, near(random)}, {x, near(random)}});
        }
        drawing.snap();
        expectPlane(drawing);
        expectClosed(drawing);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
}

TEST(SnapRounding, edgesStayWhereTheyWere) {
    Drawing drawing(1);
    // A long edge past many others' ends.
    std::mt19937_64 random(4);
    std::uniform_int_distribution<std::int32_t> at(-1000, 1000);
    drawing.add(0, {{-1000, -300}, {1000, 307}, {0, 100000}});
    for (int i = 0; i < 300; ++i) {
        const std::int32_t x = at(random), y = -x;
        drawing.add(0, {{x, y}, {x + 30, y}, {x, y + 30}});
    }
    const std::vector<Point> before = drawing.table.points();
    const std::vector<Edge> edges = drawing.edges;
    drawing.snap();
    const auto& points = drawing.table.points();
    for (const Edge& e : drawing.edges) {
        double nearest = 1e9;
        for (const Edge& o : edges) {
            const Point a = before[o.from], b = before[o.to];
            const double length = std::hypot(double(b.x) - a.x, double(b.y) - a.y);
            const auto off = [&](Point p) {
                return std::abs(static_cast<double>(cross(a, b, p))) / length;
            };
            nearest = std::min(nearest, std::max(off(points[e.from]), off(points[e.to])));
        }
        EXPECT_LT(nearest, 2.13);
    }
}

// Every point in one cell; every edge in all cells that it meets.
TEST(Cells, coverPointsAndEdges) {
    std::mt19937_64 random(5);
    Drawing drawing = randomDrawing(random, 20, 20, 1 << kBits);
    drawing.edges = merged(drawing.edges, drawing.table.points(), drawing.sets);
    const auto& points = drawing.table.points();
    std::vector<int> seen(points.size());
    std::size_t cells = 0;
    forEachCell(points, drawing.edges, {}, [&](const Cell& cell) {
        ++cells;
        std::vector<bool> listed(drawing.edges.size());
        for (const Index i : cell.edges) {
            EXPECT_FALSE(listed[i]);
            listed[i] = true;
        }
        for (const Index i : cell.points) {
            ++seen[i];
            EXPECT_TRUE(cell.box.holds(points[i]));
        }
        for (std::size_t i = 0; i < drawing.edges.size(); ++i) {
            const Point a = points[drawing.edges[i].from], b = points[drawing.edges[i].to];
            if (cell.box.holds(a) || cell.box.holds(b)) {
                EXPECT_TRUE(listed[i]);
            }
        }
    });
    EXPECT_GT(cells, 50U);
    for (const int times : seen) EXPECT_EQ(times, 1);
}

/// Far apart and crowded: most points in the last of cells within cells.
std::vector<Point> clusters(std::mt19937_64& random, int count) {
    PointTable table;
    for (int k = 0; k < count; ++k) {
        const std::int32_t size = 1 << (3 * (k % 10) + 2);
        std::uniform_int_distribution<std::int32_t> at(-size, size);
        table.add({at(random) + (1 << 20), at(random)});
    }
    return table.points();
}

TEST(Cells, findAllPointsNearALine) {
    std::mt19937_64 random(6);
    for (const int count : {0, 1, 2, 40, 3000}) {
        const std::vector<Point> points = clusters(random, count);
        const PointGrid grid(points);
        for (std::size_t k = 0; k + 1 < std::min<std::size_t>(points.size(), 400); ++k) {
            Point a = points[k], b = points[points.size() - 1 - k];
            if (k % 3 == 1) b = {a.x, b.y};
            if (k % 3 == 2) b = {b.x, a.y};
            if (b.x < a.x) std::swap(a, b);
            std::vector<int> found(points.size());
            grid.forEachNear(a, b, [&](Point p, Index number) {
                EXPECT_EQ(p, points[number]);
                ++found[number];
            });
            const double length = std::hypot(double(b.x) - a.x, double(b.y) - a.y);
            const Box box{{a.x - kReach, std::min(a.y, b.y) - kReach},
                          {b.x + kReach, std::max(a.y, b.y) + kReach}};
            for (Index i = 0; i < points.size(); ++i) {
                const auto off = static_cast<double>(std::abs(cross(a, b, points[i])));
                EXPECT_LE(found[i], 1);
                if (box.holds(points[i]) && off <= kReach * length) {
                    EXPECT_EQ(found[i], 1);
                }
            }
        }
    }
}

TEST(Cells, lookAtFewPointsOfMany) {
    std::mt19937_64 random(7);
    const std::vector<Point> points = clusters(random, 30'000);
    const PointGrid grid(points);
    std::size_t looked_at = 0;
    for (const Point p : points)
        grid.forEachNear(p, {p.x + 1, p.y}, [&](Point, Index) { ++looked_at; });
    EXPECT_LT(looked_at, 100 * points.size());
}

TEST(PlaneGraph, linesBelowByScanAndBySweep) {
    // Shelves above each other, and points beside them.
    std::vector<Point> points;
    std::vector<plane::Line> lines;
    for (std::int32_t i = 0; i < 40; ++i) {
        points.push_back({-10 - i, 10 * i});
        points.push_back({10 + 3 * i, 10 * i + 3});
        lines.push_back({static_cast<Index>(2 * i), static_cast<Index>(2 * i + 1)});
    }
    std::vector<Index> asked;
    for (std::int32_t i = 0; i < 40; ++i) {
        asked.push_back(static_cast<Index>(points.size()));
        points.push_back({i, 10 * i + 5});
        asked.push_back(static_cast<Index>(points.size()));
        points.push_back({200, i});
    }
    const plane::Graph<Point> graph(points, lines);
    const std::vector<Index> below = graph.linesBelow(asked);
    for (std::size_t k = 0; k < asked.size(); ++k) {
        EXPECT_EQ(below[k], graph.linesBelow({asked[k]})[0]);
        EXPECT_EQ(below[k], k % 2 == 0 ? static_cast<Index>(k / 2) : kNone);
    }
}

TEST(PlaneGraph, linesBelowOfRandomDrawings) {
    std::mt19937_64 random(8);
    for (int round = 0; round < 30; ++round) {
        Drawing drawing = randomDrawing(random, 5, 8, 5 << (round % 6));
        drawing.snap();
        std::vector<plane::Line> lines;
        for (const Edge& e : drawing.edges) lines.push_back({e.from, e.to});
        const plane::Graph<Point> graph(drawing.table.points(), lines);
        std::vector<Index> asked;
        for (Index v = 0; v < graph.vertices(); ++v) {
            const auto about = graph.leaving(v);
            if (std::all_of(about.begin(), about.end(), [](Index half) { return half % 2 == 0; }))
                asked.insert(asked.end(), 17, v);
        }
        const std::vector<Index> below = graph.linesBelow(asked);
        for (std::size_t k = 0; k < asked.size(); k += 17)
            EXPECT_EQ(below[k], graph.linesBelow({asked[k]})[0]);
    }
}

}  // namespace overlay_snap_test
}  // namespace ispace::lattice
