// SPDX-License-Identifier: GPL-3.0-or-later
// Inertial measurement units of a running world.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "extensions/imus/imus_test.h"
#include "extensions/imus/inertia.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace::imus {
namespace imu_run_test {

using std::chrono::milliseconds;

/// A reading and its time.
struct TimedInertia : Inertia {
    double time = 0;
};

TimedInertia newest(const World& world) {
    const auto& reading = std::get<AddedReading>(world.reading(0).value);
    return {reading.as<Inertia>(), reading.time};
}

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
        const TimedInertia reading = newest(world);
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

/// Drives along an arc at 0.8 m/s and 60 degrees a second, and returns the readings of a sensor.
std::vector<TimedInertia> readingsOnAnArc(const std::string& keys) {
    const Scene room = testing::scene("ispace size=20,20\n",
                                      "robot id=r1 at=0,0 max_speed=2 max_rotspeed=180 accel=1 "
                                      "rotaccel=100\nimu id=i1 on=r1 " +
                                          keys + "\n");
    World world(room, milliseconds(5));
    world.command(0, {Verb::Speed, 0.8});
    world.command(0, {Verb::Rotspeed, 60});
    std::vector<TimedInertia> readings;
    while (world.time() < std::chrono::seconds(4)) {
        world.step();
        if (!world.latestReadings().empty()) readings.push_back(newest(world));
    }
    return readings;
}

/// The axes turn between two readings: by 6 degrees at 10 Hz, by 30 at 2 Hz.
TEST(ImuRun, ReadsMeansInTheAxesOnTheWay) {
    const double rate = Angle::degrees(60).radians();
    for (const char* keys : {"at=0,0,0.2 rate=10", "at=0,0,0.2 rate=100", "at=0,0,0.2 rate=2"}) {
        double turned = 0, last = 0;
        for (const TimedInertia& reading : readingsOnAnArc(keys)) {
            turned += reading.rates.z * (reading.time - last);
            last = reading.time;
            // It speeds up at 100 degrees a second each second, for 0.6 s.
            if (reading.time > 0.6) {
                EXPECT_NEAR(turned, rate * (reading.time - 0.3), 2e-3) << keys << reading.time;
            }
            if (reading.time < 1.4) continue;
            EXPECT_NEAR(reading.accelerations.x, 0, 1e-9) << keys;
            EXPECT_NEAR(reading.accelerations.y, 0.8 * rate, 1e-9) << keys;
            EXPECT_NEAR(reading.rates.z, rate, 1e-9) << keys;
        }
    }
    // From 40 to 50 degrees a second between 0.4 and 0.5 s.
    for (const TimedInertia& reading : readingsOnAnArc("at=0,0,0.2 rate=10"))
        if (std::abs(reading.time - 0.5) < 1e-9) {
            EXPECT_NEAR(reading.rates.z, Angle::degrees(45).radians(), 5e-3);
        }
    // Off the axis, turned: v w to the left of the robot, and the centripetal w^2 r.
    const TimedInertia off = readingsOnAnArc("at=0.2,0.1,0.2 heading=30 rate=50").back();
    const double ahead = -0.2 * rate * rate, left = 0.8 * rate - 0.1 * rate * rate;
    const auto [c, s] = cosSin(Angle::degrees(30));
    EXPECT_NEAR(off.accelerations.x, c * ahead + s * left, 1e-9);
    EXPECT_NEAR(off.accelerations.y, c * left - s * ahead, 1e-9);
}

}  // namespace imu_run_test
}  // namespace ispace::imus
