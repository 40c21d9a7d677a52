// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pirs/pir_state.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "extensions/pirs/pirs_test.h"
#include "sense/formats/reading_format.h"
#include "support/test_readings.h"

namespace ispace::pirs {
namespace pir_state_test {

constexpr double kTall = 1.7;

/// A room of 40 by 40 m with a PIR sensor at the height of chests.
class PirTest : public ::testing::Test {
  protected:
    Scene room = testing::scene("ispace size=40,40\n");
    Pir pir;
    Sensor sensor{"s1", modelOf(Pir()), {{0, 0, 1.1}, {}, {}, {}}};
    std::vector<MovingBody> bodies;
    MoverVelocities velocities;

    void addPerson(Point2 at, Vec2 velocity) {
        const auto owner = kFirstPerson + static_cast<std::uint32_t>(velocities.people.size());
        for (const MovingBody& part : humanBodies(kTall, {at, {}}, owner)) bodies.push_back(part);
        velocities.people.push_back({at, velocity, 0});
    }
    void addRobot(Point2 at, Vec2 velocity, double height) {
        RobotModel model;
        model.radius = 0.3;
        model.height = height;
        bodies.push_back(robotBody(model, {at, {}}, 0));
        velocities.robots.push_back({at, velocity, 0});
    }

    PirState detect(std::optional<std::uint64_t> seed = {}, int frame = 0) {
        sensor.model = modelOf(pir);
        if (!worlds) worlds.emplace(room.environment).prepareMesh(Surfaces::Solid);
        return castPir(worlds->mesh(Surfaces::Solid), MovingBodies(bodies), velocities, sensor,
                       sensor.pose, frame, seed);
    }
    bool sees(Point2 at, Vec2 velocity) {
        bodies.clear();
        velocities = {};
        addPerson(at, velocity);
        return detect().motion;
    }

    std::optional<RayScenes> worlds;
};

TEST_F(PirTest, SeesPeopleWhoMoveInAnyDirection) {
    EXPECT_FALSE(detect().motion);
    EXPECT_TRUE(sees({3, 0}, {0, 1}));
    EXPECT_TRUE(sees({3, 0}, {-0.1, 0}));
    EXPECT_FALSE(sees({3, 0}, {0.09, 0}));
    EXPECT_FALSE(sees({3, 0}, {}));
    pir.min_speed = 0;
    EXPECT_FALSE(sees({3, 0}, {})) << "at rest";
    EXPECT_EQ(detect().held, 0);
    EXPECT_TRUE(sees({3, 0}, {0, 1e-3}));
    EXPECT_EQ(detect().held, 2);
}

TEST_F(PirTest, SeesWithinRangeAndFieldOfView) {
    EXPECT_TRUE(sees({6.9, 0}, {0, 1}));
    EXPECT_FALSE(sees({7.5, 0}, {0, 1}));
    EXPECT_FALSE(sees({-3, 0}, {0, 1}));
    pir.min_range = 3;
    EXPECT_FALSE(sees({2, 0}, {0, 1}));
    pir = Pir();
    pir.fov_y = Angle::degrees(4);
    sensor.pose.position.z = 2.5;
    EXPECT_FALSE(sees({3, 0}, {0, 1})) << "above the head";
}

TEST_F(PirTest, IgnoresRobotsButLooksNotThroughThem) {
    addRobot({2, 0}, {0, 1}, 2);
    EXPECT_FALSE(detect().motion);
    addPerson({4, 0}, {0, 1});
    EXPECT_FALSE(detect().motion) << "behind the robot";
    addPerson({4, 2}, {0, 1});
    EXPECT_TRUE(detect().motion);
}

TEST_F(PirTest, GlassAndWallsStopIt) {
    room = testing::scene("ispace size=40,40\nwall id=w from=2,-3 to=2,3 height=3\n");
    EXPECT_FALSE(sees({4, 0}, {0, 1}));
    worlds.reset();
    room = testing::scene(
        "ispace size=40,40\nwall id=w from=2,-3 to=2,3 height=3\n"
        "window wall=w at=2,1 size=2,1.5\n");
    EXPECT_FALSE(sees({4, 0}, {0, 1}));
}

TEST_F(PirTest, NoiseLosesDetectionsAndRaisesAlarms) {
    pir.dropout = 0.3;
    addPerson({3, 0}, {0, 1});
    int seen = 0;
    constexpr int kFrames = 4000;
    for (int frame = 0; frame < kFrames; ++frame) {
        EXPECT_TRUE(detect({}, frame).motion);
        seen += detect(5, frame).motion ? 1 : 0;
    }
    // Five standard deviations of a binomial distribution.
    EXPECT_NEAR(seen, 0.7 * kFrames, 5 * 29);
    bodies.clear();
    velocities = {};
    pir.false_alarms = 3600;  // one in ten readings
    int alarms = 0;
    for (int frame = 0; frame < kFrames; ++frame) alarms += detect(5, frame).motion ? 1 : 0;
    EXPECT_NEAR(alarms, 0.1 * kFrames, 5 * 19);
}

TEST(PirState, HoldsItsOutput) {
    const PirState on{.motion = true, .held = 0.5};
    const auto after = [&](double seconds, const PirState& measured = {}) {
        AddedReading before{.time = 1, .pose = {}, .kind = &Pir::kKind, .value = on};
        AddedReading now{.time = 1 + seconds, .pose = {}, .kind = &Pir::kKind, .value = measured};
        follow(before, now);
        return now.as<PirState>();
    };
    EXPECT_TRUE(after(0.4).motion);
    EXPECT_NEAR(after(0.4).held, 0.1, 1e-12);
    EXPECT_FALSE(after(0.5).motion) << "the end is off";
    EXPECT_FALSE(after(-0.5).motion) << "of an earlier run";
    EXPECT_EQ(after(0.2, on).held, 0.5) << "a detection starts the time anew";
}

TEST(PirState, HasATopic) {
    const auto topics = readingKind(modelOf(Pir())).topics;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].name, "motion");
    EXPECT_EQ(topics[0].type, RosType::Bool);
}

TEST_F(PirTest, FormatsHoldItsOutput) {
    Sensors sensors;
    sensors.read.push_back(sensor);
    const AddedReading state{.time = 0.5,
                             .frame = 5,
                             .pose = sensor.pose,
                             .kind = &Pir::kKind,
                             .value = PirState{.motion = true}};
    const auto written = [&](const std::string& format) {
        const auto writer = makeFormat(format, sensors, {});
        std::string bytes, appended;
        writer->append(appended, 0, state);
        const auto file = writer->stream([&](std::string_view piece) { bytes += piece; });
        file->write(appended);
        file->finish();
        return bytes;
    };
    EXPECT_NE(written("jsonl").find("\"motion\":true}"), std::string::npos) << written("jsonl");
    EXPECT_EQ(written("csv"), "sensor,frame,t,motion\ns1,5,0.5,1\n");
    EXPECT_NE(written("npz").find("s1/motion.npy"), std::string::npos);
}

}  // namespace pir_state_test
}  // namespace ispace::pirs
