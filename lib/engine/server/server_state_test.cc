// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/server_state.h"

#include <gtest/gtest.h>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "base/number.h"
#include "support/test_world.h"

namespace ispace {

namespace server_state_test {

TEST(StepQueue, TakesThemInTheOrderOfAsking) {
    testing::TestWorld room({Clock::Kind::Step, 1});
    StepQueue queue(room.simulation);
    const auto first = queue.ask(3), second = queue.ask(2);
    EXPECT_EQ(room.simulation.owed(), 5);
    for (int i = 0; i < 4; ++i) room.world.step();
    queue.settle();
    EXPECT_TRUE(first->over);
    EXPECT_EQ(second->left, 1);
    EXPECT_FALSE(second->over);
    room.world.step();
    queue.settle();
    EXPECT_TRUE(second->over);
}

TEST(StepQueue, ForgetsWhoIsGone) {
    testing::TestWorld room({Clock::Kind::Step, 1});
    StepQueue queue(room.simulation);
    const auto first = queue.ask(100), second = queue.ask(2);
    queue.drop(first);
    queue.drop(first);
    queue.drop(nullptr);
    EXPECT_EQ(room.simulation.owed(), 2);
    room.simulation.run(WallTime{}, std::chrono::hours(1));
    queue.settle();
    EXPECT_TRUE(second->over);
    EXPECT_EQ(second->left, 0);
    EXPECT_EQ(room.world.steps(), 2);
}

TEST(StepQueue, CutsShort) {
    testing::TestWorld room({Clock::Kind::Step, 1});
    StepQueue queue(room.simulation);
    const auto first = queue.ask(3), second = queue.ask(2);
    room.world.step();
    queue.cut();
    room.simulation.pause(WallTime{});
    EXPECT_TRUE(first->over);
    EXPECT_EQ(first->left, 2);
    EXPECT_TRUE(second->over);
    EXPECT_EQ(second->left, 2);
    // Later requests do not depend on them.
    const auto third = queue.ask(1);
    room.world.step();
    queue.settle();
    EXPECT_EQ(first->left, 2);
    EXPECT_TRUE(third->over);
}

}  // namespace server_state_test

namespace server_state_test {

constexpr float kNoReturn = std::numeric_limits<float>::infinity();

std::string rangeText(float range) {
    std::string out = "x";
    appendRange(out, range);
    return out.substr(1);
}

TEST(AppendRange, WritesThreeDecimals) {
    EXPECT_EQ(rangeText(kNoReturn), "-");
    EXPECT_EQ(rangeText(0), "0.000");
    EXPECT_EQ(rangeText(1.5), "1.500");
    EXPECT_EQ(rangeText(0.0009765625F), "0.001");
    EXPECT_EQ(rangeText(9.9996F), "10.000");
    EXPECT_EQ(rangeText(1234567), "1234567.000");
}

TEST(AppendRange, RoundsAsFormatFixed) {
    // Halves of a millimetre that floats hold exactly, and both of their neighbours.
    for (int odd = 1; odd < 4000; odd += 2) {
        const auto tie = static_cast<float>(odd) / 16;
        for (const float range : {std::nextafter(tie, 0.F), tie, std::nextafter(tie, 1e9F)})
            ASSERT_EQ(rangeText(range), formatFixed(static_cast<double>(range), 3)) << range;
    }
    std::mt19937 random(11);
    std::uniform_real_distribution<float> ranges(0, 60);
    for (int i = 0; i < 100000; ++i) {
        const float range = ranges(random);
        ASSERT_EQ(rangeText(range), formatFixed(static_cast<double>(range), 3)) << range;
    }
    for (int i = 0; i < 100000; ++i) {  // of any size and sign
        const auto range = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(range)) continue;
        ASSERT_EQ(rangeText(range), formatFixed(static_cast<double>(range), 3)) << range;
    }
}

Sensor sensor() {
    Laser laser;
    laser.first = Angle::degrees(-0.5);
    laser.step = Angle::degrees(0.25);
    laser.beams = 3;
    return {"l1", laser, {}};
}

SensorReading reading() {
    SensorReading reading;
    reading.time = std::chrono::milliseconds(12300);
    reading.seq = 123;
    std::get<Scan>(reading.value).ranges = {1.25, kNoReturn, 4};
    return reading;
}

TEST(ScanText, Line) {
    EXPECT_EQ(scanText(sensor(), reading(), {.stream = false, .binary = false}),
              "SCAN l1 t=12.300 seq=123 angle_min=-0.5 angle_max=0 step=0.25 n=3 "
              "r=1.250,-,4.000\n");
    EXPECT_EQ(scanText(sensor(), reading(), {.stream = true, .binary = false}),
              "SCAN l1 t=12.300 seq=123 angle_min=-0.5 angle_max=0 step=0.25 n=3 stream=1 "
              "r=1.250,-,4.000\n");
}

TEST(ScanText, BinaryIsLittleEndian) {
    using namespace std::string_literals;
    const std::string bytes = "\0\0\xa0\x3f\0\0\x80\x7f\0\0\x80\x40"s;
    EXPECT_EQ(
        scanText(sensor(), reading(), {.stream = false, .binary = true}),
        "SCAN l1 t=12.300 seq=123 angle_min=-0.5 angle_max=0 step=0.25 n=3 bytes=12\n" + bytes);
    EXPECT_EQ(scanText(sensor(), reading(), {.stream = true, .binary = true}),
              "SCAN l1 t=12.300 seq=123 angle_min=-0.5 angle_max=0 step=0.25 n=3 stream=1 "
              "bytes=12\n" +
                  bytes);
}

}  // namespace server_state_test

}  // namespace ispace
