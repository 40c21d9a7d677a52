// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --robust failures: values against the worst failures of coverage.
#include <gtest/gtest.h>

#include "extensions/robustness/failures.h"
#include "extensions/robustness/robust_cases.h"
#include "support/test_arrange.h"

namespace ispace::robustness {
namespace layout_failures_test {

TEST(Robust, ValueOfFailuresIsThatOfCoverage) {
    const Document layout = layoutFrom("laser id=l9 at=3,2,0.15 heading=180 range=4 fov=180\n");
    const Scene scene = roomScene(kTestRoom, &layout);
    const auto groups = groupsOf(scene, {"laser,range=4,fov=200:3"});
    for (const int failures : {1, 2}) {
        ArrangeOptions options = coarse();
        options.cases = std::make_shared<const SensorFailures>(true, failures);
        const Arrangement found = arranged(scene, groups, options);
        const Scene whole = withPlaced(scene, groups, found.sensors);
        RayScenes worlds(whole.environment);
        const Coverage coverage = measureCoverage(whole, worlds, {.exact = false});
        const auto losses = worstFailures(whole, coverage, failures, {});
        EXPECT_NEAR(*found.value, losses[0].worst, 1e-9);
        EXPECT_NEAR(found.candidate_value, losses[0].worst, 1e-9);
        EXPECT_EQ(found.cases->failed.size(), static_cast<std::size_t>(failures));
        EXPECT_GE(found.bound, losses[0].worst);
        EXPECT_GE(found.cases->mean, found.cases->worst);
        // More than the plain layout keeps.
        ArrangeOptions plain = coarse();
        const Scene other = withPlaced(scene, groups, arranged(scene, groups, plain).sensors);
        RayScenes other_worlds(other.environment);
        const Coverage of_plain = measureCoverage(other, other_worlds, {.exact = false});
        EXPECT_GE(losses[0].worst, worstFailures(other, of_plain, failures, {})[0].worst);
    }
}

}  // namespace layout_failures_test
}  // namespace ispace::robustness
