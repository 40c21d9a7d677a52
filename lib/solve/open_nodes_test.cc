// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/open_nodes.h"

#include <gtest/gtest.h>

namespace ispace {
namespace {

using List = std::vector<std::uint32_t>;

std::shared_ptr<const ReducedProblem> problemOf(std::size_t cells) {
    ReducedProblem problem;
    problem.weights.assign(cells, 1);
    problem.needs.assign(cells, 1);
    return std::make_shared<const ReducedProblem>(std::move(problem));
}

BranchNode nodeOf(std::uint64_t bound, std::shared_ptr<const ReducedProblem> problem) {
    BranchNode node;
    node.problem = std::move(problem);
    node.multipliers = std::make_shared<const List>();
    node.groups.push_back({0, 1, std::make_shared<const List>(List{1, 2})});
    node.bound = bound;
    return node;
}

std::vector<std::uint64_t> boundsOf(const std::vector<BranchNode>& nodes) {
    std::vector<std::uint64_t> bounds;
    for (const BranchNode& node : nodes) bounds.push_back(node.bound);
    return bounds;
}

TEST(OpenNodes, HighestBoundsComeFirst) {
    OpenNodes open(1'000'000);
    for (const std::uint64_t bound : {5U, 9U, 7U, 9U, 1U}) open.add(nodeOf(bound, problemOf(1)));
    EXPECT_EQ(open.bound(), 9U);
    EXPECT_EQ(boundsOf(open.take(3)), (std::vector<std::uint64_t>{9, 9, 7}));
    EXPECT_EQ(open.bound(), 5U);
    EXPECT_EQ(open.dropUpTo(0), 0U);
    EXPECT_EQ(open.dropUpTo(3), 1U);
    EXPECT_EQ(boundsOf(open.take(3)), (std::vector<std::uint64_t>{5}));
    EXPECT_TRUE(open.empty());
    EXPECT_EQ(open.bytes(), 0U);
}

TEST(OpenNodes, NewestComeFirstWhereMemoryIsFull) {
    const auto problem = problemOf(1000);
    OpenNodes open(3 * problem->bytes());
    for (const std::uint64_t bound : {5U, 9U, 7U}) open.add(nodeOf(bound, problemOf(1000)));
    EXPECT_EQ(boundsOf(open.take(8)), (std::vector<std::uint64_t>{7}));  // large: one at a time
    EXPECT_EQ(boundsOf(open.take(8)), (std::vector<std::uint64_t>{9}));  // no longer full
    open.add(nodeOf(4, problemOf(1000)));
    open.add(nodeOf(3, problemOf(1000)));
    EXPECT_EQ(boundsOf(open.take(8)), (std::vector<std::uint64_t>{3}));
    EXPECT_EQ(open.bound(), 5U);
}

TEST(OpenNodes, WhatIsSharedCountsOnce) {
    const auto problem = problemOf(1000);
    OpenNodes open(std::size_t{1} << 30U);
    const BranchNode node = nodeOf(3, problem);
    open.add(node);
    const std::size_t one = open.bytes();
    EXPECT_GT(one, problem->bytes());
    open.add(node);
    EXPECT_LT(open.bytes() - one, problem->bytes());
    open.take(1);
    EXPECT_EQ(open.bytes(), one);
    open.take(1);
    EXPECT_EQ(open.bytes(), 0U);
}

}  // namespace
}  // namespace ispace
