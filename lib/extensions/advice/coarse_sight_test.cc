// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/advice/coarse_sight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "arrange/refine.h"
#include "support/test_arrange.h"

namespace ispace::advice {
namespace coarse_sight_test {

constexpr const char* kRoom =
    "#env 1\nispace id=hall size=10,8,2.8\n"
    "desk id=d1 at=-2,1 size=1.6,0.8,0.75 heading=30\ncube id=c1 at=2,-1 size=1.2,0.5,1.9\n"
    "zone id=corner path=2,1;5,1;5,4;2,4\n";

Scene roomWith(const std::string& sensors) {
    const Document placed = layoutFrom(sensors);
    return roomScene(kRoom, &placed);
}

std::vector<Pose3> posesAround(const Pose3& pose) {
    std::vector<Pose3> poses;
    for (int degrees = 0; degrees < 360; degrees += 15)
        for (const double shift : {0.0, 0.5, 1.0}) {
            Pose3& next = poses.emplace_back(pose);
            next.heading = Angle::degrees(degrees);
            next.position.x += shift;
        }
    return poses;
}

TEST(CoarseSight, ViewsCoverHardlyMoreThanTheirCells) {
    for (const char* const sensors :
         {"camera id=c at=-3,-2,2.5 fov=80 tilt=-35\ncamera id=o at=4.5,3.5,2.6 fov=90 tilt=-30 "
          "heading=-140\n",
          "laser id=c at=-3,-2 fov=180 range=6\nlaser id=o at=3,3 fov=270 range=4\n"}) {
        const Scene scene = roomWith(sensors);
        const SuggestOptions options;
        ASSERT_TRUE(CoarseSight::estimates(options));
        const Sensor& moving = scene.sensors.front();
        const std::vector<Pose3> poses = posesAround(moving.pose);
        CoarseSight coarse(scene.environment, options, CoarseSight::Cells::Many);
        coarse.look(scene.sensors);
        coarse.count(moving);
        const std::vector<FloorGain> estimates = coarse.at(moving, poses);
        Scene others = scene;
        others.sensors.erase(others.sensors.begin());
        const VisibleArea sight(scene.environment, options.measure.plane);
        ExactGain exact(others, sight, {&moving, 1}, {}, 1);
        exact.take(0);
        const std::vector<double> gains = exact.gains(poses);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            EXPECT_LE(gains[i], estimates[i].gained + 2 * coarse.error()) << i;
            EXPECT_NEAR(gains[i], estimates[i].gained, 0.05 * gains[i] + 4 * coarse.error()) << i;
        }
    }
}

TEST(CoarseSight, CountsPrivateFloorAgainstACamera) {
    const Scene scene = roomWith("camera id=c at=-4,-3,2.5 fov=80 tilt=-35 heading=45\n");
    SuggestOptions options;
    options.privacy = {camerarules::parsePrivacy("corner,1")};
    CoarseSight coarse(scene.environment, options, CoarseSight::Cells::Many);
    const Sensor& camera = scene.sensors.front();
    coarse.look(scene.sensors);
    coarse.count(camera);
    Pose3 away = camera.pose;
    away.heading = Angle::degrees(-135);
    const FloorGain whole = coarse.whole(scene.sensors);
    EXPECT_LT(whole.required, -4) << "most of 9 m2";
    EXPECT_EQ(coarse.privateOf(scene.sensors), whole.required);
    const std::vector<FloorGain> gains = coarse.at(camera, {&away, 1});
    EXPECT_EQ(gains[0].required, 0);
    EXPECT_LT(gains[0].gained, 1) << "it faces the corner";
}

TEST(CoarseSight, EstimatesOfKnownPlacesAreThoseOfNewOnes) {
    const Scene scene = roomWith(
        "camera id=c at=-4,-3,2.5 fov=80 tilt=-35 heading=45\n"
        "camera id=o at=4.5,3.5,2.6 fov=90 tilt=-30 heading=-140\n");
    SuggestOptions options;
    options.privacy = {camerarules::parsePrivacy("corner,1")};
    CoarseSight known(scene.environment, options, CoarseSight::Cells::Many);
    for (const std::size_t others : {std::size_t{2}, std::size_t{1}}) {
        CoarseSight fresh(scene.environment, options, CoarseSight::Cells::Many);
        for (CoarseSight* const coarse : {&known, &fresh})
            coarse->look(std::span(scene.sensors).first(others));
        for (const Sensor& moving : scene.sensors) {
            for (CoarseSight* const coarse : {&known, &fresh}) coarse->count(moving);
            const std::vector<Pose3> poses = posesAround(moving.pose);
            EXPECT_EQ(known.at(moving, poses), fresh.at(moving, poses)) << others;
        }
    }
}

TEST(CoarseSight, EstimatesNoRequirements) {
    EXPECT_TRUE(CoarseSight::estimates({}));
    SuggestOptions options;
    options.facing = {camerarules::parseFacing("corner,45deg,0=50%")};
    EXPECT_FALSE(CoarseSight::estimates(options));
}

TEST(CoarseSight, CountsFloorThatOneReceiverIsShortOf) {
    const std::string others =
        "ultrasound id=a at=-2,-1,2.5 range=4\nultrasound id=b at=2,-1,2.5 range=4\n"
        "ultrasound id=d at=0,2,2.5 range=4\n";
    const Scene scene = roomWith("ultrasound id=c at=-3,-2,2.5 range=4\n" + others);
    const Sensor& moving = scene.sensors.front();
    CoarseSight coarse(scene.environment, {}, CoarseSight::Cells::Many);
    coarse.look(scene.sensors);
    coarse.count(moving);
    const std::vector<Pose3> poses = posesAround(moving.pose);
    const std::vector<FloorGain> estimates = coarse.at(moving, poses);
    Scene rest = scene;
    rest.sensors.erase(rest.sensors.begin());
    const VisibleArea sight(scene.environment, 0);
    ExactGain exact(rest, sight, {&moving, 1}, {}, 1);
    exact.prepareBounds();
    exact.take(0);
    for (const Pose3& pose : poses) {
        const std::size_t i = static_cast<std::size_t>(&pose - poses.data());
        const double bound = exact.mostMore(pose), gain = exact.gains({&pose, 1})[0];
        EXPECT_NEAR(gain, estimates[i].gained, 0.05 * gain + 4 * coarse.error()) << i;
        EXPECT_LE(gain - exact.gains({&moving.pose, 1})[0], bound + 1e-6) << i;
    }
}

}  // namespace coarse_sight_test
}  // namespace ispace::advice
