// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/figure_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "extensions/robustness/robustness_test.h"
#include "support/test_mixed_room.h"
#include "support/test_scenes.h"
#include "trace/ray_world.h"

namespace ispace::robustness {
namespace figure_samples_test {

using testing::kMixedRoom;

TEST(Mounting, SpreadsFigures) {
    const Scene scene = sceneOf(kMixedRoom);
    const CoverageOptions options = cellsOfTest();
    const Coverage coverage = measuredBy(scene, options);
    const double planned = *coverage.report.coverage.exact;
    const std::vector<Requirement> requirements = {{Requirement::Of::Indoor, "", planned},
                                                   parseRequirement("0%")};
    SilentProgress silent;
    const SampledFigures spread = perturbMounting(
        scene, coverage.report, options, {0.1, Angle::degrees(5)}, 20, 7, requirements, silent);
    EXPECT_EQ(spread.samples, 20);
    ASSERT_EQ(spread.figures.size(), 4U);  // the last one of the zone outside is 0
    const FigureSpread& figure = spread.figures[0];
    EXPECT_EQ(figure.planned, planned);
    ASSERT_EQ(figure.values.size(), 20U);
    EXPECT_TRUE(std::is_sorted(figure.values.begin(), figure.values.end()));
    EXPECT_LT(figure.quantile(0), figure.quantile(1));
    EXPECT_EQ(figure.quantile(0.05), figure.values[0]);
    EXPECT_EQ(figure.quantile(0.5), figure.values[9]);
    EXPECT_EQ(figure.quantile(0.95), figure.values[18]);
    EXPECT_EQ(spread.met[1], 20);
    EXPECT_LT(spread.met[0], 20);
    // Mounting k is the same for any number of mountings.
    const SampledFigures fewer = perturbMounting(
        scene, coverage.report, options, {0.1, Angle::degrees(5)}, 3, 7, requirements, silent);
    for (const double value : fewer.figures[0].values)
        EXPECT_TRUE(std::binary_search(figure.values.begin(), figure.values.end(), value));
}

TEST(Mounting, WithoutToleranceAllIsAsPlanned) {
    const Scene scene = sceneOf(kMixedRoom + kReceivers);
    const CoverageOptions options = cellsOfTest();
    const Coverage coverage = measuredBy(scene, options);
    SilentProgress silent;
    for (const FigureSpread& figure :
         perturbMounting(scene, coverage.report, options, {}, 2, 0, {}, silent).figures)
        for (const double value : figure.values)
            EXPECT_NEAR(value, figure.planned, 1e-9) << figure.name;
}

const std::string kHall =
    "ispace size=10,8,3\npillar id=p at=1,1\ndesk id=d at=-2,1.5 heading=20\n"
    "zone id=door path=-5,-3;-3,-3;-3,-1;-5,-1\n"
    "laser id=l at=-4.9,0 range=8 fov=180\n"
    "camera id=c at=4.9,3.9,2.8 heading=-140 tilt=-35 fov=80 pixels=1280,720\n";
const std::string kPeople = "human id=h1 at=-1,-1\nhuman id=h2 at=2,-2 height=1.5\n";

CoverageOptions fewCells() {
    CoverageOptions options;
    options.cells = CellSize{0.1};
    return options;
}

Coverage measuredIn(const Scene& scene) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, fewCells());
}

SampledFigures crowded(const Scene& scene, const std::vector<Crowd>& crowds,
                       const std::vector<Requirement>& requirements = {}) {
    SilentProgress silent;
    return measureCrowds(scene, measuredIn(scene).report, fewCells(), crowds, requirements, silent);
}

TEST(Crowd, OfNobodyIsPlainCoverage) {
    const SampledFigures sampled = crowded(sceneOf(kHall), {Crowd()});
    ASSERT_EQ(sampled.figures.size(), 3U);
    for (const FigureSpread& figure : sampled.figures) {
        EXPECT_EQ(figure.values, std::vector<double>{figure.planned}) << figure.name;
        EXPECT_EQ(standardErrorOf(figure.values), 0);
    }
}

TEST(Crowd, OfTheSceneIsTheRoomWithRoundBodies) {
    const Scene scene = sceneOf(kHall + kPeople);
    ASSERT_EQ(crowdOf(scene).size(), 2U);
    const SampledFigures sampled = crowded(scene, {crowdOf(scene)});
    // 0.15 of the height is half the width.
    const CoverageReport report =
        measuredIn(sceneOf(kHall + "cylinder at=-1,-1 size=0.51,0.51,1.7\n"
                                   "cylinder at=2,-2 size=0.45,0.45,1.5\n"))
            .report;
    for (const FigureSpread& figure : sampled.figures) {
        EXPECT_TRUE(figure.is_exact);
        EXPECT_NEAR(figure.values.front(), *figureOf(figure.figure, report).share.exact, 1e-9)
            << figure.name;
        if (figure.figure.of != Requirement::Of::Indoor) continue;
        EXPECT_LT(figure.values.front(), figure.planned - 0.003);
    }
}

TEST(Crowd, MeanHasItsStandardError) {
    const Scene scene = sceneOf(kHall);
    const CrowdFloor floor(scene);
    std::vector<Crowd> crowds;
    for (std::uint64_t frame = 0; frame < 24; ++frame)
        crowds.push_back(floor.draw(5, {.frame = frame}));
    const SampledFigures sampled = crowded(scene, crowds, {parseRequirement("0%")});
    const FigureSpread& figure = sampled.figures.front();
    EXPECT_LT(figure.mean(), figure.planned);
    double squares = 0;
    for (const double value : figure.values) squares += std::pow(value - figure.mean(), 2);
    EXPECT_NEAR(standardErrorOf(figure.values), std::sqrt(squares / 23 / 24), 1e-12);
    EXPECT_GT(standardErrorOf(figure.values), 0);
    EXPECT_EQ(sampled.met[0], 24);
}

}  // namespace figure_samples_test
}  // namespace ispace::robustness
