// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/crowd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "env/level.h"
#include "geom/predicates.h"
#include "scene/bodies.h"
#include "support/test_scenes.h"

namespace ispace {
namespace {

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
        EXPECT_EQ(figure.standardError(), 0);
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

TEST(Crowd, KeepsDigestAndSensors) {
    const Scene scene = sceneOf(kHall + "cube id=crowd1 at=3,0\n" + kPeople);
    const Scene filled = withCrowd(scene, crowdOf(scene));
    EXPECT_EQ(filled.digest(), scene.digest());
    EXPECT_EQ(filled.sensors.size(), scene.sensors.size());
    EXPECT_EQ(filled.environment.elements().size(), scene.environment.elements().size() + 2);
}

TEST(Crowd, DrawsFreePositionsApart) {
    const Scene scene = sceneOf(kHall + "laser id=low at=0,-1 range=3\n");
    const CrowdFloor floor(scene);
    const double radius = humanRadius(kUsualHeight);
    const Slice band = scene.environment.band(0, kUsualHeight);
    double left = 0;
    for (std::uint64_t frame = 0; frame < 50; ++frame) {
        const Crowd crowd = floor.draw(12, {.seed = 3, .frame = frame});
        ASSERT_EQ(crowd.size(), 12U);
        for (std::size_t i = 0; i < crowd.size(); ++i) {
            const Point2 place = crowd[i].place;
            EXPECT_FALSE(band.blocked(place));
            band.forEachLine(
                [&](const Segment2& line) { EXPECT_GT(distance(place, line), radius); });
            EXPECT_GT(distance(place, Point2{0, -1}), radius);
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_GT(distance(place, crowd[k].place), 2 * radius);
            left += place.x < 0 ? 1 : 0;
        }
        const Crowd again = floor.draw(12, {.seed = 3, .frame = frame});
        EXPECT_EQ(again.back().place, crowd.back().place);
    }
    EXPECT_NEAR(left / 600, 0.5, 0.1);
}

TEST(Crowd, OfMorePeopleThanFitIsRefused) {
    const Scene scene = sceneOf("ispace size=1,1,3\nlaser at=0.45,0.45 range=3\n");
    EXPECT_THROW(static_cast<void>(CrowdFloor(scene).draw(9, {})), UnmetError);
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
    EXPECT_NEAR(figure.standardError(), std::sqrt(squares / 23 / 24), 1e-12);
    EXPECT_GT(figure.standardError(), 0);
    EXPECT_EQ(sampled.met[0], 24);
}

}  // namespace
}  // namespace ispace
