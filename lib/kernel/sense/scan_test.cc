// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/scan.h"
#include "support/test_readings.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "base/number.h"
#include "support/test_layout.h"

namespace ispace {

namespace scan_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::string kRoom = "ispace at=4,3 size=8,6,2.5\n";

Sensor placed(Laser laser, Pose3 pose) { return {"l", std::move(laser), pose}; }

Laser laserWithRange(double min_range, double max_range) {
    Laser laser;
    laser.min_range = min_range;
    laser.max_range = max_range;
    return laser;
}

/// One beam at this bearing.
float beam(const Scene& scene, const Pose3& pose, double bearing, double max_range = 100) {
    Laser laser = laserWithRange(0, max_range);
    laser.first = Angle::degrees(bearing);
    laser.beams = 1;
    return testing::scan(scene, placed(laser, pose)).ranges.front();
}

Pose3 at(double x, double y, double z, double heading = 0, double tilt = 0, double roll = 0) {
    return {{x, y, z}, Angle::degrees(heading), Angle::degrees(tilt), Angle::degrees(roll)};
}

TEST(Scan, BeamsRunCounterClockwiseFromFirst) {
    const Scene scene = testing::scene(kRoom);
    const Scan scan = testing::scan(scene, placed(laserWithRange(0, 100), at(3, 2, 0.15)));
    ASSERT_EQ(scan.ranges.size(), 181U);
    EXPECT_EQ(scan.ranges[0], 2);    // -y
    EXPECT_EQ(scan.ranges[90], 5);   // +x
    EXPECT_EQ(scan.ranges[180], 4);  // +y
    EXPECT_NEAR(scan.ranges[45], 2 * std::sqrt(2.0), 1e-6);
}

TEST(Scan, AlongAWall) {
    const Scene scene = testing::scene(kRoom);
    // On the wall y = 0, along it both ways, level and (into floor and end wall) tilted.
    EXPECT_EQ(beam(scene, at(2, 0, 0.15), 0), 6);
    EXPECT_EQ(beam(scene, at(2, 0, 0.15), 180), 2);
    EXPECT_NEAR(beam(scene, at(2, 0, 1, 0, -30), 0), 2, 1e-6);
    EXPECT_NEAR(beam(scene, at(2, 0, 1, 0, 5), 0), 6 / std::cos(std::numbers::pi / 36), 1e-6);
    // A hair in front of it.
    EXPECT_EQ(beam(scene, at(2, 0.001, 0.15), 0), 6);
}

TEST(Scan, ThroughACornerOfTwoWalls) {
    const Scene scene = testing::scene(kRoom);
    EXPECT_EQ(beam(scene, at(4, 3, 0.15), Angle::radians(std::atan2(3, 4)).degrees()), 5);
    EXPECT_NEAR(beam(scene, at(2, 2, 0.15), -135), 2 * std::sqrt(2.0), 1e-6);
    // Tilted, into the corner of two walls and the floor.
    const double flat = std::hypot(2, 2), down = 0.7;
    const Pose3 pose = at(2, 2, down, -135, -std::atan2(down, flat) * 180 / std::numbers::pi);
    EXPECT_NEAR(beam(scene, pose, 0), std::hypot(flat, down), 1e-4);
}

TEST(Scan, FromAWall) {
    const Scene scene = testing::scene(kRoom);
    EXPECT_EQ(beam(scene, at(2, 0, 0.15), 90), 6);
    EXPECT_TRUE(std::isinf(beam(scene, at(2, 0, 0.15), -90)));
    EXPECT_EQ(beam(scene, at(8, 2, 0.15, 180), 0), 8);
    EXPECT_NEAR(beam(scene, at(2, 0, 1, 90, -45), 0), std::sqrt(2.0), 1e-6);
    // From the floor, and from a corner.
    EXPECT_NEAR(beam(scene, at(2, 2, 0, 0, 10), 0), 6 / std::cos(std::numbers::pi / 18), 1e-6);
    EXPECT_EQ(beam(scene, at(0, 0, 0.15), 0), 8);
    EXPECT_EQ(beam(scene, at(0, 0, 0.15), 90), 6);
}

TEST(Scan, NoReturn) {
    const Scene scene = testing::scene(kRoom);
    EXPECT_TRUE(std::isinf(beam(scene, at(2, 3, 0.15), 0, 5)));
    EXPECT_TRUE(std::isinf(beam(scene, at(2, 3, 1, 0, 60), 0)));  // over the walls
    EXPECT_TRUE(std::isinf(beam(scene, at(2, 3, 2.6), 0)));       // above them
    EXPECT_EQ(beam(scene, at(2, 3, 2.5), 0), 6);                  // their top counts
    EXPECT_TRUE(std::isinf(beam(scene, at(-2, 3, 0.15), 180)));   // outside
    EXPECT_EQ(beam(scene, at(-2, 3, 0.15), 0), 2);                // from outside
}

TEST(Scan, ExactlyMaximumRange) {
    const Scene scene = testing::scene(kRoom);
    EXPECT_EQ(beam(scene, at(3, 3, 0.15), 0, 5), 5);
    EXPECT_TRUE(std::isinf(beam(scene, at(3, 3, 0.15), 0, 4.9999)));
    EXPECT_EQ(beam(scene, at(8 - 4.095, 3, 0.15), 0, 4.095), 4.095F);
}

TEST(Scan, BlindZone) {
    const Scene scene = testing::scene(kRoom);
    const Sensor sensor = placed(laserWithRange(0.5, 5), at(7.5, 3, 0.15));
    RayScenes worlds(scene.environment);
    worlds.prepare(sensor.pose);
    const RayWorld& world = worlds.at(sensor.pose);
    EXPECT_EQ(testing::scan(scene, sensor).ranges[90], 0.5F);  // exactly at its edge
    const Sensor near = placed(laserWithRange(0.5, 5), at(7.6, 3, 0.15));
    EXPECT_TRUE(std::isinf(testing::scan(scene, near).ranges[90]));
    EXPECT_NEAR(castBeams(world, near)[90], 0.4, 1e-6);
    // A return within the blind zone still hides the surfaces behind it.
    EXPECT_FALSE(std::isinf(testing::scan(scene, near).ranges[160]));
}

TEST(Scan, TwoHeightsMeetDifferentThings) {
    const Scene scene =
        testing::scene(kRoom + "cube at=6,3 size=1,1,0.5\ntable at=2,3 size=1,1 height=0.7\n");
    EXPECT_EQ(beam(scene, at(4, 3, 0.15), 0), 1.5F);
    EXPECT_EQ(beam(scene, at(4, 3, 0.5), 0), 1.5F);
    EXPECT_EQ(beam(scene, at(4, 3, 0.51), 0), 4);
    EXPECT_NEAR(beam(scene, at(6, 3, 1.5, 0, -90), 0), 1, 1e-6);  // onto the cube from above
    EXPECT_NEAR(beam(scene, at(2, 3, 1.5, 0, -90), 0), 0.8, 1e-6);
}

/// The room of a property test and what a ray in it meets, by formula.
struct Box {
    Pose2 pose;
    double length, width, height;
    bool ceiling;

    [[nodiscard]] std::string record() const {
        return "ispace at=" + formatDouble(pose.position.x) + ',' + formatDouble(pose.position.y) +
               " heading=" + formatDouble(pose.heading.degrees()) +
               " size=" + formatDouble(length) + ',' + formatDouble(width) + ',' +
               formatDouble(height) + (ceiling ? " ceiling=yes\n" : "\n");
    }
    /// Infinite if it leaves through a missing ceiling; `is_close` if rounding decides.
    [[nodiscard]] double range(Point3 local, Vec3 direction, bool& is_close) const {
        const auto wall = [](double from, double way, double half) {
            return way == 0 ? kInfinity : ((way > 0 ? half : -half) - from) / way;
        };
        const double sides =
            std::min(wall(local.x, direction.x, length / 2), wall(local.y, direction.y, width / 2));
        const double end = ((direction.z > 0 ? height : 0.0) - local.z) / direction.z;
        const bool up = direction.z > 0;
        is_close = up && !ceiling && std::fabs(local.z + sides * direction.z - height) < 1e-4;
        if (direction.z == 0) return sides;
        if (up && !ceiling && end < sides) return kInfinity;
        return std::min(sides, end);
    }
    [[nodiscard]] Vec3 toLocal(Vec3 direction) const {
        const Pose2 turned{{}, -pose.heading};
        const Vec2 flat = turned * Vec2{direction.x, direction.y};
        return {flat.x, flat.y, direction.z};
    }
};

class Rooms : public ::testing::Test {
  protected:
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    double magnitude(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    Box room(double largest) {
        return {{{uniform(-50, 50), uniform(-50, 50)}, Angle::degrees(uniform(-180, 180))},
                magnitude(1, largest),
                magnitude(1, largest),
                magnitude(1, 20),
                uniform(0, 1) < 0.5};
    }
    /// A place strictly inside the room, in its frame, and the pose there in the world.
    Pose3 anywhere(const Box& box, Point3& local, bool level) {
        local = {uniform(-0.49, 0.49) * box.length, uniform(-0.49, 0.49) * box.width,
                 uniform(0.01, 0.99) * box.height};
        const Point2 place = box.pose * local.onFloor();
        Pose3 pose = at(place.x, place.y, local.z, uniform(-360, 360));
        if (!level) {
            pose.tilt = Angle::degrees(uniform(-90, 90));
            pose.roll = Angle::degrees(uniform(-180, 180));
        }
        return pose;
    }
    std::mt19937_64 random_{20250601};
};

Laser fullTurn() {
    Laser laser = laserWithRange(0, 1e4);
    laser.first = Angle::degrees(-180);
    laser.beams = 361;
    return laser;
}

TEST_F(Rooms, RectangularAtAnyPoseWithinAMillimetre) {
    int met = 0, left = 0;
    for (int i = 0; i < 120; ++i) {
        const Box box = room(100);
        const Scene scene =
            testing::scene(box.record() + "inside at=" + formatDouble(box.pose.position.x) + ',' +
                           formatDouble(box.pose.position.y) + "\n");
        Point3 local;
        const Sensor sensor = placed(fullTurn(), anywhere(box, local, i % 3 == 0));
        const Scan scan = testing::scan(scene, sensor);
        for (int k = 0; k < sensor.as<Laser>().beams; ++k) {
            const Vec3 direction = box.toLocal(sensor.pose.beam(sensor.as<Laser>().bearing(k)));
            bool is_close = false;
            const double exact = box.range(local, direction, is_close);
            const double found = scan.ranges[static_cast<std::size_t>(k)];
            if (is_close) continue;
            if (std::isinf(exact)) {
                EXPECT_TRUE(std::isinf(found)) << box.record() << k;
                ++left;
            } else {
                EXPECT_NEAR(found, exact, 1e-3) << box.record() << k;
                ++met;
            }
        }
    }
    EXPECT_GT(met, 20000);
    EXPECT_GT(left, 2000);
}

TEST_F(Rooms, FarFromTheOriginWithinAMillimetre) {
    for (int i = 0; i < 20; ++i) {
        Box box = room(20);
        box.pose.position = {1e5 + uniform(0, 1), -1e5 + uniform(0, 1)};
        const Scene scene = testing::scene(box.record());
        Point3 local;
        const Sensor sensor = placed(fullTurn(), anywhere(box, local, i % 2 == 0));
        const Scan scan = testing::scan(scene, sensor);
        for (int k = 0; k < sensor.as<Laser>().beams; ++k) {
            const Vec3 direction = box.toLocal(sensor.pose.beam(sensor.as<Laser>().bearing(k)));
            bool is_close = false;
            const double exact = box.range(local, direction, is_close);
            const double found = scan.ranges[static_cast<std::size_t>(k)];
            if (is_close || std::isinf(exact)) continue;
            EXPECT_NEAR(found, exact, 1e-3);
        }
    }
}

/// Entry into an upright cylinder about the origin; infinite if the ray misses it.
double cylinderRange(Point3 from, Vec3 direction, double radius, double height) {
    double enter = -kInfinity, leave = kInfinity;
    const auto clip = [&](double near, double far) {
        enter = std::max(enter, std::min(near, far));
        leave = std::min(leave, std::max(near, far));
    };
    const double a = direction.x * direction.x + direction.y * direction.y;
    const double b = from.x * direction.x + from.y * direction.y;
    const double c = from.x * from.x + from.y * from.y - radius * radius;
    const double root = b * b - a * c;
    if (root < 0 || (a == 0 && c > 0)) return kInfinity;
    if (a > 0) clip((-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a);
    if (direction.z != 0) clip(-from.z / direction.z, (height - from.z) / direction.z);
    if (direction.z == 0 && (from.z < 0 || from.z > height)) return kInfinity;
    if (enter > leave || enter <= 0) return kInfinity;
    return enter;
}

TEST_F(Rooms, AroundCylinders) {
    constexpr double kMargin = 1e-6;
    int on_cylinder = 0;
    for (int i = 0; i < 300; ++i) {
        Box box{{}, 12, 10, 3, true};
        const double radius = magnitude(0.02, 3), height = i % 2 == 0 ? 3.0 : uniform(0.3, 2.9);
        std::string lines = box.record();
        lines += "inside at=5.5,4.5\n";
        lines += i % 4 == 0 ? "pillar kind=round size=" : "cylinder size=";
        for (const double extent : {2 * radius, 2 * radius}) lines += formatDouble(extent) + ',';
        lines += formatDouble(height) + '\n';
        const Scene scene = testing::scene(lines);
        Point3 local;
        Pose3 pose;
        do pose = anywhere(box, local, i % 3 == 0);
        while (std::hypot(local.x, local.y) < radius + 0.05);
        const Sensor sensor = placed(fullTurn(), pose);
        const Scan scan = testing::scan(scene, sensor);
        for (int k = 0; k < sensor.as<Laser>().beams; ++k) {
            const Vec3 direction = pose.beam(sensor.as<Laser>().bearing(k));
            bool is_close = false;
            const double walls = box.range(local, direction, is_close);
            const double exact = cylinderRange(local, direction, radius, height);
            const double outer =
                cylinderRange(local, direction, radius + kMargin, height + kMargin);
            const double inner =
                cylinderRange(local, direction, radius - kMargin, height - kMargin);
            const double found = scan.ranges[static_cast<std::size_t>(k)];
            const double error = kMargin + 1e-7 * found;  // and what float32 rounds
            // A beam that misses the cylinder by a micrometre misses it, and none passes that hits
            // it by as much, be it next to a tangent.
            EXPECT_GE(found, std::min(walls, outer) - error) << i << ' ' << k;
            EXPECT_LE(found, std::min(walls, inner) + error) << i << ' ' << k;
            if (std::isinf(exact) || std::isinf(inner) || exact > walls) continue;
            EXPECT_NEAR(found, exact, error) << i << ' ' << k;
            ++on_cylinder;
        }
    }
    EXPECT_GT(on_cylinder, 1000);
}

TEST(Scan, LimitsHoldBeforeNoise) {
    // A wall 2 m ahead, through which noise of 5 cm must make or lose no return.
    const auto returns = [](const std::string& range) {
        const Scene scene =
            testing::scene(kRoom, "laser at=6,3 first=0 beams=1 sigma=0.05 range=" + range + "\n");
        std::size_t count = 0;
        for (int frame = 0; frame < 500; ++frame) {
            const auto reading = testing::readings(scene, {.noise_seed = 4}, frame);
            const float found = std::get<std::vector<Scan>>(reading.at(0)).at(0).ranges.at(0);
            if (!std::isfinite(found)) continue;
            ++count;
            EXPECT_GE(found, static_cast<float>(scene.sensors[0].as<Laser>().min_range));
            EXPECT_LE(found, static_cast<float>(scene.sensors[0].as<Laser>().max_range));
        }
        return count;
    };
    EXPECT_EQ(returns("2.01,9"), 0U);
    EXPECT_EQ(returns("1.99,9"), 500U);
    EXPECT_EQ(returns("0.1,1.99"), 0U);
    EXPECT_EQ(returns("0.1,2.01"), 500U);
    EXPECT_EQ(returns("2,2"), 500U);
}

TEST(SliceArea, HalfDiscInTheOpen) {
    // All 181 beams return nothing: 181 slices of one degree, as printed in the thesis.
    const std::vector<float> none(181, std::numeric_limits<float>::infinity());
    EXPECT_NEAR(sliceArea(Laser(), none), 181 * std::numbers::pi * 25 / 360, 1e-12);
    Laser fine;
    fine.step = Angle::degrees(0.01);
    fine.beams = 18001;
    const std::vector<float> many(18001, std::numeric_limits<float>::infinity());
    EXPECT_NEAR(sliceArea(fine, many), std::numbers::pi * 12.5, 0.01);
}

TEST(SliceArea, ReturnsCountByTheirSquare) {
    const Laser laser;
    std::vector<float> ranges(181, 2.0F);
    EXPECT_NEAR(sliceArea(laser, ranges), 181 * std::numbers::pi * 4 / 360, 1e-12);
    ranges.front() = std::numeric_limits<float>::infinity();
    EXPECT_NEAR(sliceArea(laser, ranges), (180 * 4 + 25) * std::numbers::pi / 360, 1e-12);
    EXPECT_EQ(sliceArea(laser, {}), 0);
}

}  // namespace scan_test

}  // namespace ispace
