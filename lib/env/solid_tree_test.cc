// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/solid_tree.h"

#include <gtest/gtest.h>

namespace ispace {
namespace {

Polygon square(double x, double y) { return {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}; }

TEST(SolidTree, InsideIsDeeperThanContact) {
    const SolidTree tree({square(0, 0), square(1, 0), square(5, 5)});
    EXPECT_TRUE(tree.isInside({0.5, 0.5}, 1e-4));
    EXPECT_TRUE(tree.isInside({5.2, 5.7}, 1e-4));
    EXPECT_FALSE(tree.isInside({0.5, 1e-5}, 1e-4));
    EXPECT_FALSE(tree.isInside({1, 0.5}, 1e-4)) << "between two that touch";
    EXPECT_FALSE(tree.isInside({3, 3}, 1e-4));
    EXPECT_FALSE(SolidTree().isInside({0, 0}, 1e-4));
}

TEST(SolidTree, TouchesFromBothSides) {
    const SolidTree tree({square(0, 0), square(1, 0), square(5, 5)});
    EXPECT_EQ(tree.touching({1, 0.5}, 1e-4).size(), 2U);
    EXPECT_EQ(tree.touching({-5e-5, 0.5}, 1e-4).size(), 1U);
    EXPECT_EQ(tree.touching({5e-5, 0.5}, 1e-4).size(), 1U);
    EXPECT_TRUE(tree.touching({0.5, 0.5}, 1e-4).empty());
    EXPECT_TRUE(tree.touching({-2e-4, 0.5}, 1e-4).empty());
}

}  // namespace
}  // namespace ispace
