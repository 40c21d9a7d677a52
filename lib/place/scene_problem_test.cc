// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/scene_problem.h"

#include <gtest/gtest.h>

#include "place/test_arrange.h"

namespace ispace {
namespace {

TEST(SceneProblem, TheTreeGetsTheMemoryThatCandidatesLeave) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3:2"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    SilentProgress silent;
    const SceneProblem usual(scene, groups, options, silent);
    EXPECT_EQ(usual.searchOptions().most_bytes, kMaxTreeBytes);
    options.most_bytes = usual.bytes() + 1000;
    const SceneProblem narrow(scene, groups, options, silent);
    EXPECT_EQ(narrow.searchOptions().most_bytes, 1000U);
    EXPECT_EQ(arranged(scene, groups, options).candidate_value,
              arranged(scene, groups, coarse(Optimizer::Exact)).candidate_value);
}

TEST(SceneProblem, SharesAndValuesLeadBackAndForth) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3"});
    const ArrangeOptions options = coarse();
    SilentProgress silent;
    const SceneProblem model(scene, groups, options, silent);
    for (const std::uint64_t value :
         {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{977}, model.problem().totalWeight()}) {
        EXPECT_EQ(model.valueFor(model.share(value)), value);
        EXPECT_EQ(model.valueFor(model.share(value) - 0.1 / 10'000), value) << "rounded up";
    }
}

TEST(SceneProblem, ChosenCandidatesBecomeSensorsWorthTheSame) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3:2", "laser,range=2,fov=90"});
    const ArrangeOptions options = coarse();
    SilentProgress silent;
    SceneProblem model(scene, groups, options, silent);
    ASSERT_EQ(model.kinds().size(), 2U);
    const std::vector<Choice> chosen = {{1, 7}, {0, 30}, {0, 5}};
    const std::vector<ArrangedSensor> sensors = model.sensorsOf(chosen);
    ASSERT_EQ(sensors.size(), 3U);
    EXPECT_EQ(sensors[0].id, "laser1");
    EXPECT_EQ(sensors[2].group, 1U);
    EXPECT_EQ(model.valueOf(model.coverageOf(sensors)), valueOf(model.problem(), chosen));
}

}  // namespace
}  // namespace ispace
