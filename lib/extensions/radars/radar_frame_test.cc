// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/radars/radar_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "extensions/radars/radars_test.h"
#include "support/test_readings.h"

namespace ispace::radars {
namespace radar_frame_test {

constexpr double kHeight = 0.22, kMiddle = kHeight / 2;

/// A room of 40 by 40 m with a radar, and round robots of radius 0.3.
class RadarTest : public ::testing::Test {
  protected:
    Scene room = testing::scene("ispace size=40,40\n");
    Radar radar;
    Sensor sensor{"w1", modelOf(Radar()), {{0, 0, kMiddle}, {}, {}, {}}};
    std::vector<MovingBody> bodies;
    MoverVelocities velocities;

    void addRobot(Point2 at, Vec2 velocity, double turn = 0, double radius = 0.3) {
        RobotModel model;
        model.radius = radius;
        model.height = kHeight;
        bodies.push_back(robotBody(model, {at, {}}, static_cast<std::uint32_t>(bodies.size())));
        velocities.robots.push_back({at, velocity, turn});
    }

    std::vector<Detection> detect(std::optional<std::uint64_t> seed = {}, int frame = 0) {
        sensor.model = modelOf(radar);
        if (!worlds) worlds.emplace(room.environment).prepareMesh(Surfaces::Solid);
        return castRadar(worlds->mesh(Surfaces::Solid), MovingBodies(bodies), velocities, sensor,
                         sensor.pose, frame, seed)
            .detections;
    }

    std::optional<RayScenes> worlds;
};

TEST_F(RadarTest, MeasuresRangeBearingAndRadialSpeed) {
    radar.max_range = 20;
    const struct {
        Point2 at;
        Vec2 velocity;
    } cases[] = {{{3, 0}, {-0.5, 0}}, {{3, 4}, {0.6, 0.3}}, {{6, -8}, {0.2, 0.9}}};
    for (const auto& [at, velocity] : cases) {
        bodies.clear();
        velocities = {};
        addRobot(at, velocity);
        const std::vector<Detection> seen = detect();
        ASSERT_EQ(seen.size(), 1U);
        const double distance = std::hypot(at.x, at.y);
        EXPECT_NEAR(seen[0].range, distance - 0.3, 1e-12);
        EXPECT_NEAR(seen[0].bearing.radians(), std::atan2(at.y, at.x), 1e-12);
        EXPECT_NEAR(seen[0].elevation.radians(), 0, 1e-12);
        EXPECT_NEAR(seen[0].speed, (velocity.x * at.x + velocity.y * at.y) / distance, 1e-12);
    }
}

TEST_F(RadarTest, MeasuresInItsOwnFrame) {
    addRobot({1, 4}, {0, 1});
    sensor.pose = {{1, 1, kMiddle + 3}, Angle::degrees(90), Angle::degrees(-30), {}};
    const std::vector<Detection> seen = detect();
    ASSERT_EQ(seen.size(), 1U);
    // 3 m ahead and 3 m below: 45 degrees down, of which the tilt is 30.
    EXPECT_NEAR(seen[0].elevation.degrees(), -15, 1e-9);
    EXPECT_NEAR(seen[0].bearing.degrees(), 0, 1e-9);
    // It meets the top, half a height above the middle.
    EXPECT_NEAR(seen[0].range, (3 - kMiddle) * std::sqrt(2), 1e-9);
    EXPECT_NEAR(seen[0].speed, std::sqrt(0.5), 1e-12);
}

TEST_F(RadarTest, TheFieldOfViewAndTheRangesIncludeTheirEnds) {
    const auto count_at = [&](double degrees, double distance) {
        bodies.clear();
        velocities = {};
        const Vec2 along = unitVector(Angle::degrees(degrees));
        addRobot(Point2{} + distance * along, along);
        return detect().size();
    };
    radar.min_range = 0.7;
    EXPECT_EQ(count_at(60, 5), 1U);
    EXPECT_EQ(count_at(-60, 5), 1U);
    EXPECT_EQ(count_at(60.1, 5), 0U);
    EXPECT_EQ(count_at(180, 5), 0U);
    EXPECT_EQ(count_at(0, 9.3), 1U);
    EXPECT_EQ(count_at(0, 9.301), 0U);
    EXPECT_EQ(count_at(0, 1), 1U);
    EXPECT_EQ(count_at(0, 0.999), 0U);
    sensor.pose.tilt = Angle::degrees(30);
    EXPECT_EQ(count_at(0, 5), 1U);
    sensor.pose.tilt = Angle::degrees(30.1);
    EXPECT_EQ(count_at(0, 5), 0U);
}

TEST_F(RadarTest, ReportsNeitherTheRoomNorMoversThatStandOrCrossItsView) {
    addRobot({3, 0}, {});
    addRobot({3, 0.5}, {-0.5, 3});  // tangential
    addRobot({5, -0.9}, {0.099, 0}, 0, 0.1);
    EXPECT_TRUE(detect().empty());
    radar.min_speed = 0.05;
    EXPECT_EQ(detect().size(), 1U);
}

TEST_F(RadarTest, WallsAndOtherMoversHideAMover) {
    addRobot({5, 0}, {-1, 0});
    EXPECT_EQ(detect().size(), 1U);
    addRobot({3, 0.25}, {});  // at rest, before it
    EXPECT_TRUE(detect().empty());
    sensor.mount = Mount{1, {}};  // of its carrier, which it does not detect either
    velocities.robots[1].linear = {1, 0};
    EXPECT_EQ(detect().size(), 1U);
    room = testing::scene("ispace size=40,40\nwall from=2,-1 to=2,1\n");
    worlds.reset();
    EXPECT_TRUE(detect().empty());
}

TEST_F(RadarTest, SeesNoMoverFromInsideIt) {
    addRobot({0.1, 0}, {1, 0});
    addRobot({3, 0}, {1, 0});
    EXPECT_TRUE(detect().empty());
}

TEST_F(RadarTest, OfAPersonItDetectsTheNearestBodyInView) {
    const Pose2 person{{4, 0}, Angle::degrees(180)};
    bodies = humanBodies(1.7, person, kFirstPerson, Angle::degrees(10));
    velocities.people.push_back({person.position, {-1.2, 0}, 0});
    const std::vector<Detection> seen = detect();
    ASSERT_EQ(seen.size(), 1U);
    double nearest = 1e9;
    for (const MovingBody& body : bodies) {
        const Point3 middle{body.pose.position.x, body.pose.position.y, body.middle()};
        const Vec3 way = middle - sensor.pose.position;
        if (std::fabs(std::atan2(way.z, std::hypot(way.x, way.y))) > Angle::degrees(30).radians())
            continue;
        nearest = std::min(nearest, body.meet(sensor.pose.position, (1 / length(way)) * way));
    }
    EXPECT_NEAR(seen[0].range, nearest, 1e-12);
    EXPECT_LT(seen[0].speed, -1);
}

TEST_F(RadarTest, ATurningBodyMovesAtItsSurface) {
    RobotModel model;
    model.length = 0.6;
    model.width = 0.4;
    model.center = 0.5;
    model.height = kHeight;
    // Its middle turns about the centre at (3, -0.5): towards the radar at 0.5 m times 2 /s.
    bodies.push_back(robotBody(model, {{3, -0.5}, Angle::degrees(90)}, 0));
    velocities.robots.push_back({{3, -0.5}, {}, 2});
    const std::vector<Detection> seen = detect();
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_NEAR(seen[0].range, 3 - 0.2, 1e-12);
    EXPECT_NEAR(seen[0].speed, -1, 1e-12);
}

TEST_F(RadarTest, MoversItCannotTellApartAreOneDetection) {
    addRobot({5, 0.4}, {-1, 0});
    addRobot({5.1, -0.4}, {-1.05, 0});
    EXPECT_EQ(detect().size(), 2U);
    radar.noise.resolution = 0.2;
    radar.angle_resolution = Angle::degrees(15);
    radar.speed_resolution = 0.1;
    ASSERT_EQ(detect().size(), 1U);
    EXPECT_GT(detect()[0].bearing.degrees(), 0);  // the nearer one
    radar.angle_resolution = Angle::degrees(8);
    EXPECT_EQ(detect().size(), 2U);
    radar.angle_resolution = Angle::degrees(15);
    velocities.robots[1].linear = {-1.2, 0};
    EXPECT_EQ(detect().size(), 2U);
}

TEST_F(RadarTest, KeepsTheNearestOfTooMany) {
    for (const double x : {6.0, 2.0, 8.0, 4.0}) addRobot({x, x - 5}, {1, 0});
    radar.detections = 3;
    const std::vector<Detection> seen = detect();
    ASSERT_EQ(seen.size(), 3U);
    EXPECT_NEAR(seen[0].range, std::hypot(2, 3) - 0.3, 1e-12);
    EXPECT_NEAR(seen[1].range, std::hypot(4, 1) - 0.3, 1e-12);
    EXPECT_NEAR(seen[2].range, std::hypot(6, 1) - 0.3, 1e-12);
}

TEST_F(RadarTest, SpeedsAreKnownModuloTwiceTheMaximum) {
    addRobot({5, 0}, {2.5, 0});
    radar.max_speed = 2;
    EXPECT_NEAR(detect()[0].speed, -1.5, 1e-12);
    velocities.robots[0].linear = {-1.5, 0};
    EXPECT_NEAR(detect()[0].speed, -1.5, 1e-12);
    velocities.robots[0].linear = {2, 0};
    EXPECT_NEAR(detect()[0].speed, -2, 1e-12);
}

TEST_F(RadarTest, NoiseHasTheGivenSpreads) {
    addRobot({5, 0}, {1, 0});
    radar.noise.bias = 0.1;
    radar.noise.sigma = {0.02, 0, 0};
    radar.noise.angle_sigma = Angle::degrees(1.5);
    radar.noise.dropout = 0.25;
    radar.speed_sigma = 0.05;
    constexpr int kFrames = 4000;
    int count = 0;
    double range = 0, range2 = 0, bearing2 = 0, elevation2 = 0, speed2 = 0;
    for (int frame = 0; frame < kFrames; ++frame)
        for (const Detection& one : detect(7, frame)) {
            ++count;
            range += one.range - 4.7;
            range2 += std::pow(one.range - 4.8, 2);
            bearing2 += std::pow(one.bearing.degrees(), 2);
            elevation2 += std::pow(one.elevation.degrees(), 2);
            speed2 += std::pow(one.speed - 1, 2);
        }
    EXPECT_NEAR(count, 0.75 * kFrames, 0.03 * kFrames);
    EXPECT_NEAR(range / count, 0.1, 0.002);
    EXPECT_NEAR(std::sqrt(range2 / count), 0.02, 0.001);
    EXPECT_NEAR(std::sqrt(bearing2 / count), 1.5, 0.08);
    EXPECT_NEAR(std::sqrt(elevation2 / count), 1.5, 0.08);
    EXPECT_NEAR(std::sqrt(speed2 / count), 0.05, 0.003);
}

TEST_F(RadarTest, NoiseOfAMoverDoesNotDependOnOthers) {
    addRobot({5, 1}, {1, 0});
    radar.noise.sigma = {0.02, 0, 0};
    radar.speed_sigma = 0.05;
    radar.speed_resolution = 0.125;
    const Detection alone = detect(3).at(0);
    EXPECT_EQ(std::fmod(alone.speed, 0.125), 0);
    addRobot({3, -1}, {1, 0});
    const std::vector<Detection> both = detect(3);
    ASSERT_EQ(both.size(), 2U);
    EXPECT_EQ(both[1].range, alone.range);
    EXPECT_EQ(both[1].speed, alone.speed);
    EXPECT_NE(detect(4)[1].range, alone.range);
}

}  // namespace radar_frame_test
}  // namespace ispace::radars
