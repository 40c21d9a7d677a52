// SPDX-License-Identifier: GPL-3.0-or-later
// Strips make no difference: the same edges and labels as all at once, wherever strips end.
#include "geom/overlay/overlay_strips.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

#include "support/test_overlay.h"

namespace ispace::lattice {
namespace overlay_strips_test {

using Place = std::pair<std::int32_t, std::int32_t>;
using Label = std::tuple<std::int32_t, std::int64_t, std::uint64_t>;
/// Ends, labels on the left and on the right, circle, whether it is a wall.
using Line = std::tuple<Place, Place, Label, Label, Index, bool>;

/// Closed curves of layers, and walls.
struct Drawing {
    std::vector<Layer> layers;
    PointTable table;
    std::vector<Edge> edges;

    void addCurve(Index layer, const std::vector<Point>& curve, Index circle = kNone) {
        for (std::size_t i = 0; i < curve.size(); ++i)
            edges.push_back({table.add(curve[i]), table.add(curve[(i + 1) % curve.size()]), layer,
                             circle, false});
    }
    void addWall(Point a, Point b) {
        edges.push_back(
            {table.add(a), table.add(b), static_cast<Index>(layers.size()), kNone, true});
    }
};

Drawing drawingOf(std::size_t layers) {
    Drawing drawing;
    for (std::size_t i = 0; i < layers; ++i) {
        drawing.layers.emplace_back();
        drawing.layers.back().counts = i % 3 != 2;
        drawing.layers.back().number = std::int64_t{1} << i % 60;
        drawing.layers.back().marks = std::uint64_t{1} << i % 7;
    }
    return drawing;
}

void addLines(const Part& part, std::vector<Line>& lines) {
    const auto placeOf = [&part](Index i) { return Place{part.points[i].x, part.points[i].y}; };
    const auto labelOf = [](const LayerLabel& l) { return Label{l.count, l.numbers, l.marks}; };
    for (std::size_t i = 0; i < part.edges.size(); ++i) {
        const Edge& e = part.edges[i];
        lines.emplace_back(placeOf(e.from), placeOf(e.to), labelOf(part.labels[i].left),
                           labelOf(part.labels[i].right), e.circle, e.is_wall);
    }
}

/// All edges with their labels, sorted.
std::vector<Line> linesOf(const Part& part) {
    std::vector<Line> lines;
    addLines(part, lines);
    std::sort(lines.begin(), lines.end());
    return lines;
}

/// The same of all parts, and their number.
std::pair<std::vector<Line>, std::size_t> linesOf(const Drawing& drawing, std::size_t at_least) {
    SetStore sets(drawing.layers.size());
    std::vector<Line> lines;
    std::size_t parts = 0;
    forEachPart(drawing.layers, merged(drawing.edges, drawing.table.points(), sets), drawing.table,
                sets, at_least, [&](Part part) {
                    return [&, part = std::move(part)] {
                        ++parts;
                        addLines(part, lines);
                    };
                });
    std::sort(lines.begin(), lines.end());
    return {lines, parts};
}

/// How many strips there were at most.
std::size_t expectSameInStrips(const Drawing& drawing) {
    constexpr std::size_t kAll = 1'000'000;
    const auto [whole, one] = linesOf(drawing, kAll);
    EXPECT_EQ(one, 1U);
    std::size_t most = 0;
    for (const std::size_t ends : {1U, 2U, 3U, 7U, 20U, 100U}) {
        const auto [lines, strips] = linesOf(drawing, ends);
        EXPECT_EQ(lines, whole) << strips << " strips";
        most = std::max(most, strips);
    }
    return most;
}

std::vector<Point> square(std::int32_t x, std::int32_t y, std::int32_t side) {
    return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

TEST(OverlayStrips, RandomCurvesOnLatticesOfFewPoints) {
    std::mt19937_64 random(21);
    std::size_t divided = 0;
    for (int round = 0; round < 800; ++round) {
        const std::int32_t size = 2 << (round % 9);
        std::uniform_int_distribution<std::int32_t> at(-size, size);
        // Many short edges, so that strips are worth their while.
        std::uniform_int_distribution<std::int32_t> off(-1 - size / 6, 1 + size / 6);
        Drawing drawing = drawingOf(static_cast<std::size_t>(3 + round % 40));
        for (Index layer = 0; layer < drawing.layers.size(); ++layer) {
            const Point middle{at(random), at(random)};
            std::vector<Point> curve(static_cast<std::size_t>(3 + round % 5));
            for (Point& p : curve) p = {middle.x + off(random), middle.y + off(random)};
            drawing.addCurve(layer, curve, layer % 4 == 0 ? layer : kNone);
        }
        for (int i = 0; i < round % 4; ++i)
            drawing.addWall({at(random), at(random)}, {at(random), at(random)});
        divided += expectSameInStrips(drawing) > 1 ? 1 : 0;
        if (HasFailure()) FAIL() << "round " << round;
    }
    EXPECT_GT(divided, 700U);
}

// Equal squares side by side: every strip ends along the sides of some.
TEST(OverlayStrips, SidesAlongTheEndsOfStrips) {
    Drawing drawing = drawingOf(64);
    for (Index i = 0; i < 64; ++i)
        drawing.addCurve(i, square(static_cast<std::int32_t>(10 * (i % 16)),
                                   static_cast<std::int32_t>(10 * (i / 16)), 10));
    EXPECT_GT(expectSameInStrips(drawing), 4U);
}

// One within another, and one that holds small ones: what is between has no end in many strips.
TEST(OverlayStrips, NestedSquaresAndLongEdges) {
    Drawing drawing = drawingOf(60);
    for (Index i = 0; i < 10; ++i) {
        const auto out = static_cast<std::int32_t>(1000 - 7 * i);
        drawing.addCurve(i, {{-out, -out}, {out, -out + 3}, {out, out}, {-out, out - 3}});
    }
    for (Index i = 10; i < 60; ++i) {
        const auto k = static_cast<std::int32_t>(i);
        drawing.addCurve(i, square(-900 + 31 * k, k % 5 * 100 - 300, 15 + k % 3 * 20));
    }
    // In no strip but their own, far from everything else.
    drawing.addWall({-1500, 5}, {1500, 5});
    EXPECT_GT(expectSameInStrips(drawing), 4U);
}

// Strips begin where many edges end: a star of them, and sensors at one place.
TEST(OverlayStrips, CornersAtTheEndsOfStrips) {
    Drawing drawing = drawingOf(90);
    for (Index i = 0; i < 90; ++i) {
        const auto k = static_cast<std::int32_t>(i % 30);
        const auto x = static_cast<std::int32_t>(i / 30 * 500);
        drawing.addCurve(i, {{x, 0}, {x + 200, 13 * k - 200}, {x + 200, 13 * k - 180}});
        drawing.addWall({x, 0}, {x, 7 * k - 100});
    }
    EXPECT_GT(expectSameInStrips(drawing), 4U);
}

// Enough to be led through ends in bundles, too: views along common walls, level, upright and
// slanted, with ends of their own on them or a step beside, short and long.
TEST(OverlayStrips, ManyEdgesAlongCommonWalls) {
    std::mt19937_64 random(23);
    std::uniform_int_distribution<std::int32_t> at(0, 20'000), wall(0, 7), beside(-1, 1),
        size(1, 3000);
    Drawing drawing = drawingOf(2500);
    for (Index i = 0; i < 2500; ++i) {
        const std::int32_t x = at(random), w = 2500 * wall(random),
                           long_or_not = i % 9 == 0 ? 5 : 1;
        const std::int32_t from = x + beside(random), to = x + long_or_not * size(random) + 2;
        const std::int32_t deep = size(random);
        if (i % 3 == 0)
            drawing.addCurve(i, {{from, w + beside(random)}, {to, w}, {to, w + deep}});
        else if (i % 3 == 1)
            drawing.addCurve(i, {{w, from}, {w + beside(random), to}, {w - deep, to}});
        else  // along y = w + x / 5
            drawing.addCurve(i, {{from - from % 5, w + from / 5},
                                 {to - to % 5, w + to / 5},
                                 {to, w + to / 5 + deep}});
    }
    drawing.addWall({-10, 2500}, {30'000, 2500});
    const auto [lines, strips] = linesOf(drawing, 0);
    EXPECT_GT(strips, 2U);

    SetStore sets(drawing.layers.size());
    PointTable table = drawing.table;
    const std::vector<Edge> edges =
        snapRounded(merged(drawing.edges, table.points(), sets), table, sets);
    const Part whole{table.points(), edges, labelsOf(drawing.layers, table.points(), edges, sets),
                     true};
    EXPECT_GT(whole.edges.size(), 50'000U);
    EXPECT_EQ(lines, linesOf(whole));
}

TEST(OverlayStrips, NothingAndVerticalLines) {
    EXPECT_LE(expectSameInStrips(drawingOf(1)), 1U);
    Drawing drawing = drawingOf(1);
    for (std::int32_t y = 0; y < 40; ++y) drawing.addWall({5, 2 * y}, {5, 2 * y + 1});
    EXPECT_EQ(expectSameInStrips(drawing), 1U);
}

}  // namespace overlay_strips_test
}  // namespace ispace::lattice

namespace ispace {
namespace overlay_strips_test {

/// Views as of sensors in rooms: stars, discs whose rims touch each other and the ends of strips
/// wherever these are, walls between.
std::vector<Layer> manyViews(int count) {
    std::mt19937_64 random(22);
    std::vector<Layer> layers = randomStars(random, count, 14, 40);
    for (int i = 0; i < count / 8; ++i) {
        const double x = -40 + 2.0 * (i % 40);
        layers.push_back(curveLayer(disc({x, 3.0 * (i / 40)}, 1 + i % 2), count + i));
    }
    layers.push_back(marking({{-50, -50}, {50, -50}, {50, 50}, {-50, 50}}, 1));
    layers.push_back(marking({{-30, -30}, {20, -30}, {20, 30}, {-30, 30}}, 2));
    return layers;
}

const std::vector<Segment2> kSheets = {{{-60, 1}, {60, 2}}, {{0.5, -60}, {0.5, 60}}};

using AreasByLabel = std::map<std::tuple<int, std::int64_t, std::uint64_t>, double>;

TEST(OverlayStrips, CoarseTellsAndKeepsTheSame) {
    const std::vector<Layer> layers = manyViews(900);
    const Overlay fine(layers, kSheets);
    const auto coarse_label = [](const LayerLabel& label) {
        return LayerLabel{.count = std::min(label.count, 1), .marks = label.marks & 1U};
    };
    AreasByLabel told;
    const Overlay coarse(layers, kSheets,
                         {.label = coarse_label, .add_area = [&](const LayerLabel& l, double area) {
                              told[{l.count, l.numbers, l.marks}] += area;
                          }});
    told.erase({0, 0, 0});
    EXPECT_EQ(told, areasOf(fine));
    EXPECT_LT(coarse.edges().size(), fine.edges().size() / 4);
    for (const bool seen : {true, false}) {
        const auto in = [seen](const LayerLabel& label) {
            return (label.count > 0) == seen && (label.marks & 1U) != 0;
        };
        const std::vector<Region> regions = coarse.regions(in);
        EXPECT_EQ(regions, fine.regions(in));
        EXPECT_EQ(coarse.areasOf(regions), fine.areasOf(regions));
        EXPECT_GT(regions.size(), 1U) << "the sheets part it";
    }
}

TEST(OverlayStrips, CurvesOfSetsAreThoseOfEach) {
    for (const int count : {0, 1, 40, 900}) {
        const std::vector<Layer> layers = manyViews(count);
        const Overlay overlay(layers, kSheets);
        constexpr std::size_t kSets = 7;
        const auto set_of = [](const LayerLabel& label) {
            if (label.count == 0 && label.marks == 0) return kSets;
            return static_cast<std::size_t>(label.numbers + label.count) % (kSets + 1);
        };
        const auto sets = overlay.curvesOfSets(kSets, set_of);
        ASSERT_EQ(sets.size(), kSets);
        std::size_t curves = 0;
        for (std::size_t set = 0; set < kSets; ++set) {
            EXPECT_EQ(sets[set], overlay.curves([&](const LayerLabel& label) {
                return set_of(label) == set;
            }));
            curves += sets[set].size();
        }
        EXPECT_EQ(curves > kSets, count > 1) << count;
    }
}

TEST(OverlayStrips, AreasAloneAreTheSame) {
    using Told = std::vector<std::pair<LayerLabel, double>>;
    for (const int count : {0, 1, 30, 900}) {
        const std::vector<Layer> layers = manyViews(count);
        Told kept, told;
        Overlay(layers).addAreas(
            [&](const LayerLabel& label, double area) { kept.emplace_back(label, area); });
        forEachArea(layers,
                    [&](const LayerLabel& label, double area) { told.emplace_back(label, area); });
        EXPECT_EQ(told, kept) << "to the last bit, in the same order";
    }
    forEachArea({}, [](const LayerLabel&, double) { FAIL(); });
}

TEST(OverlayStrips, AnyNumberOfThreads) {
    const std::vector<Layer> layers = manyViews(900);
    const auto edges = [&layers](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return Overlay(layers, kSheets).edges();
    };
    const auto one = edges(1);
    ASSERT_GT(one.size(), 10'000U);
    for (const std::size_t threads : {2U, 3U, 8U}) {
        const auto more = edges(threads);
        ASSERT_EQ(more.size(), one.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            ASSERT_EQ(more[i].from, one[i].from);
            ASSERT_EQ(more[i].to, one[i].to);
            ASSERT_EQ(more[i].left, one[i].left);
            ASSERT_EQ(more[i].right, one[i].right);
            ASSERT_EQ(more[i].bulge, one[i].bulge);
        }
    }
}

}  // namespace overlay_strips_test
}  // namespace ispace
