// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/failures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "extensions/robustness/robustness_test.h"
#include "support/test_mixed_room.h"
#include "support/test_scenes.h"

namespace ispace::robustness {
namespace failures_test {

using testing::kMixedRoom;

/// Returns the figure without each set of two sensors, or of one, and its minimum.
double bruteForce(const Scene& scene, const Requirement& figure, std::size_t count,
                  const CoverageOptions& options) {
    double worst = 1;
    const std::size_t sensors = scene.sensors.size();
    for (std::size_t i = 0; i < sensors; ++i)
        for (std::size_t k = i; k < sensors; ++k) {
            if ((count == 1) != (i == k)) continue;
            Scene left = scene;
            if (k != i) left.sensors.erase(left.sensors.begin() + static_cast<std::ptrdiff_t>(k));
            left.sensors.erase(left.sensors.begin() + static_cast<std::ptrdiff_t>(i));
            const Metric share = figureOf(figure, measuredBy(left, options).report).share;
            worst = std::min(worst, options.exact ? *share.exact : *share.grid);
        }
    return worst;
}

void expectWorst(const std::string& lines, int count, bool exact, double error) {
    const Scene scene = sceneOf(lines);
    const CoverageOptions options = cellsOfTest(exact);
    const Coverage coverage = measuredBy(scene, options);
    const std::vector<Requirement> requirements = {parseRequirement("identify:10%"),
                                                   parseRequirement("detect:door=90%")};
    const auto losses = worstFailures(scene, coverage, count, requirements);
    ASSERT_GE(losses.size(), 5U);
    for (const FigureLoss& loss : losses) {
        EXPECT_EQ(loss.is_exact, exact) << loss.name;
        EXPECT_EQ(loss.sensors.size(), static_cast<std::size_t>(count));
        EXPECT_NEAR(loss.worst,
                    bruteForce(scene, loss.figure, static_cast<std::size_t>(count), options), error)
            << loss.name;
    }
}

TEST(Failures, OneSensorIsTheWorstOfAll) { expectWorst(kMixedRoom, 1, true, 1e-7); }
TEST(Failures, TwoSensorsAreTheWorstOfAllPairs) { expectWorst(kMixedRoom, 2, true, 1e-7); }
TEST(Failures, AgreeByCells) { expectWorst(kMixedRoom, 2, false, 1e-12); }

TEST(Failures, ReceiversCoverTogether) {
    expectWorst(kMixedRoom + kReceivers, 1, true, 1e-6);
    expectWorst(kMixedRoom + kReceivers, 2, false, 1e-12);
}

TEST(Failures, NameTheSensorsAndStopAtAll) {
    const Scene scene = sceneOf(
        "ispace size=8,6\nlaser id=a at=-3,0 range=1 fov=360\nlaser id=b at=0,0 range=2 fov=360\n"
        "laser id=c at=0,0 range=2 fov=360\n");
    const Coverage coverage = measuredBy(scene, cellsOfTest());
    // b and c see the same: only a is missed.
    auto losses = worstFailures(scene, coverage, 1, {});
    EXPECT_EQ(losses[0].name, "coverage");
    EXPECT_EQ(losses[0].sensors, std::vector<std::string>{"a"});
    EXPECT_NEAR(losses[0].worst, 4 * std::acos(-1.0) / 48, 1e-7);
    losses = worstFailures(scene, coverage, 2, {});
    EXPECT_EQ(losses[0].sensors, (std::vector<std::string>{"b", "c"}));
    losses = worstFailures(scene, coverage, 8, {});
    EXPECT_EQ(losses[0].sensors.size(), 3U);
    EXPECT_EQ(losses[0].worst, 0);
    const Scene empty = sceneOf("ispace size=8,6\n");
    losses = worstFailures(empty, measuredBy(empty, cellsOfTest()), 1, {});
    EXPECT_TRUE(losses[0].sensors.empty());
    EXPECT_EQ(losses[0].worst, 0);
}

TEST(Failures, RefuseTooManySets) {
    std::string lines = "ispace size=8,6\n";
    for (int i = 0; i < 200; ++i)
        lines += "laser at=" + std::to_string(0.03 * i - 3) + ",0 range=1 fov=360\n";
    const Scene scene = sceneOf(lines);
    const Coverage coverage = measuredBy(scene, cellsOfTest(false));
    EXPECT_THROW(worstFailures(scene, coverage, 8, {}), UsageError);
    EXPECT_EQ(worstFailures(scene, coverage, 1, {})[0].sensors.size(), 1U);
}

}  // namespace failures_test
}  // namespace ispace::robustness
