// SPDX-License-Identifier: GPL-3.0-or-later
// Inertial measurement units and RFID readers of a running world.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace {

using std::chrono::milliseconds;

/// The sums of the readings agree with the true motion of the robot, which speeds up, brakes, and
/// turns to the next point of its path.
TEST(ImuRun, AgreesWithTheMotionOfItsRobot) {
    const Scene room = testing::scene("ispace size=12,12\n",
                                      "imu id=i1 at=0,0,0.2 on=r1 rate=100\n"
                                      "robot id=r1 model=pioneer-2dx at=-1,-3 path=1,-3;1,0\n");
    World world(room, milliseconds(5));
    double speed = 0, turned = 0, last = 0, fastest = 0;
    while (world.time() < std::chrono::seconds(30)) {
        world.step();
        if (world.latestReadings().empty()) continue;
        const auto& reading = std::get<Inertia>(world.reading(0).value);
        speed += reading.accelerations.x * (reading.time - last);
        turned += Angle::radians(reading.rates.z * (reading.time - last)).degrees();
        last = reading.time;
        const RobotStatus status = world.status(0);
        EXPECT_NEAR(reading.accelerations.z, 9.80665, 1e-9);
        ASSERT_NEAR(speed, status.speed, 0.01) << last;
        ASSERT_NEAR(turned, status.pose.heading.degrees(), 2) << last;
        fastest = std::max(fastest, speed);
    }
    EXPECT_GT(fastest, 0.1);
    EXPECT_GT(turned, 45);
    EXPECT_NEAR(speed, 0, 0.01) << "it stands again";
}

TEST(RfidRun, ListsATagWhileItPasses) {
    const Scene room = testing::scene("ispace size=12,12\n",
                                      "rfid at=0,-2,1 heading=90 fov=60,90 range=3\n"
                                      "human at=-4,0 path=4,0 tag=anna\n");
    World world(room, milliseconds(50));
    std::vector<std::vector<std::string>> lists = {{}};
    double first = 0, end = 0;
    while (world.time() < std::chrono::seconds(12)) {
        world.step();
        if (world.latestReadings().empty()) continue;
        const auto& reading = std::get<RfidTags>(world.reading(0).value);
        if (reading.tags == lists.back()) continue;
        lists.push_back(reading.tags);
        (reading.tags.empty() ? end : first) = reading.time;
    }
    ASSERT_EQ(lists, (std::vector<std::vector<std::string>>{{}, {"anna"}, {}}));
    // The field is 2 * 2 tan 30 = 2.3 m wide there, and the person walks 1.2 m a second.
    EXPECT_NEAR(end - first, 2.31 / 1.2, 0.4);
}

}  // namespace
}  // namespace ispace
