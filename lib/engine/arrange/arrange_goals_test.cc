// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the goals of an arrangement: zones, weights, redundancy, targets, budgets; and refining.
#include <gtest/gtest.h>

#include "arrange/coverage_model.h"
#include "base/number.h"
#include "support/test_arrange.h"
#include "support/test_problems.h"

namespace ispace {
namespace arrange_goals_test {

TEST(ArrangeGoals, AZoneIsAllThatCounts) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.weights.targets = {readZone("left", scene.environment)};
    const Arrangement arrangement = arranged(scene, groups, options);
    ASSERT_TRUE(arrangement.value);
    EXPECT_LT(arrangement.sensors[0].pose.position.x, 0.5) << "it stands by what counts";
    const CoverageReport report = reportOf(scene, groups, arrangement);
    ASSERT_EQ(report.zones.size(), 1U);
    EXPECT_NEAR(*arrangement.value, report.zones[0].coverage.grid.value_or(0), 1e-12);
    EXPECT_EQ(*arrangement.value, arrangement.candidate_value);
    EXPECT_GE(arrangement.bound, *arrangement.value);
}

TEST(ArrangeGoals, WeightsDraw) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=2.5"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    const NamedZone corner = readZone("rect:2,-3,4,-1", scene.environment);
    options.weights.weights = {{corner, 20}};
    const Arrangement drawn = arranged(scene, groups, options);
    const Point3& place = drawn.sensors[0].pose.position;
    EXPECT_GT(place.x, 0.5);
    EXPECT_LT(place.y, 1);
    options.weights.weights = {{corner, 0}};
    options.weights.targets = {readZone("rect:0,-3,4,3", scene.environment)};
    EXPECT_LE(arranged(scene, groups, options).value.value_or(2), 1);
}

TEST(ArrangeGoals, RedundancyCountsWhatSeveralSee) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=5:4"});
    ArrangeOptions options = coarse();
    options.redundancy = 2;
    const Arrangement twice = arranged(scene, groups, options);
    const auto share_of_two = [&](const Arrangement& arrangement) {
        const CoverageReport report = reportOf(scene, groups, arrangement);
        double share = 0;
        for (std::size_t k = 2; k < report.redundancy.size(); ++k) share += report.redundancy[k];
        return share;
    };
    EXPECT_NEAR(*twice.value, share_of_two(twice), 1e-12);
    EXPECT_GE(twice.bound, *twice.value);
    EXPECT_GT(share_of_two(twice), share_of_two(arranged(scene, groups, coarse())));
}

TEST(ArrangeGoals, ATargetIsReachedWithTheFewest) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.target = 0.9;
    const auto groups = groupsOf(scene, {"laser,range=4"}, true);
    EXPECT_EQ(groups[0].most, kMaxOpen);
    const Arrangement enough = arranged(scene, groups, options);
    EXPECT_TRUE(enough.is_reached);
    EXPECT_GE(enough.coverage, 0.9);
    const auto count = static_cast<int>(enough.sensors.size());
    ASSERT_TRUE(enough.least);
    EXPECT_LE(*enough.least, count);
    EXPECT_GE(*enough.least, 2);
    // One less does not do, by any means of this search.
    options.target.reset();
    const std::string fewer = "laser,range=4:" + std::to_string(count - 1);
    if (*enough.least == count) {
        EXPECT_LT(arranged(scene, groupsOf(scene, {fewer.c_str()}), options).bound, 0.9);
    }
    // With a limit below, the best there is comes all the same.
    options.target = 0.9;
    const Arrangement short_of =
        arranged(scene, groupsOf(scene, {"laser,range=4:1"}, true), options);
    EXPECT_FALSE(short_of.is_reached);
    EXPECT_EQ(short_of.sensors.size(), 1U);
    EXPECT_FALSE(short_of.least);
}

TEST(ArrangeGoals, AmongTheFewestTheBest) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse();
    options.target = 0.6;
    const Arrangement enough = arranged(scene, groupsOf(scene, {"laser,range=3"}, true), options);
    options.target.reset();
    const std::string as_many = "laser,range=3:" + std::to_string(enough.sensors.size());
    const Arrangement most = arranged(scene, groupsOf(scene, {as_many.c_str()}), options);
    EXPECT_EQ(enough.candidate_value, most.candidate_value);
    EXPECT_LE(enough.bound, most.bound);
}

TEST(ArrangeGoals, WhatAllCandidatesTogetherDoNotReachIsTold) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse();
    options.target = 1;
    options.mount.keep_in = {readZone("rect:-3,-2,0,2", scene.environment)};
    const Arrangement all = arranged(scene, groupsOf(scene, {"laser,range=1"}, true), options);
    EXPECT_FALSE(all.is_reached);
    EXPECT_TRUE(all.is_exhausted);
    EXPECT_EQ(all.bound, all.coverage);
    const Arrangement one = arranged(scene, groupsOf(scene, {"laser,range=1:1"}, true), options);
    EXPECT_FALSE(one.is_reached);
    EXPECT_FALSE(one.is_exhausted);
}

TEST(ArrangeGoals, WhatTooFewSensorsCannotDoHasNoBoundAboveNothing) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse();
    options.redundancy = 3;
    const Arrangement two = arranged(scene, groupsOf(scene, {"laser:2"}), options);
    EXPECT_EQ(two.value, 0);
    EXPECT_EQ(two.bound, 0);
    options.redundancy = 1;
    const Arrangement deaf = arranged(scene, groupsOf(scene, {"ultrasound:3"}), options);
    EXPECT_EQ(deaf.coverage, 0);
    EXPECT_EQ(deaf.bound, 0);
}

TEST(ArrangeGoals, ABudgetBuysTheGreatestValue) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.budget = 5;
    const auto groups =
        groupsOf(scene, {"laser,range=2,cost=1.5", "laser,range=5,fov=270,cost=4"}, true);
    const Arrangement bought = arranged(scene, groups, options);
    EXPECT_LE(bought.cost, 5);
    EXPECT_GT(bought.cost, 0);
    EXPECT_GE(bought.bound, bought.coverage);
    std::vector<std::string> ids;
    for (const Placement& sensor : bought.sensors) ids.push_back(sensor.sensor);
    for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(ids[i], "laser" + std::to_string(i + 1));
}

TEST(ArrangeGoals, ConnectedViewsShareCells) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=2,fov=90:3"});
    ArrangeOptions options = coarse();
    options.is_connected = true;
    const Arrangement arrangement = arranged(scene, groups, options);
    EXPECT_EQ(reportOf(scene, groups, arrangement).pieces, 1U);
    EXPECT_LE(arrangement.coverage, arranged(scene, groups, coarse()).coverage);
}

TEST(ArrangeGoals, RefiningDoesNotLose) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=4:2"});
    const ArrangeOptions plain = coarse();
    ArrangeOptions options = plain;
    options.refine = true;
    const Arrangement before = arranged(scene, groups, plain);
    const Arrangement after = arranged(scene, groups, options);
    EXPECT_GT(after.refined_after, after.refined_before);
    // Both bounds are kept.
    const Record result = layoutDocument(partsOf(scene), nullptr, groups, after).records.back();
    EXPECT_EQ(result.number("candidates_bound"), roundSignificant(after.candidate_bound));
    EXPECT_EQ(result.number("bound"), roundSignificant(after.bound));
    EXPECT_GE(after.bound, after.value.value_or(after.coverage));
    EXPECT_GE(after.coverage, before.coverage);
    EXPECT_EQ(after.candidate_bound, before.bound);
    EXPECT_GE(after.bound, after.coverage);
    const CoverageReport report = reportOf(scene, groups, after);
    EXPECT_EQ(report.coverage.grid, after.coverage);
}

TEST(ArrangeGoals, RefinedViewsStillHangTogether) {
    const Scene scene = roomScene("#env 1\nispace size=20,8\n");
    const auto groups = groupsOf(scene, {"laser,range=2,fov=360:3"});
    ArrangeOptions options = coarse();
    options.density = {0.3, 0.3, 1};
    options.is_connected = true;
    options.refine = true;
    const Arrangement together = arranged(scene, groups, options);
    EXPECT_EQ(reportOf(scene, groups, together).pieces, 1U);
    EXPECT_GT(together.refined_after, together.refined_before);
    options.is_connected = false;
    EXPECT_GT(reportOf(scene, groups, arranged(scene, groups, options)).pieces, 1U)
        << "else they go apart";
}

TEST(ArrangeGoals, RefinedReceiversKeepApart) {
    const Scene scene = roomScene("#env 1\nispace size=6,5\n");
    const auto groups = groupsOf(scene, {"ultrasound,range=3,fov=90:4"});
    ArrangeOptions options = coarse();
    options.mount.on = MountOn::Ceiling;
    options.refine = true;
    const Arrangement arrangement = arranged(scene, groups, options);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_GE(
                length(arrangement.sensors[i].pose.position - arrangement.sensors[k].pose.position),
                0.05 - 1e-9);
}

TEST(ArrangeGoals, WhatCannotHangTogetherIsLeftOut) {
    const Scene scene = roomScene("#env 1\nispace size=16,6\n");
    const auto groups = groupsOf(scene, {"laser,range=0.2,fov=360:2"});
    ArrangeOptions options = coarse();
    options.is_connected = true;
    const Arrangement arrangement = arranged(scene, groups, options);
    EXPECT_EQ(arrangement.sensors.size() + arrangement.unplaced, 2U);
    EXPECT_GE(arrangement.unplaced, 1U);
}

TEST(ArrangeGoals, NoTwoSensorsStandOnOneCandidate) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser:3"});
    ArrangeOptions options;
    options.strategy = Strategy::List;
    options.list = {{{0, 0}, {Angle::degrees(0), Angle::degrees(90)}}};
    options.redundancy = 2;
    const Arrangement arrangement = arranged(scene, groups, options);
    EXPECT_EQ(arrangement.sensors.size(), 2U);
    EXPECT_EQ(arrangement.unplaced, 1U);
    EXPECT_EQ(arrangement.value, arrangement.candidate_value);
    EXPECT_GE(arrangement.bound, arrangement.value.value_or(2));
}

TEST(ArrangeGoals, ACurveRises) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3:4"});
    ArrangeOptions options = coarse();
    options.wants_curve = true;
    options.wants_trace = true;
    const Arrangement arrangement = arranged(scene, groups, options);
    ASSERT_EQ(arrangement.curve.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(arrangement.curve[i].sensors, static_cast<int>(i) + 1);
        EXPECT_GE(arrangement.curve[i].bound, arrangement.curve[i].value);
        if (i > 0) {
            EXPECT_GE(arrangement.curve[i].value, arrangement.curve[i - 1].value);
        }
    }
    EXPECT_EQ(arrangement.curve.back().value, arrangement.candidate_value);
    ASSERT_EQ(arrangement.tried.size(), arrangement.candidates);
    double best = 0;
    std::size_t chosen = 0;
    for (const TriedPose& tried : arrangement.tried) {
        best = std::max(best, tried.value);
        chosen += tried.is_chosen ? 1 : 0;
    }
    EXPECT_EQ(chosen, 4U);
    EXPECT_NEAR(best, arrangement.curve.front().value, 1e-12);
}

TEST(ArrangeGoals, ACurveOfSeveralKindsDoesNotFall) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=1,fov=90:2", "laser,range=4,fov=270:2"});
    ArrangeOptions options = coarse(Optimizer::Greedy);
    options.wants_curve = true;
    const Arrangement arrangement = arranged(scene, groups, options);
    ASSERT_EQ(arrangement.curve.size(), 4U);
    for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_GE(arrangement.curve[i].value, arrangement.curve[i - 1].value);
        EXPECT_GE(arrangement.curve[i].bound, arrangement.curve[i - 1].bound);
    }
}

TEST(ArrangeGoals, ACurveThatIsCutHasAllItsPoints) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3:4"});
    ArrangeOptions options = coarse();
    options.wants_curve = true;
    const Arrangement whole = arranged(scene, groups, options);
    for (const int phases : {2, 3, 4, 5, 6}) {
        StopWhen progress(afterPhases(phases));
        const Arrangement cut = arrange(scene, groups, options, progress);
        ASSERT_EQ(cut.curve.size(), 4U) << phases;
        EXPECT_FALSE(cut.is_complete) << phases;
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_GT(cut.curve[i].value, i == 0 ? 0 : cut.curve[i - 1].value) << phases;
            EXPECT_LE(cut.curve[i].value, whole.curve[i].bound) << phases;
            EXPECT_GE(cut.curve[i].bound, whole.curve[i].value) << phases;
        }
    }
}

TEST(ArrangeGoals, ACurveKnowsNothingOfCandidatesThatWereNotMade) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3:3"});
    ArrangeOptions options = coarse();
    options.density = {0.2, 0.2, 8};
    options.wants_curve = true;
    StopWhen at_once(always);
    const Arrangement cut = arrange(scene, groups, options, at_once);
    ASSERT_EQ(cut.bound, 1);
    ASSERT_EQ(cut.curve.size(), 3U);
    for (const CurvePoint& point : cut.curve) EXPECT_EQ(point.bound, 1);
}

TEST(ArrangeGoals, ACurveToATargetEndsWithItsBound) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse();
    options.target = 0.7;
    options.wants_curve = true;
    const Arrangement all = arranged(scene, groupsOf(scene, {"laser,range=3"}, true), options);
    ASSERT_EQ(all.curve.size(), all.sensors.size());
    EXPECT_EQ(all.curve.back().value, all.candidate_value);
    EXPECT_EQ(all.curve.back().bound, all.candidate_bound);
}

TEST(ArrangeGoals, WhatIsNotMovedKeepsItsBound) {
    const Scene scene = roomScene("#env 1\nispace size=4,4\n");
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.refine = true;
    const Arrangement all = arranged(scene, groupsOf(scene, {"laser,range=9,fov=360"}), options);
    EXPECT_EQ(all.refined_after, all.refined_before);
    EXPECT_EQ(all.bound, all.candidate_bound);
}

TEST(CoverageModel, TheTreeGetsTheMemoryThatCandidatesLeave) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3:2"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    SilentProgress silent;
    const ArrangeSite site = siteOf(scene, options);
    const CoverageModel usual(site, groups, options, silent);
    EXPECT_EQ(usual.searchOptions().max_bytes, kMaxTreeBytes);
    options.max_bytes = usual.bytes() + 1000;
    const CoverageModel narrow(site, groups, options, silent);
    EXPECT_EQ(narrow.searchOptions().max_bytes, 1000U);
    EXPECT_EQ(arranged(scene, groups, options).candidate_value,
              arranged(scene, groups, coarse(Optimizer::Exact)).candidate_value);
}

TEST(CoverageModel, SharesAndValuesLeadBackAndForth) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3"});
    const ArrangeOptions options = coarse();
    SilentProgress silent;
    const ArrangeSite site = siteOf(scene, options);
    const CoverageModel model(site, groups, options, silent);
    for (const std::uint64_t value :
         {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{977}, model.problem().totalWeight()}) {
        EXPECT_EQ(model.valueFor(model.share(value)), value);
        EXPECT_EQ(model.valueFor(model.share(value) - 0.1 / 10'000), value) << "rounded up";
    }
}

TEST(CoverageModel, ChosenCandidatesBecomeSensorsOfTheSameValue) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3:2", "laser,range=2,fov=90"});
    const ArrangeOptions options = coarse();
    SilentProgress silent;
    const ArrangeSite site = siteOf(scene, options);
    CoverageModel model(site, groups, options, silent);
    ASSERT_EQ(model.kinds().size(), 2U);
    const std::vector<Choice> chosen = {{1, 7}, {0, 30}, {0, 5}};
    const std::vector<Placement> sensors = model.placementsOf(chosen);
    ASSERT_EQ(sensors.size(), 3U);
    EXPECT_EQ(sensors[0].sensor, "laser1");
    EXPECT_EQ(sensors[2].group, 1U);
    const Scene whole = withPlaced(scene, groups, sensors);
    EXPECT_EQ(model.valueOf(model.viewsOf(std::span<const Placement>(sensors))),
              valueOf(model.problem(), chosen));
}

TEST(ArrangeGoals, AllCellsAreNotAllOfTheFloor) {
    // A corridor of half a cell's width off the room: no centre of a cell lies in it.
    const Scene scene = roomScene(
        "#env 1\nfence path=0,0;4,0;4,4;1,4;1,6;0.98,6;0.98,4;0,4 closed=yes\ninside at=2,2\n");
    ArrangeOptions options = coarse();
    options.target = 1;
    const Arrangement found =
        arranged(scene, groupsOf(scene, {"laser,range=99,fov=360"}, true), options);
    ASSERT_TRUE(found.exact_share);
    EXPECT_EQ(found.candidate_value, 1);
    EXPECT_LT(*found.exact_share, 1 - 1e-6);
    EXPECT_FALSE(found.is_reached);
    options.target = 0.99;
    EXPECT_TRUE(
        arranged(scene, groupsOf(scene, {"laser,range=99,fov=360"}, true), options).is_reached);
}

}  // namespace arrange_goals_test
}  // namespace ispace
