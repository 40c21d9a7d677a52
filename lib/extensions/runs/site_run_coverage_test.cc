// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/runs/site_run_coverage.h"

#include <gtest/gtest.h>

namespace ispace::runs {
namespace site_run_coverage_test {

RunCoverageMetrics metrics(double duration, double length, std::vector<double> shares,
                           std::size_t losses, double gap) {
    RunCoverageMetrics metrics;
    metrics.duration = duration;
    metrics.length = length;
    metrics.time_shares = metrics.way_shares = std::move(shares);
    metrics.losses = losses;
    metrics.longest_gap = UnseenInterval{1, 1 + gap, {}, {}};
    return metrics;
}

RunCoverage storey(double begin, double end, const RunCoverageMetrics& one, const std::string& id) {
    RunCoverage run;
    run.begin = begin;
    run.end = end;
    run.all = one;
    run.members = {one};
    run.members[0].id = id;
    return run;
}

TEST(SiteRunCoverage, AddsUpMoversOverStoreys) {
    std::vector<RunCoverage> storeys = {
        storey(0, 20, metrics(20, 10, {0.5, 0.5}, 1, 4), "ground/r"),
        RunCoverage(),  // no mover came
        storey(30, 60, metrics(30, 0, {0, 0, 1}, 2, 9), "ground/r"),
        storey(5, 50, metrics(10, 10, {1}, 0, 2), "ground/s")};
    storeys[0].losses = {{.member = 0, .begin = 1, .duration = 4, .place = {1, 2}}};
    storeys[2].losses = {{.member = 0, .begin = 31, .duration = 9, .place = {3, 4}}};
    const std::vector<std::string> ids = {"ground", "first", "second", "third"};
    const RunCoverage sum = sumOverStoreys(storeys, ids);
    EXPECT_EQ(sum.begin, 0);
    EXPECT_EQ(sum.end, 60);
    ASSERT_EQ(sum.members.size(), 2U);
    const RunCoverageMetrics& r = sum.members[0];
    EXPECT_EQ(r.id, "ground/r");
    EXPECT_DOUBLE_EQ(r.duration, 50);
    EXPECT_DOUBLE_EQ(r.length, 10);
    ASSERT_EQ(r.time_shares.size(), 3U);
    EXPECT_DOUBLE_EQ(r.time_shares[0], 0.2);
    EXPECT_DOUBLE_EQ(r.time_shares[1], 0.2);
    EXPECT_DOUBLE_EQ(r.time_shares[2], 0.6);
    EXPECT_DOUBLE_EQ(r.way_shares[0], 0.5);
    EXPECT_EQ(r.losses, 3U);
    EXPECT_DOUBLE_EQ(r.longest_gap->end - r.longest_gap->begin, 9);
    EXPECT_DOUBLE_EQ(sum.all.duration, 60);
    EXPECT_DOUBLE_EQ(sum.all.time_shares[0], 20.0 / 60);
    EXPECT_EQ(sum.all.losses, 3U);
    ASSERT_EQ(sum.losses.size(), 2U);
    EXPECT_EQ(sum.losses[0].room, "second") << "the longest first";
    EXPECT_EQ(sum.losses[1].member, 0U);
    EXPECT_EQ(sum.losses[1].room, "ground");
}

TEST(SiteRunCoverage, OfNobodyIsEmpty) {
    EXPECT_TRUE(sumOverStoreys(std::vector<RunCoverage>(2), std::vector<std::string>{"a", "b"})
                    .members.empty());
}

}  // namespace site_run_coverage_test
}  // namespace ispace::runs
