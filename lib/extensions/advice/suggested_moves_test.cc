// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/advice/suggested_moves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "extensions/advice/adviser.h"
#include "support/test_arrange.h"

namespace ispace::advice {
namespace suggested_moves_test {

constexpr const char* kRoom =
    "#env 1\nispace id=hall size=10,8,2.8\nwall from=0,-4 to=0,1\n"
    "desk id=desk at=-2,1 size=1.6,0.8,0.75 heading=30\ncube id=low at=2,-1 size=1.2,0.5,0.4\n"
    "cube id=tall at=-1.5,-2 size=0.6,0.6,2.6\ntable id=table at=3,2\n"
    "cylinder id=drum at=2.5,-2.8 size=0.7,0.7,1\n";
const std::string kSpherical = "ranger projection=spherical ";

struct Measured {
    Scene scene;
    Coverage coverage;
};

Measured measure(Scene scene, const CoverageOptions& options) {
    RayScenes worlds(scene.environment);
    Coverage coverage = measureCoverage(scene, worlds, options);
    return {std::move(scene), std::move(coverage)};
}

std::size_t coveredIndoors(const Coverage& coverage) {
    return countCommon(coveredCells(coverage), coverage.target.indoor);
}

/// Moves each piece some way and compares the gain by shadows with that of a whole measure.
void expectSameGains(const std::string& layout) {
    SuggestOptions options;
    options.measure.cells = CellSize{0.1};
    options.measure.exact = false;
    const Document placed = layoutFrom(layout);
    const Measured now = measure(roomScene(kRoom, &placed), options.measure);
    ASSERT_TRUE(MoveTrials::areKnown(now.scene, now.coverage, options));
    MoveTrials trials(now.scene, now.coverage, options);
    EXPECT_EQ(trials.error(), 0);
    const double before = static_cast<double>(coveredIndoors(now.coverage));
    bool is_any = false;
    for (const char* const piece : {"desk", "low", "tall", "table", "drum"})
        for (const Vec2 by : {Vec2{0.5, 0}, Vec2{-0.7, 0.7}, Vec2{0, -1.9}, Vec2{-2.4, 1.3}}) {
            const std::vector<Edit> edits = {moveOf(piece, by)};
            const Scene moved = makeScene(edited(now.scene.records, edits, sceneSchemas()),
                                          now.scene, DeviceCatalogue());
            const auto gain = trials.gainIn(moved.environment);
            ASSERT_TRUE(gain.has_value());
            const Measured then = measure(moved, options.measure);
            const double cells = static_cast<double>(coveredIndoors(then.coverage)) - before;
            EXPECT_NEAR(*gain, cells * now.coverage.target.grid.cellArea(), 1e-9)
                << layout << piece << " by " << by.x << "," << by.y;
            is_any = is_any || cells != 0;
        }
    EXPECT_TRUE(is_any) << layout;
}

TEST(MoveTrials, GainAsWholeMeasures) {
    const std::string around = kSpherical + "fov=360,180 range=50 at=";
    const std::string ahead = kSpherical + "fov=120,60 range=9 at=";
    expectSameGains(around + "-4,-3,2\n" + around + "4,3,2.7\n" + around + "-3,3,0.2\n" + around +
                    "2,-1,0.2\n");
    expectSameGains("camera at=-4.9,-3.9,2.5 heading=40 tilt=-30 pixels=640,480\n");
    expectSameGains("laser at=-4,-3 fov=270 range=7\nlaser at=3,3,0.5 tilt=-10 range=6\n");
    expectSameGains("ranger at=-4,0,1 tilt=-20 fov=40 range=6\n" + ahead +
                    "4.8,3.8,2.4 heading=-140\n");
    expectSameGains(ahead + "-4,0,0\n" + ahead + "0.1,3,1.2 heading=-60\n" + around + "1,-3,0\n");
}

TEST(MoveTrials, CountFloorThatEnoughReceiversHear) {
    std::string receivers;
    for (const char* const at :
         {"-2,-2", "-1,-2", "-2,-1", "-1,-1", "2.5,1.5", "3.3,1.5", "2.5,2.5", "3.3,2.5", "2.9,2"})
        receivers += std::string("ultrasound at=") + at + ",2.5 tilt=-90\n";
    expectSameGains(receivers);
}

TEST(MoveTrials, OfSensorsFarAwayAreNone) {
    SuggestOptions options;
    const Document placed = layoutFrom(kSpherical + "at=-4,-3,2 fov=360,180 range=3\n");
    const Measured now = measure(roomScene(kRoom, &placed), options.measure);
    MoveTrials trials(now.scene, now.coverage, options);
    EXPECT_GT(trials.error(), 0) << "figures are exact";
    const std::vector<Edit> edits = {moveOf("table", {0.3, 0.3})};
    const Environment moved(edited(now.scene.records, edits, sceneSchemas()), now.scene.ids,
                            now.scene.environment);
    EXPECT_EQ(trials.gainIn(moved), 0);
    const Scene other = roomScene("#env 1\nispace size=8,6\n", &placed);
    EXPECT_EQ(trials.gainIn(other.environment), std::nullopt);
}

TEST(MoveTrials, AreNotKnownForRequirements) {
    const Document placed = layoutFrom(kSpherical + "at=-4,-3,2 fov=360,180 range=9\n");
    SuggestOptions options;
    const Measured now = measure(roomScene(kRoom, &placed), options.measure);
    EXPECT_TRUE(MoveTrials::areKnown(now.scene, now.coverage, options));
    options.requirements = {parseRequirement("90%")};
    EXPECT_FALSE(MoveTrials::areKnown(now.scene, now.coverage, options));
}

}  // namespace suggested_moves_test
}  // namespace ispace::advice
