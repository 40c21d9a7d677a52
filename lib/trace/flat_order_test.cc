// SPDX-License-Identifier: GPL-3.0-or-later
// Trees of an order that a file says it knows: what rays meet does not depend on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "geom/box_order.h"
#include "trace/flat_tree.h"
#include "trace/flat_world.h"
#include "trace/test_scans.h"

namespace ispace {

using namespace testing;

namespace {

bool areSame(const FlatTree& a, const FlatTree& b) {
    const auto same_node = [](const FlatTree::Node& m, const FlatTree::Node& n) {
        return m.count == n.count && std::equal(m.left, m.left + m.count, n.left) &&
               std::equal(m.right, m.right + m.count, n.right) &&
               std::equal(m.low, m.low + m.count, n.low) &&
               std::equal(m.high, m.high + m.count, n.high) &&
               std::equal(m.child, m.child + m.count, n.child);
    };
    const auto same_leaf = [](const FlatTree::Leaf& m, const FlatTree::Leaf& n) {
        return m.count() == n.count() && std::equal(m.ax, m.ax + m.count(), n.ax) &&
               std::equal(m.by, m.by + m.count(), n.by);
    };
    return std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), same_node) &&
           std::equal(a.leaves.begin(), a.leaves.end(), b.leaves.begin(), b.leaves.end(),
                      same_leaf);
}

TEST(FlatOrder, AKnownOneGivesTheTreeThatIsFound) {
    const Lines lines = office(6, 4);
    const BoxOrder order = orderOf(lines);
    EXPECT_TRUE(areSame(FlatTree(lines), FlatTree(lines, {}, &order)));
}

TEST(FlatOrder, AnyGivesTheSameReadings) {
    const Lines lines = office(6, 4);
    BoxOrder order = orderOf(lines);
    std::mt19937_64 random(5);
    std::shuffle(order.items.begin(), order.items.end(), random);
    ASSERT_TRUE(order.isOf(lines.size()));
    const FlatWorld world(lines), shuffled(lines, {}, &order);
    const Directions beams = scan(Angle::degrees(-135), Angle::degrees(0.25), 1081);
    Directions apart = beams;
    apart.arc.reset();
    for (const Point2 origin : {Point2{1, 1}, Point2{9.3, 6.2}, Point2{20, 20}, Point2{4, 0}}) {
        EXPECT_EQ(cast(world, origin, beams), cast(shuffled, origin, beams));
        EXPECT_EQ(cast(world, origin, apart, 8), cast(shuffled, origin, apart, 8));
        EXPECT_EQ(castApart(world, origin, apart), castApart(shuffled, origin, apart));
    }
}

TEST(FlatOrder, IsLeftAloneWhereLinesArePoints) {
    Lines lines = office(2, 2);
    const BoxOrder order = orderOf(lines);
    lines[7] = {lines[7].a, lines[7].a};  // as lines moved far away may become
    EXPECT_TRUE(areSame(FlatTree(lines), FlatTree(lines, {}, &order)));
}

TEST(FlatOrder, LinesTooShortForALengthCountAsPoints) {
    // The square of 1e-170 is 0. Leaves tell by lengths how many lines they have.
    Lines lines = {
        {{0, 0}, {1e-170, 0}}, {{0, 1}, {2, 1}}, {{3, 0}, {3, 1e-170}}, {{0, 2}, {2, 2}}};
    const FlatTree tree(lines);
    ASSERT_EQ(tree.leaves.size(), 1U);
    EXPECT_EQ(tree.leaves.front().count(), 2);
    EXPECT_EQ(FlatTree(Lines{lines[0], lines[2]}).leaves.size(), 0U);
    for (std::size_t count = 1; count <= 8; ++count) {
        const FlatTree few(Lines(count, lines[1]));
        ASSERT_EQ(few.leaves.size(), 1U);
        EXPECT_EQ(few.leaves.front().count(), static_cast<int>(count));
    }
}

}  // namespace
}  // namespace ispace
