// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/robot_sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "support/test_layout.h"

namespace ispace {
namespace floor_sensors_test {

using testing::scene;

Motion at(Point2 place, double heading = 0) {
    Motion motion;
    motion.pose = {place, Angle::degrees(heading)};
    return motion;
}

/// A room with a person, moved by the test.
struct Floor {
    explicit Floor(const std::string& records)
        : room(scene("ispace size=20,20\n", records)), sensors(room) {}
    void robot(Point2 place, double heading = 0) {
        motions = {at(place, heading)};
        sensors.follow({motions, {}, {}});
    }
    void person(Point2 place, double heading = 0) {
        motions = {at(place, heading)};
        const std::vector<Angle> swings(1);
        sensors.follow({{}, motions, swings});
    }

    Scene room;
    FloorSensors sensors;
    std::vector<Motion> motions;
};

/// Random walks through random gates: every crossing is counted, once, whatever the length of the
/// steps, as the sides of the places in each gate's own frame tell.
TEST(FloorSensors, GatesCountEveryCrossing) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-4, 4), angle(-180, 180), width(0.5, 6);
    for (int round = 0; round < 200; ++round) {
        std::string records = "robot id=r1 at=9,9\n";
        struct Expected {
            Pose2 pose;
            double half;
            std::int64_t in = 0, out = 0;
        };
        std::vector<Expected> gates;
        for (int k = 0; k < 5; ++k) {
            const double x = place(random), y = place(random), h = angle(random), w = width(random);
            records += "gate at=" + std::to_string(x) + "," + std::to_string(y) +
                       " heading=" + std::to_string(h) + " width=" + std::to_string(w) +
                       " height=0.1\n";
        }
        Floor floor(records);
        for (const Gate& gate : floor.sensors.gates())
            gates.push_back({gate.pose, gate.half_width});
        Point2 from{place(random), place(random)};
        floor.robot(from);
        // Short steps and long ones.
        std::uniform_real_distribution<double> step(-1, 1);
        const double reach = round % 2 == 0 ? 0.05 : 4;
        std::size_t passages = 0;
        for (int i = 0; i < 300; ++i) {
            const Point2 to{std::clamp(from.x + reach * step(random), -5.0, 5.0),
                            std::clamp(from.y + reach * step(random), -5.0, 5.0)};
            for (Expected& gate : gates) {
                const auto local = [&](Point2 p) {
                    const Vec2 way = p - gate.pose.position;
                    const Vec2 ahead = unitVector(gate.pose.heading);
                    return Vec2{dot(way, ahead), cross(ahead, way)};
                };
                const Vec2 a = local(from), b = local(to);
                if ((a.x < 0) == (b.x < 0)) continue;
                const double y = a.y + (b.y - a.y) * (a.x / (a.x - b.x));
                if (std::fabs(y) <= gate.half) ++(a.x < 0 ? gate.in : gate.out);
            }
            floor.robot(to);
            passages += floor.sensors.passages().size();
            from = to;
        }
        std::int64_t all = 0;
        for (std::size_t k = 0; k < gates.size(); ++k) {
            EXPECT_EQ(floor.sensors.gate(k).in, gates[k].in) << round << " " << k;
            EXPECT_EQ(floor.sensors.gate(k).out, gates[k].out) << round << " " << k;
            all += gates[k].in + gates[k].out;
        }
        EXPECT_EQ(static_cast<std::int64_t>(passages), all);
    }
}

TEST(FloorSensors, OnTheLineIsNotYetThrough) {
    Floor floor("robot id=r1 at=9,9\ngate id=g1 height=0.1\n");
    for (const double x : {-1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0}) floor.robot({x, 0});
    // What is on the line is in front of it: in, out, in, out.
    EXPECT_EQ(floor.sensors.gate(0).in, 2);
    EXPECT_EQ(floor.sensors.gate(0).out, 2);
    EXPECT_EQ(floor.sensors.gate(0).last, "r1");
    EXPECT_FALSE(floor.sensors.gate(0).last_in);
}

TEST(FloorSensors, AGateDoesNotSeeWhatIsLower) {
    Floor low("robot id=r1 at=9,9 height=0.22\ngate id=g1 height=0.22\ngate id=g2 height=0.23\n");
    low.robot({-1, 0});
    low.robot({0, 0});
    EXPECT_TRUE(low.sensors.gate(0).broken);
    EXPECT_FALSE(low.sensors.gate(1).broken);
    low.robot({1, 0});
    EXPECT_EQ(low.sensors.gate(0).in, 1);
    EXPECT_EQ(low.sensors.gate(1).in, 0);
}

TEST(FloorSensors, AJumpIsNoPassage) {
    Floor floor("robot id=r1 at=9,9\ngate id=g1 height=0.1\n");
    floor.robot({-1, 0});
    floor.sensors.forgetPlaces();
    floor.robot({1, 0});
    EXPECT_EQ(floor.sensors.gate(0).in, 0);
    floor.robot({-1, 0});
    EXPECT_EQ(floor.sensors.gate(0).out, 1);
}

TEST(FloorSensors, AMatFeelsLegs) {
    Floor floor("human id=h1 at=9,9\nmat id=m1 size=0.02,0.02\n");
    // The space between the legs is empty, however the person turns.
    floor.person({0, 0});
    EXPECT_TRUE(floor.sensors.mat(0).on.empty());
    floor.person({0, 0}, 37);
    EXPECT_TRUE(floor.sensors.mat(0).on.empty());
    // A leg to either side; arms do not count.
    int steps = 0;
    for (int i = -60; i <= 60; ++i) {
        floor.person({0, i * 0.01});
        steps += static_cast<int>(floor.sensors.mat(0).on.size());
    }
    EXPECT_GT(steps, 10);
    EXPECT_LT(steps, 60);
    EXPECT_EQ((Floor("human id=h1 at=9,9\nmat id=m1\n").sensors.mats().size()), 1U);
}

/// Boxes on turned mats, against points of the box's outline and of the mat's.
TEST(FloorSensors, AMatFeelsBoxes) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-1, 1), angle(-180, 180);
    Floor floor("robot id=r1 at=9,9 size=0.6,0.3 center=0.1\nmat id=m1 size=1,0.4 heading=25\n");
    const Mat& mat = floor.sensors.mats()[0];
    const auto holds = [](const Pose2& pose, double length, double width, Point2 p) {
        const Vec2 way = p - pose.position, ahead = unitVector(pose.heading);
        return std::fabs(dot(way, ahead)) <= length && std::fabs(cross(ahead, way)) <= width;
    };
    int touches = 0;
    for (int i = 0; i < 3000; ++i) {
        const Pose2 robot{{place(random), place(random)}, Angle::degrees(angle(random))};
        floor.robot(robot.position, robot.heading.degrees());
        const Pose2 body{robot * Point2{0.1, 0}, robot.heading};
        bool expected = false;
        constexpr int kSteps = 40;
        for (int a = -kSteps; a <= kSteps && !expected; ++a)
            for (int b = -kSteps; b <= kSteps && !expected; ++b) {
                const double u = a / double{kSteps}, v = b / double{kSteps};
                expected = holds(body, 0.3, 0.15, mat.pose * Point2{0.5 * u, 0.2 * v});
            }
        const bool found = !floor.sensors.mat(0).on.empty();
        touches += found ? 1 : 0;
        // Samples may miss a corner that is barely on it.
        if (expected) {
            EXPECT_TRUE(found) << i;
        }
        if (found && !expected) {
            bool near = false;
            for (int a = -kSteps; a <= kSteps && !near; ++a)
                for (int b = -kSteps; b <= kSteps && !near; ++b)
                    near = holds(body, 0.32, 0.17,
                                 mat.pose * Point2{0.5 * a / kSteps, 0.2 * b / kSteps});
            EXPECT_TRUE(near) << i;
        }
    }
    EXPECT_GT(touches, 500);
}

}  // namespace floor_sensors_test
}  // namespace ispace
