// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/number.h"
#include "sense/selection.h"
#include "support/test_layout.h"

namespace ispace {
namespace detection_test {

using testing::scene;

constexpr const char* kRoom = "ispace size=10,10,2.5\n";

std::size_t seenAt(const std::string& lines, Point2 place, const WatchOptions& options = {}) {
    const Scene room = scene(kRoom + lines);
    return DetectionMonitor(room, options).seenBy({place});
}

TEST(DetectionMonitor, SeesWithinTheSectorAndRangeOfALaser) {
    const std::string laser = "laser at=0,0 heading=0 range=3 fov=90\n";
    EXPECT_EQ(seenAt(laser, {2, 0}), 1U);
    EXPECT_EQ(seenAt(laser, {2, 2}), 1U) << "on the last beam";
    EXPECT_EQ(seenAt(laser, {1, 1.1}), 0U) << "beside it";
    EXPECT_EQ(seenAt(laser, {3, 0}), 1U) << "at the end of its range";
    EXPECT_EQ(seenAt(laser, {3.01, 0}), 0U);
    EXPECT_EQ(seenAt(laser, {-1, 0}), 0U);
}

TEST(DetectionMonitor, ThingsAtTheHeightOfTheSliceHide) {
    const std::string cube = "cube at=1,0 size=0.4,0.4,0.5\n";
    EXPECT_EQ(seenAt(cube + "laser at=0,0 range=4\n", {2, 0}), 0U);
    EXPECT_EQ(seenAt(cube + "laser at=0,0,0.6 range=4\n", {2, 0}), 1U);
    EXPECT_EQ(seenAt(cube + "laser at=1,0 range=4\n", {2, 0}), 0U) << "it stands in the cube";
}

TEST(DetectionMonitor, CountsSensors) {
    const std::string lasers =
        "laser at=0,0 range=4\nlaser at=0,1 range=4\nlaser at=0,-4 range=1\n";
    EXPECT_EQ(seenAt(lasers, {2, 0}), 2U);
    const Scene room = scene(kRoom + lasers);
    EXPECT_EQ(DetectionMonitor(room).sensors(), 3U);
}

TEST(DetectionMonitor, ALaserThatTurnsSeesWithItsWholeSweep) {
    const std::string laser =
        "laser at=0,0 range=4 fov=10 sweep=heading sweep_span=90 sweep_step=5\n";
    EXPECT_EQ(seenAt(laser, {1, 1}), 1U);
    EXPECT_EQ(seenAt(laser, {-1, 1}), 0U);
    EXPECT_EQ(seenAt(laser, {1, -1}), 0U);
}

TEST(DetectionMonitor, CamerasLookAtThePlane) {
    // It looks down at 45 degrees from 2 m, 40 degrees upright: 0.93 m to 4.3 m ahead.
    const std::string camera =
        "camera at=0,0,2 heading=0 tilt=-45 pixels=640,480 fov=50 range=20\n";
    EXPECT_EQ(seenAt(camera, {2, 0}), 1U);
    EXPECT_EQ(seenAt(camera, {0.5, 0}), 0U);
    EXPECT_EQ(seenAt(camera, {0.5, 0}, {.plane = 1.7}), 1U);
    EXPECT_EQ(seenAt(camera, {2, 0}, {.density = 1000}), 0U) << "too few pixels a metre";
}

TEST(DetectionMonitor, FourReceiversSeeTogether) {
    std::string receivers;
    for (const char* at : {"1,1,2", "-1,1,2", "1,-1,2"})
        receivers += std::string("ultrasound at=") + at + " tilt=-90\n";
    EXPECT_EQ(seenAt(receivers, {0, 0}), 0U);
    receivers += "ultrasound at=-1,-1,2 tilt=-90\n";
    EXPECT_EQ(seenAt(receivers, {0, 0}), 1U);
    const Scene room = scene(kRoom + receivers);
    EXPECT_EQ(DetectionMonitor(room).sensors(), 1U);
}

TEST(DetectionMonitor, PeopleHideNobody) {
    // A leg or the head stands in the beam that a laser's scan would have there.
    for (const double z : {0.15, 0.29, 0.30, 0.31, 0.45, 1.68}) {
        const std::string person = z < 1 ? "human at=0,-0.0935\n" : "human at=0,0\n";
        const Scene room =
            scene(kRoom + person + "laser at=-2,0," + formatDouble(z) + " range=8 fov=90\n");
        const MovingBodies bodies(bodiesOf(room));
        EXPECT_TRUE(bodies.between({-2, 0, z}, {2, 0, z}, MovingBodies::kNoOwner)) << z;
        EXPECT_EQ(DetectionMonitor(room).seenBy({{2, 0}}), 1U) << z;
    }
}

TEST(DetectionMonitor, SensorsRideAndDoNotSeeTheirCarrier) {
    const Scene room = scene(kRoom + std::string("robot id=r1 at=0,0\n"
                                                 "human id=h1 at=3,0 heading=90\n"
                                                 "laser on=r1 range=2 fov=360\n"
                                                 "camera id=c1 on=h1 at=0,0,1.6 tilt=-30\n"));
    const DetectionMonitor watch(room);
    EXPECT_TRUE(watch.rides());
    EXPECT_EQ(watch.seenBy({{1, 0}}), 1U);
    EXPECT_EQ(watch.seenBy({{0, 0}, 0}), 0U) << "its own robot";
    EXPECT_EQ(watch.seenBy({{0, 0}, 1}), 1U);
    const Pose2 robot{{-3, 0}, {}}, person{{3, 0}, Angle::degrees(180)};
    const WatchMoment moved{.robots = {&robot, 1}, .people = {&person, 1}};
    EXPECT_EQ(watch.seenBy({{1, 0}}, moved), 1U) << "the camera has turned, the laser is gone";
    EXPECT_EQ(watch.seenBy({{1, 0}, kFirstPerson}, moved), 0U);
    EXPECT_EQ(watch.seenBy({{3, 2}}), 1U) << "the camera where it starts";
    EXPECT_EQ(watch.seenBy({{3, 2}}, moved), 0U);
}

TEST(DetectionMonitor, CountsManyTargetsAsItCountsEachWithEachSensor) {
    const std::vector<std::string> sensors = {
        "laser at=-4,-4 range=3\n",
        "laser at=4,4,0.5 range=30 fov=90 heading=-135\n",
        "laser on=r1 range=2\n",
        "laser on=r2 range=1.5 fov=360\n",
        "laser at=0,4,2 tilt=-30 range=9\n",
        "camera at=4,-4,2 heading=135 tilt=-20 range=6\n",
        "laser at=1,1,0.2\n",  // within the cube
    };
    const std::string things =
        "cube at=1,1 size=0.6,0.6,1\nrobot id=r1 at=-2,2\nrobot id=r2 at=2,-2\n";
    std::vector<DetectionMonitor::Target> targets;
    for (int i = 0; i < 400; ++i) {
        const Point2 place{-4.75 + 0.5 * (i % 20), -4.75 + 0.5 * static_cast<double>(i / 20)};
        targets.push_back({place, static_cast<std::uint32_t>(i % 3)});
    }
    const std::vector<Pose2> robots{{{-3, 0}, Angle::degrees(20)}, {{3, 1}, Angle()}};
    const WatchMoment moment{.robots = robots};
    std::vector<std::size_t> sums(targets.size());
    std::string all = kRoom + things;
    for (const std::string& sensor : sensors) {
        all += sensor;
        const Scene one = scene(kRoom + things + sensor);
        const DetectionMonitor watch(one);
        for (std::size_t i = 0; i < targets.size(); ++i)
            sums[i] += watch.seenBy(targets[i], moment);
    }
    const Scene room = scene(all);
    EXPECT_EQ(DetectionMonitor(room).seenBy(targets, moment), sums);
    EXPECT_GT(*std::max_element(sums.begin(), sums.end()), 3U);
}

}  // namespace detection_test
}  // namespace ispace
