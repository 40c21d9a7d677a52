// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/beam_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <variant>

#include "base/file.h"
#include "support/test_arrange.h"
#include "support/test_paths.h"
#include "trace/ray_world.h"

namespace ispace {
namespace beam_cells_test {

Laser laserOfSpec(const char* spec) {
    return std::get<Laser>(groupsOf(roomScene(), {spec}).front().model);
}

TEST(BeamCells, ResolutionLaysBeamsOverTheSameView) {
    const Laser half = withBeamStep(laserOfSpec("laser,fov=180"), Angle::degrees(50));
    EXPECT_EQ(half.beams, 4);
    EXPECT_EQ(half.first, Angle::degrees(-90));
    EXPECT_EQ(half.last(), Angle::degrees(60));
    const Laser round = withBeamStep(laserOfSpec("laser,fov=360"), Angle::degrees(7));
    EXPECT_EQ(round.beams, 51);
    EXPECT_EQ(round.span(), Angle::degrees(360)) << "they close the circle";
    const Laser own = withBeamStep(laserOfSpec("laser,fov=180,step=10"), Angle());
    EXPECT_EQ(own.beams, 19);
}

TEST(BeamCells, AreThoseWithinTheContour) {
    const Scene scene = roomScene("#env 1\nispace size=8,6\n");
    RayScenes worlds(scene.environment);
    const Pose3 pose{{0.5, 0.25, kScanHeight}, Angle::degrees(30), {}, {}};
    worlds.prepare(pose);
    const Target target = makeTarget(scene.environment, CellSize{0.01}, kScanHeight);
    const auto area = [&](const char* spec, double degrees) {
        const Laser laser = withBeamStep(laserOfSpec(spec), Angle::degrees(degrees));
        const Sensor sensor{"", laser, pose};
        return 1e-4 *
               static_cast<double>(cellsByBeams(target.grid, worlds.at(pose), sensor).count());
    };
    // n triangles of two sides of 2 m.
    const auto triangles = [](int count, double degrees) {
        return count * 2 * std::sin(degrees * std::numbers::pi / 180);
    };
    EXPECT_NEAR(area("laser,range=2,fov=180", 90), triangles(2, 90), 0.02);
    EXPECT_NEAR(area("laser,range=2,fov=180", 30), triangles(6, 30), 0.02);
    EXPECT_NEAR(area("laser,range=2,fov=180", 1), triangles(180, 1), 0.02);
    EXPECT_NEAR(area("laser,range=2,fov=360", 90), triangles(4, 90), 0.02);
    EXPECT_NEAR(area("laser,range=2,fov=270", 60), triangles(4, 60), 0.02) << "-135 to 105";
    EXPECT_NEAR(area("laser,range=20,fov=360", 1), 48, 0.1) << "the whole room";
}

/// The pillar hides the cells behind it, at the width of the beams that hit it.
TEST(BeamCells, SearchesSeeWhatTheBeamsOfTheirStepSay) {
    const Scene scene = roomScene("#env 1\nispace size=8,6\npillar at=1,0 size=0.3,0.3\n");
    const auto groups = groupsOf(scene, {"laser,range=3,fov=180,step=10"});
    ArrangeOptions options;
    options.strategy = Strategy::List;
    options.list = {{{0, 0}, {Angle()}}};
    const double all = arranged(scene, groups, options).candidate_value;
    const auto value = [&](Angle step) {
        options.beam_step = step;
        const Arrangement found = arranged(scene, groups, options);
        EXPECT_EQ(found.value, found.candidate_value);
        EXPECT_EQ(found.coverage, reportOf(scene, groups, found).coverage.grid);
        return found.candidate_value;
    };
    EXPECT_NEAR(value(Angle::degrees(0.05)), all, 0.002);
    EXPECT_LT(value(Angle::degrees(10)), all - 0.002);
    EXPECT_LT(value(Angle::degrees(30)), value(Angle::degrees(10)));
    EXPECT_EQ(value(Angle()), value(Angle::degrees(10))) << "its own step";
}

TEST(Judge, WithoutItTheBestPlaceOfTheLRoomLiesOutside) {
    const Scene scene = roomScene(readAll(testing::sourcePath("share/scenes/l-room.env")));
    const auto groups = groupsOf(scene, {"laser,range=4,fov=180"});
    ArrangeOptions options;
    options.strategy = Strategy::Grid;
    const auto place = [&] {
        return arranged(scene, groups, options).sensors.at(0).pose.position.onFloor();
    };
    EXPECT_EQ(scene.environment.indoor().locate(place()), Side::Inside);
    options.indoor_only = false;
    EXPECT_EQ(scene.environment.indoor().locate(place()), Side::Outside);
}

}  // namespace beam_cells_test
}  // namespace ispace
