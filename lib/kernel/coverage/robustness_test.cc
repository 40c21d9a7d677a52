// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/robustness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "env/level.h"
#include "support/test_scenes.h"

namespace ispace {
namespace {

const std::string kMixedRoom =
    "ispace size=10,8,3\npillar id=p at=1,1\ndesk id=d at=-2,1.5 heading=20\n"
    "wall from=-1,-4 to=-1,-1 height=3\n"
    "zone id=door path=-5,-3;-3,-3;-3,-1;-5,-1\nzone id=far at=20,0 size=1,1\n"
    "laser id=l1 at=-4.9,0 heading=0 range=6 fov=90\n"
    "laser id=l2 at=4.9,0 heading=180 range=6 fov=120\n"
    "laser id=l3 at=0,-3.9 heading=90 range=4 fov=180\n"
    "camera id=c1 at=-4.9,-3.9,2.8 heading=40 tilt=-35 fov=80 pixels=1920,1080\n"
    "camera id=c2 at=4.9,3.9,2.8 heading=-140 tilt=-35 fov=70 pixels=1280,720\n";
/// Five receivers below the ceiling.
const std::string kReceivers = [] {
    std::string lines;
    for (int i = 0; i < 5; ++i)
        lines += "ultrasound id=u" + std::to_string(i) + " at=" + std::to_string(i - 3) + "," +
                 std::to_string(i % 3 - 1) + ",2.9 tilt=-90 fov=100 range=9\n";
    return lines;
}();

CoverageOptions cellsOfTest(bool exact = true) {
    CoverageOptions options;
    options.cells = CellSize{0.1};
    options.exact = exact;
    return options;
}

Coverage measuredBy(const Scene& scene, const CoverageOptions& options) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, options);
}

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

TEST(Mounting, ParsesTolerances) {
    EXPECT_NEAR(parseTolerance("5cm,3deg").distance, 0.05, 1e-15);
    EXPECT_NEAR(parseTolerance("0.1,3").angle.degrees(), 3, 1e-12);
    for (const char* text : {"", "5cm", "5cm,", ",3", "-1cm,3", "2,3", "1cm,181", "5cm,3,1"})
        EXPECT_ANY_THROW(parseTolerance(text)) << text;
}

TEST(Mounting, StaysWithinTolerances) {
    const Scene scene = sceneOf(kMixedRoom);
    const MountingTolerance tolerance{0.3, Angle::degrees(10)};
    double farthest = 0, widest = 0;
    for (std::uint64_t k = 0; k < 300; ++k)
        for (const Sensor& sensor : scene.sensors) {
            const Pose3 pose =
                mountedPose(scene.environment, sensor, tolerance, {.seed = 4, .frame = k});
            const double moved = distance(pose.position.onFloor(), sensor.pose.position.onFloor());
            const double turned = std::abs(wrapped(pose.heading - sensor.pose.heading).degrees());
            const double tilted = std::abs((pose.tilt - sensor.pose.tilt).degrees());
            EXPECT_LE(moved, 0.3 + 1e-9);
            EXPECT_LE(turned, 10 + 1e-9);
            EXPECT_LE(tilted, sensor.is<Camera>() ? 10 + 1e-9 : 0);
            EXPECT_TRUE(scene.environment.level(pose.position.z)->isFree(pose.position.onFloor()))
                << sensor.id;
            farthest = std::max(farthest, moved);
            widest = std::max(widest, turned);
        }
    EXPECT_GT(farthest, 0.28);
    EXPECT_GT(widest, 9.8);
}

TEST(Mounting, CrossesNoWall) {
    // The wall at x = -1 is nearer than the tolerance.
    const Scene scene = sceneOf(kMixedRoom + "laser id=near at=-0.95,-2 fov=180\n");
    for (std::uint64_t k = 0; k < 200; ++k)
        EXPECT_GT(mountedPose(scene.environment, scene.sensors.back(), {0.4, {}}, {.frame = k})
                      .position.x,
                  -1);
}

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

}  // namespace
}  // namespace ispace
