// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/runs/run_coverage.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/test_scenes.h"

namespace ispace::runs {
namespace run_coverage_test {

/// r1 goes from x = -3 to x = 3 along y = 0 in 6 s, past two lasers that see 1 m around (-1, 0) and
/// 1 m around (0, 0); h1 stands unseen.
constexpr const char* kScene =
    "ispace size=8,6\nlaser at=-1,0 range=1 fov=360\nlaser at=0,0 range=1 fov=360\n"
    "robot id=r1 at=-3,0\nhuman id=h1 at=3,2.5\n";

std::string robotsCsv(double end = 6, double step = 0.01) {
    std::string text = "t,id,x,y,heading_deg\n";
    for (int i = 0; i * step <= end + 1e-9; ++i)
        text += std::to_string(i * step) + ",r1," + std::to_string(-3 + i * step) + ",0,0\n";
    return text;
}

RunCoverage sightOf(const std::string& robots, const std::string& people = "",
                    const char* scene = kScene) {
    RunReader reader(robots, people);
    return measureRun(sceneOf(scene), reader, {});
}

TEST(RunCoverage, SharesTimeAndWay) {
    const RunCoverage run = sightOf(robotsCsv());
    ASSERT_EQ(run.members.size(), 1U);
    const RunCoverageMetrics& r1 = run.members[0];
    EXPECT_EQ(r1.id, "r1");
    EXPECT_FALSE(r1.is_person);
    EXPECT_NEAR(r1.duration, 6, 1e-9);
    EXPECT_NEAR(r1.length, 6, 1e-6);
    // Seen from -2 to 1: by both from -1 to 0.
    ASSERT_EQ(r1.time_shares.size(), 3U);
    EXPECT_NEAR(r1.time_shares[0], 3.0 / 6, 0.01);
    EXPECT_NEAR(r1.time_shares[1], 2.0 / 6, 0.01);
    EXPECT_NEAR(r1.time_shares[2], 1.0 / 6, 0.01);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(r1.way_shares[k], r1.time_shares[k], 1e-6);
    EXPECT_EQ(r1.losses, 1U);
    ASSERT_TRUE(r1.longest_gap);
    EXPECT_NEAR(r1.longest_gap->begin, 4, 0.03);
    EXPECT_NEAR(r1.longest_gap->end, 6, 1e-9);
    EXPECT_NEAR(r1.longest_gap->from.x, 1, 0.03);
    ASSERT_EQ(run.losses.size(), 1U);
    EXPECT_NEAR(run.losses[0].place.x, 1, 0.03);
    EXPECT_NEAR(run.losses[0].duration, 2, 0.03);
    EXPECT_EQ(run.ways.size(), 5U) << "none, one, two, one, none";
}

TEST(RunCoverage, OfPeopleAndOfAllTogether) {
    std::string people = "t,id,x,y,heading_deg\n";
    for (int i = 0; i <= 600; ++i) people += std::to_string(i * 0.01) + ",h1,3,2.5,0\n";
    const RunCoverage run = sightOf(robotsCsv(), people);
    ASSERT_EQ(run.members.size(), 2U);
    const RunCoverageMetrics& h1 = run.members[1];
    EXPECT_TRUE(h1.is_person);
    EXPECT_EQ(h1.length, 0);
    EXPECT_TRUE(h1.way_shares.empty());
    EXPECT_EQ(h1.time_shares, std::vector<double>{1});
    EXPECT_EQ(h1.losses, 0U) << "never seen, never lost";
    EXPECT_NEAR(h1.longest_gap->end - h1.longest_gap->begin, 6, 1e-9);
    EXPECT_NEAR(run.all.duration, 12, 1e-6);
    EXPECT_NEAR(run.all.time_shares[0], 0.75, 0.01);
    EXPECT_NEAR(run.all.way_shares[0], 0.5, 0.01);
    EXPECT_EQ(run.all.losses, 1U);
}

TEST(RunCoverage, DoesNotDependOnHowOftenItIsLookedAt) {
    const RunCoverage fine = sightOf(robotsCsv(6, 0.005)), coarse = sightOf(robotsCsv(6, 0.02));
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(fine.members[0].time_shares[k], coarse.members[0].time_shares[k], 0.01);
    EXPECT_NEAR(fine.members[0].duration, coarse.members[0].duration, 1e-9);
}

TEST(RunCoverage, ARunMayBeAMoment) {
    const RunCoverage run = sightOf(robotsCsv(0));
    EXPECT_EQ(run.members[0].duration, 0);
    EXPECT_FALSE(run.members[0].longest_gap);
    EXPECT_THROW(sightOf("t,id,x,y,heading_deg\n"), FormatError);
    EXPECT_THROW(sightOf("t,id,x,y,heading_deg\n0,r9,0,0,0\n"), FormatError);
}

TEST(RunCoverage, JumpsAreNoWay) {
    // RESET puts r1 back after half a second, from 1 m away.
    std::string text = "t,id,x,y,heading_deg\n";
    for (int i = 0; i <= 100; ++i)
        text += std::to_string(i * 0.01) + ",r1," + std::to_string(-3 + (i % 50) * 0.02 * 0.75) +
                ",0,0\n";
    const RunCoverage run = sightOf(text);
    EXPECT_NEAR(run.members[0].duration, 1, 1e-9);
    EXPECT_NEAR(run.members[0].length, 1.44, 1e-4) << "without the way back";
    ASSERT_EQ(run.ways.size(), 3U) << "one from each place where it was put";
    EXPECT_EQ(run.ways[1].points.front(), (Point2{-3, 0}));
}

TEST(RunCoverage, WhoJoinsLaterIsLookedAt) {
    const RunCoverage run = sightOf(
        "t,id,x,y,heading_deg\n0,r1,-3,0,0\n1,r1,-3,0,0\n1,r2,0,0,0\n2,r1,-3,0,0\n2,r2,0,0,0\n");
    ASSERT_EQ(run.members.size(), 2U);
    EXPECT_EQ(run.members[1].duration, 1);
    EXPECT_EQ(run.members[1].time_shares, (std::vector<double>{0, 0, 1}));
}

}  // namespace run_coverage_test
}  // namespace ispace::runs
