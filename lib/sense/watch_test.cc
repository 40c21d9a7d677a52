// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/detection.h"

#include <gtest/gtest.h>

#include <string>

#include "base/number.h"
#include "sense/selection.h"
#include "support/test_layout.h"

namespace ispace {
namespace {

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

}  // namespace
}  // namespace ispace
