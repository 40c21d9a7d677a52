// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/coverage_model.h"

#include <gtest/gtest.h>

#include "support/test_arrange.h"
#include "support/test_problems.h"

namespace ispace {
namespace redundant_sensors_test {

/// Computes the least distance between two of the sensors, and from them to other points.
double leastDistance(const Arrangement& arrangement, std::initializer_list<Point3> others = {}) {
    std::vector<Point3> places = others;
    double least = 1e9;
    for (const Placement& sensor : arrangement.sensors) {
        for (const Point3& place : places)
            least = std::min(least, length(sensor.pose.position - place));
        places.push_back(sensor.pose.position);
    }
    return least;
}

TEST(IdleSensors, AreNamedAndStandApart) {
    const Scene scene = roomScene("#env 1\nispace size=8,6\n");
    for (const char* laser : {"laser,range=20,fov=360:6", "laser,range=20,fov=180:6"})
        for (const Optimizer optimizer : kOptimizers) {
            const auto groups = groupsOf(scene, {laser});
            const Arrangement all = arranged(scene, groups, coarse(optimizer));
            EXPECT_EQ(all.candidate_value, 1) << laser;
            EXPECT_GE(all.idle.size(), 4U) << laser;
            EXPECT_GE(leastDistance(all), 2) << laser << ' ' << nameOf(optimizer);
        }
}

TEST(IdleSensors, ThoseThatCoverNothingMoreThanWhatStandsAreIdle) {
    const Document layout = layoutFrom("laser id=all at=0,0,0.15 range=20 fov=360\n");
    const Scene scene = roomScene("#env 1\nispace size=8,6\n", &layout);
    const auto groups = groupsOf(scene, {"laser:2"});
    const Arrangement all = arranged(scene, groups, coarse());
    EXPECT_EQ(all.idle.size(), 2U);
    EXPECT_GE(leastDistance(all, {{0, 0, 0.15}}), 3);
}

TEST(IdleSensors, WhoAddsSomethingIsNotNamed) {
    const Scene scene = roomScene();
    const Arrangement all = arranged(scene, groupsOf(scene, {"laser,range=2:3"}), coarse());
    EXPECT_TRUE(all.idle.empty());
}

TEST(IdleSensors, TheRestHasTheSameValue) {
    std::size_t found = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        RandomProblemOptions options;
        options.kinds = 2;
        options.sites = 12;
        options.max_weight = 3;
        options.max_achieved = static_cast<int>(seed % 2);
        options.required = 1 + static_cast<int>(seed % 3);
        const RandomProblem random = randomProblem(seed, options);
        const Problem& problem = random.problem;
        std::vector<Choice> chosen;
        for (std::size_t k = 0; k < problem.kinds.size(); ++k)
            for (std::size_t i = seed % 2; i < problem.kinds[k].candidates->size(); i += 2)
                chosen.push_back({k, i});
        const auto idle = idleChoices(problem, chosen);
        found += idle.size();
        std::vector<Choice> rest;
        for (std::size_t i = 0; i < chosen.size(); ++i)
            if (!std::binary_search(idle.begin(), idle.end(), i)) rest.push_back(chosen[i]);
        EXPECT_EQ(valueOf(problem, rest), valueOf(problem, chosen)) << seed;
        EXPECT_TRUE(idleChoices(problem, rest).empty()) << seed;
        std::vector<Choice> moved = chosen;
        const auto position_of = [](const Choice& choice) {
            return Point3{static_cast<double>(choice.candidate), 0, 0};
        };
        spreadRedundant(problem, {}, position_of, moved);
        EXPECT_GE(valueOf(problem, moved), valueOf(problem, chosen)) << seed;
        ASSERT_EQ(moved.size(), chosen.size());
        for (std::size_t i = 0; i < chosen.size(); ++i) EXPECT_EQ(moved[i].kind, chosen[i].kind);
    }
    EXPECT_GT(found, 100U);
}

}  // namespace redundant_sensors_test
}  // namespace ispace
