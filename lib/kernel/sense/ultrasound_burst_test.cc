// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/ultrasound_burst.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/test_layout.h"

namespace ispace {
namespace ultrasound_burst_test {

constexpr Angle kStraightDown = Angle::degrees(-90);

/// A room of 8 by 6 m with its corner at the origin, and what else stands in it.
RayWorld room(const std::string& lines = "") {
    return RayWorld::ofEnvironment(
        testing::scene("ispace at=4,3 size=8,6,2.5\n" + lines).environment);
}

Sensor receiverAt(const std::string& id, Point3 place, Angle tilt = kStraightDown,
                  Angle heading = {}) {
    return {id, Receiver(), {place, heading, tilt, {}}};
}

/// Rows of receivers below the ceiling, 1 m apart, u0, u1, ...
std::vector<Sensor> ceiling(double sigma = 0) {
    std::vector<Sensor> receivers;
    for (int i = 0; i < 12; ++i) {
        receivers.push_back(
            receiverAt("u" + std::to_string(i), {2.0 + i % 4, 2.0 + i / 4, 2.4}));  // NOLINT: floor
        receivers.back().as<Receiver>().noise.sigma = {sigma, 0, 0};
    }
    return receivers;
}

Sensor tagAt(Point3 place) { return {"t1", Tag(), {place, {}, {}, {}}}; }

std::vector<std::size_t> namesOf(const Burst& burst) {
    std::vector<std::size_t> names;
    names.reserve(burst.heard.size());
    for (const TimeOfFlight& flight : burst.heard) names.push_back(flight.receiver);
    return names;
}

Burst burstOf(const RayWorld& world, const Sensor& tag, const std::vector<Sensor>& receivers,
              const UltrasoundOptions& options = {}, int frame = 0) {
    return castBurst(world, MovingBodies(), tag, receivers, frame, 0, options);
}

bool hears(const RayWorld& world, const Sensor& receiver, const Sensor& tag,
           const MovingBodies& bodies = {}) {
    return !castBurst(world, bodies, tag, std::span(&receiver, 1), 0, 0, {}).heard.empty();
}

TEST(SpeedOfSound, RisesWithTheTemperature) {
    EXPECT_DOUBLE_EQ(speedOfSound(0), 331.3);
    EXPECT_DOUBLE_EQ(speedOfSound(20), 343.42);
}

TEST(Burst, TimesAndPlaceInClosedForm) {
    const RayWorld world = room();
    const Sensor tag = tagAt({3.2, 2.7, 0.9});
    const auto receivers = ceiling();
    for (const double celsius : {20.0, -5.0, 35.0}) {
        const Burst burst =
            castBurst(world, MovingBodies(), tag, receivers, 4, 0.4, {.celsius = celsius});
        EXPECT_EQ(burst.time, 0.4);
        EXPECT_EQ(burst.frame, 4);
        EXPECT_EQ(burst.pose, tag.pose);
        ASSERT_GE(burst.heard.size(), 8U);
        for (const TimeOfFlight& flight : burst.heard) {
            const double distance =
                length(tag.pose.position - receivers[flight.receiver].pose.position);
            EXPECT_DOUBLE_EQ(flight.distance, distance);
            EXPECT_DOUBLE_EQ(flight.time, distance / (331.3 + 0.606 * celsius));
        }
        ASSERT_TRUE(burst.fix);
        EXPECT_LT(length(burst.fix->position - tag.pose.position), 1e-9);
        EXPECT_FALSE(burst.simple);
    }
}

TEST(Burst, ANoiseFreeTagIsFoundAnywhereInTheRoom) {
    const RayWorld world = room();
    auto receivers = ceiling();
    for (Sensor& receiver : receivers) receiver.as<Receiver>().fov = Angle::degrees(178);
    int found = 0;
    for (int column = 0; column < 16; ++column) {
        for (int row = 0; row < 12; ++row) {
            const double x = 0.25 + 0.5 * column;
            const double y = 0.25 + 0.5 * row;
            for (const double z : {0.0, 0.15, 1.0, 2.3, 2.39}) {
                const Burst burst = burstOf(world, tagAt({x, y, z}), receivers);
                if (burst.heard.size() < kMinReceivers) continue;  // beside flat cones
                ASSERT_TRUE(burst.fix);
                ASSERT_LT(length(burst.fix->position - Point3{x, y, z}), 1e-3)
                    << x << ' ' << y << ' ' << z;
                ++found;
            }
        }
    }
    EXPECT_GT(found, 700);
}

TEST(Burst, RangesCountWithTheirEnds) {
    const RayWorld world = room();
    Sensor receiver = receiverAt("u", {4, 3, 2.4});
    receiver.as<Receiver>().min_range = 0.3;
    receiver.as<Receiver>().max_range = 2.1;
    EXPECT_TRUE(hears(world, receiver, tagAt({4, 3, 2.4 - 2.1})));
    EXPECT_FALSE(hears(world, receiver, tagAt({4, 3, 2.4 - 2.1001})));
    EXPECT_TRUE(hears(world, receiver, tagAt({4, 3, 2.4 - 0.3})));
    EXPECT_FALSE(hears(world, receiver, tagAt({4, 3, 2.4 - 0.2999})));
    // At the same place, if that is in range.
    EXPECT_FALSE(hears(world, receiver, tagAt({4, 3, 2.4})));
    receiver.as<Receiver>().min_range = 0;
    EXPECT_TRUE(hears(world, receiver, tagAt({4, 3, 2.4})));
}

TEST(Burst, ConesOfBothCount) {
    const RayWorld world = room();
    Sensor receiver = receiverAt("u", {4, 3, 2.4});
    receiver.as<Receiver>().fov = Angle::degrees(90);
    EXPECT_TRUE(hears(world, receiver, tagAt({5.99, 3, 0.4})));
    EXPECT_TRUE(hears(world, receiver, tagAt({6, 3, 0.4})));
    EXPECT_TRUE(hears(world, receiver, tagAt({4, 1, 0.4})));
    EXPECT_FALSE(hears(world, receiver, tagAt({6.01, 3, 0.4})));
    EXPECT_FALSE(hears(world, receiver, tagAt({4, 0.99, 0.4})));

    Sensor tag = tagAt({4, 3, 0.4});
    tag.as<Tag>().fov = Angle::degrees(60);
    EXPECT_FALSE(hears(world, receiver, tag));  // it emits along x
    tag.pose.tilt = Angle::degrees(90);
    EXPECT_TRUE(hears(world, receiver, tag));
    tag.pose.tilt = Angle::degrees(60.1);
    EXPECT_TRUE(hears(world, receiver, tag));
    tag.pose.tilt = Angle::degrees(59.9);
    EXPECT_FALSE(hears(world, receiver, tag));

    // All around is all around, also straight behind.
    receiver.as<Receiver>().fov = Angle::degrees(360);
    tag.as<Tag>().fov = Angle::degrees(360);
    receiver.pose.tilt = Angle::degrees(90);
    tag.pose.tilt = kStraightDown;
    EXPECT_TRUE(hears(world, receiver, tag));
    receiver.pose = {{1, 2, 0.4}, Angle::degrees(180 + 18.43494882292201), {}, {}};
    EXPECT_TRUE(hears(world, receiver, tag));
}

TEST(Burst, AWallSilencesWhatIsBehindIt) {
    // Between the second and third column of receivers, up to the ceiling.
    const RayWorld world = room("wall from=3.5,0 to=3.5,6 height=2.5\n");
    const auto receivers = ceiling();
    const Burst left = burstOf(world, tagAt({3, 3, 0.5}), receivers);
    EXPECT_EQ(namesOf(left), (std::vector<std::size_t>{0, 1, 4, 5, 8, 9}));
    const Burst right = burstOf(world, tagAt({4, 3, 0.5}), receivers);
    EXPECT_EQ(namesOf(right), (std::vector<std::size_t>{2, 3, 6, 7, 10, 11}));
    ASSERT_TRUE(right.fix);
    EXPECT_LT(length(right.fix->position - Point3{4, 3, 0.5}), 1e-6);
    // Over a low one some are heard still: the line of sight passes x = 3.5 at least 1 m up.
    const Burst over =
        burstOf(room("wall from=3.5,0 to=3.5,6 height=1\n"), tagAt({3, 3, 0.5}), receivers);
    EXPECT_EQ(namesOf(over), (std::vector<std::size_t>{0, 1, 2, 4, 5, 6, 8, 9, 10}));
}

TEST(Burst, ADeskSilencesWhatIsAboveIt) {
    const RayWorld world = room("desk at=3.5,3 size=1.2,0.8,0.7\n");
    const auto receivers = ceiling();
    // On the desk all is well, below it nothing is heard.
    EXPECT_TRUE(burstOf(world, tagAt({3.5, 3, 0.7}), receivers).fix);
    EXPECT_TRUE(burstOf(world, tagAt({3.5, 3, 0.69}), receivers).heard.empty());
    // Beside it those on the other side, low over its top, are not.
    const Burst beside = burstOf(world, tagAt({2.7, 3, 0.1}), receivers);
    EXPECT_FALSE(beside.heard.empty());
    EXPECT_LT(beside.heard.size(), burstOf(room(), tagAt({2.7, 3, 0.1}), receivers).heard.size());
}

TEST(Burst, FewerThanFourFixNothing) {
    const RayWorld world = room();
    auto receivers = ceiling();
    receivers.erase(receivers.begin() + 1, receivers.end() - 2);
    const Burst burst = burstOf(world, tagAt({3.5, 3, 0.5}), receivers);
    EXPECT_EQ(burst.heard.size(), 3U);
    EXPECT_FALSE(burst.fix);
    EXPECT_FALSE(burst.simple);
    EXPECT_FALSE(burstOf(world, tagAt({3.5, 3, 0.5}), {}).fix);
}

TEST(Burst, ReceiversOnAWallLookIntoTheRoom) {
    const RayWorld world = room();
    std::vector<Sensor> receivers;
    for (int i = 0; i < 6; ++i) {
        receivers.push_back(receiverAt("u" + std::to_string(i), {8, 2.0 + i % 3, i < 3 ? 1.0 : 2.0},
                                       {}, Angle::degrees(180)));
    }
    const Burst burst = burstOf(world, tagAt({5, 3.3, 0.4}), receivers);
    EXPECT_EQ(burst.heard.size(), 6U);
    ASSERT_TRUE(burst.fix);
    EXPECT_LT(length(burst.fix->position - Point3{5, 3.3, 0.4}), 1e-6);
}

TEST(Burst, BodiesAreInTheWayButThoseOfTheCarriers) {
    const RayWorld world = room();
    const auto cylinder = [](double x, std::uint32_t owner) {
        MovingBody body;
        body.pose.position = {x, 3};
        body.radius = 0.3;
        body.top = 1.7;
        body.owner = owner;
        return body;
    };
    Sensor receiver = receiverAt("u", {6, 3, 1}, {}, Angle::degrees(180));
    Sensor tag = tagAt({2, 3, 1});
    EXPECT_TRUE(hears(world, receiver, tag));
    const MovingBodies between({cylinder(4, 2)});
    EXPECT_FALSE(hears(world, receiver, tag, between));
    EXPECT_TRUE(hears(world, receiver, tagAt({2, 4, 1}), between));  // past it

    const MovingBodies carriers({cylinder(2, 0), cylinder(6, 1)});
    EXPECT_FALSE(hears(world, receiver, tag, carriers));
    tag.mount = Mount{0, {}};
    EXPECT_FALSE(hears(world, receiver, tag, carriers));
    receiver.mount = Mount{1, {}};
    EXPECT_TRUE(hears(world, receiver, tag, carriers));
    tag.mount.reset();
    EXPECT_FALSE(hears(world, receiver, tag, carriers));
    // Both on one robot; a third in between.
    tag.mount = Mount{1, {}};
    EXPECT_TRUE(hears(world, receiver, tag, MovingBodies({cylinder(2, 1), cylinder(6, 1)})));
    tag.mount = Mount{0, {}};
    EXPECT_FALSE(hears(world, receiver, tag,
                       MovingBodies({cylinder(2, 0), cylinder(6, 1), cylinder(4, 2)})));
    // Beyond either of them it is not in the way.
    EXPECT_TRUE(
        hears(world, receiver, tag,
              MovingBodies({cylinder(2, 0), cylinder(6, 1), cylinder(7, 2), cylinder(1, 2)})));
}

TEST(Burst, NoiseOfAPairIsItsOwn) {
    const RayWorld world = room();
    const Sensor tag = tagAt({3.2, 2.7, 0.9});
    const UltrasoundOptions options{.celsius = 20, .noise_seed = 5};
    const auto receivers = ceiling(0.01);
    const Burst all = burstOf(world, tag, receivers, options);
    const Burst exact = burstOf(world, tag, receivers);
    ASSERT_EQ(namesOf(all), namesOf(exact));
    // Alone, each receiver hears the same.
    for (const TimeOfFlight& flight : all.heard) {
        const Burst alone = burstOf(world, tag, {receivers[flight.receiver]}, options);
        ASSERT_EQ(alone.heard.size(), 1U);
        EXPECT_EQ(alone.heard[0].distance, flight.distance);
    }
    for (std::size_t i = 0; i < all.heard.size(); ++i) {
        EXPECT_NE(all.heard[i].distance, exact.heard[i].distance);
        EXPECT_DOUBLE_EQ(all.heard[i].time, all.heard[i].distance / 343.42);
    }
    const auto first_of = [&](const Sensor& some, int frame, std::uint64_t seed) {
        return castBurst(world, MovingBodies(), some, receivers, frame, 0,
                         {.celsius = 20, .noise_seed = seed})
            .heard[0]
            .distance;
    };
    EXPECT_EQ(first_of(tag, 0, 5), all.heard[0].distance);
    EXPECT_NE(first_of(tag, 1, 5), all.heard[0].distance);
    EXPECT_NE(first_of(tag, 0, 6), all.heard[0].distance);
    Sensor other = tag;
    other.id = "t2";
    EXPECT_NE(first_of(other, 0, 5), all.heard[0].distance);
}

TEST(Burst, NoiseIsThatOfTheReceiver) {
    const RayWorld world = room();
    const Sensor tag = tagAt({4, 3, 0.4});
    Sensor receiver = receiverAt("u", {4, 3, 2.4});
    receiver.as<Receiver>().noise.bias = 0.05;
    receiver.as<Receiver>().noise.sigma = {0.01, 0.005, 0};
    receiver.as<Receiver>().noise.dropout = 0.2;
    constexpr int kFrames = 20000;
    double sum = 0, squares = 0;
    int heard = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        const Burst burst = burstOf(world, tag, {receiver}, {.noise_seed = 3}, frame);
        if (burst.heard.empty()) continue;
        const double error = burst.heard[0].distance - 2;
        sum += error;
        squares += error * error;
        ++heard;
    }
    EXPECT_NEAR(heard, 0.8 * kFrames, 5 * std::sqrt(0.16 * kFrames));
    const double mean = sum / heard;
    EXPECT_NEAR(mean, 0.05, 5 * 0.02 / std::sqrt(heard));
    EXPECT_NEAR(std::sqrt(squares / heard - mean * mean), 0.02, 5 * 0.02 / std::sqrt(2.0 * heard));
    // Measured beyond its range it is at its end; what is out of range no noise brings back.
    receiver.as<Receiver>().noise = {};
    receiver.as<Receiver>().noise.bias = 0.05;
    receiver.as<Receiver>().max_range = 2.04;
    EXPECT_EQ(burstOf(world, tag, {receiver}, {.noise_seed = 3}).heard.at(0).distance,
              static_cast<double>(2.04F));
    EXPECT_EQ(burstOf(world, tag, {receiver}).heard.size(), 1U);
    receiver.as<Receiver>().noise.sigma = {0.1, 0, 0};
    for (const auto& [least, greatest] : {std::pair{2.01, 8.0}, std::pair{0.0, 1.99}}) {
        receiver.as<Receiver>().min_range = least;
        receiver.as<Receiver>().max_range = greatest;
        for (int frame = 0; frame < 2000; ++frame)
            EXPECT_TRUE(burstOf(world, tag, {receiver}, {.noise_seed = 3}, frame).heard.empty());
    }
}

TEST(Burst, NoiseIsLostFarFromTheAxis) {
    const RayWorld world = room();
    Sensor receiver = receiverAt("u", {4, 3, 2.4});
    receiver.as<Receiver>().fov = Angle::degrees(170);
    receiver.as<Receiver>().noise.graze_from = receiver.as<Receiver>().noise.graze_to =
        Angle::degrees(40);
    const UltrasoundOptions options{.noise_seed = 1};
    EXPECT_EQ(burstOf(world, tagAt({4.5, 3, 0.4}), {receiver}, options).heard.size(), 1U);
    EXPECT_EQ(burstOf(world, tagAt({6, 3, 0.4}), {receiver}, options).heard.size(), 0U);
    EXPECT_EQ(burstOf(world, tagAt({6, 3, 0.4}), {receiver}).heard.size(), 1U);
}

TEST(Burst, PlacesErrBySigmaTimesDilution) {
    constexpr double kSigma = 0.005;
    constexpr int kFrames = 3000;
    const RayWorld world = room();
    const auto receivers = ceiling(kSigma);
    const Sensor tag = tagAt({3.2, 2.7, 0.9});
    const PositionFix exact = burstOf(world, tag, receivers).fix.value();
    double across = 0, up = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        const PositionFix fix =
            burstOf(world, tag, receivers, {.noise_seed = 11}, frame).fix.value();
        const Vec3 error = fix.position - tag.pose.position;
        across += error.x * error.x + error.y * error.y;
        up += error.z * error.z;
    }
    const double slack = 5 / std::sqrt(2.0 * kFrames);
    EXPECT_NEAR(std::sqrt(across / kFrames) / (kSigma * exact.hdop), 1, slack);
    EXPECT_NEAR(std::sqrt(up / kFrames) / (kSigma * exact.vdop), 1, slack);
}

TEST(SimpleModel, IsTheTruePlaceWithoutNoise) {
    Sensor tag = tagAt({3, 2, 1});
    tag.as<Tag>().is_simple = true;
    const Burst burst = burstOf(room(), tag, {});
    EXPECT_EQ(burst.simple, (Point2{3, 2}));
    EXPECT_FALSE(burst.fix);
    // What receivers hear of it is told all the same, but not used.
    const Burst heard = burstOf(room(), tag, ceiling());
    EXPECT_EQ(heard.simple, (Point2{3, 2}));
    EXPECT_GE(heard.heard.size(), kMinReceivers);
    EXPECT_FALSE(heard.fix);
}

TEST(SimpleModel, HasIndependentNoiseOfTheThesis) {
    const RayWorld world = room();
    Sensor tag = tagAt({3, 2, 1});
    tag.as<Tag>().is_simple = true;
    constexpr int kFrames = 40000;
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        const Burst burst = burstOf(world, tag, {}, {.noise_seed = 2}, frame);
        const Vec2 n = burst.simple.value() - Point2{3, 2};
        x += n.x;
        y += n.y;
        xx += n.x * n.x;
        yy += n.y * n.y;
        xy += n.x * n.y;
    }
    // Eq. (3.9), (3.10): mean 0, sigma 0.1 m.
    const double slack = 5 / std::sqrt(kFrames);
    EXPECT_NEAR(x / kFrames, 0, 0.1 * slack);
    EXPECT_NEAR(y / kFrames, 0, 0.1 * slack);
    EXPECT_NEAR(std::sqrt(xx / kFrames), 0.1, 0.1 * slack / std::sqrt(2.0));
    EXPECT_NEAR(std::sqrt(yy / kFrames), 0.1, 0.1 * slack / std::sqrt(2.0));
    EXPECT_NEAR(xy / kFrames, 0, 0.01 * slack);
}

}  // namespace ultrasound_burst_test
}  // namespace ispace
