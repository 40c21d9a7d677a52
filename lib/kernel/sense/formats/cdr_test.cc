// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/cdr.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <utility>

#include "sense/formats/reading_format.h"
#include "sense/formats/ros_messages.h"

namespace ispace {
namespace cdr_test {

TEST(Cdr, AlignsNumbersFromTheEndOfTheHead) {
    const std::string message =
        CdrWriter().put(true).put(2.0).put("ab").put(std::uint32_t{7}).take();
    EXPECT_EQ(message.size(), 4U + 8 + 8 + 4 + 3 + 1 + 4);
    EXPECT_EQ(message.substr(0, 4), std::string("\0\1\0\0", 4));
    CdrReader in(message);
    EXPECT_EQ(in.number<std::uint8_t>(), 1);
    EXPECT_EQ(in.number<double>(), 2.0);
    EXPECT_EQ(in.text(), "ab");
    EXPECT_EQ(in.number<std::uint32_t>(), 7U);
    EXPECT_THROW(in.number<std::uint8_t>(), FormatError);
}

TEST(Cdr, RefusesOtherEncodings) {
    EXPECT_THROW(CdrReader(""), FormatError);
    EXPECT_THROW(CdrReader(std::string("\0\0\0\0", 4)), FormatError) << "big-endian";
    EXPECT_THROW(CdrReader(std::string("\0\7\0\0", 4)), FormatError) << "version 2";
    EXPECT_NO_THROW(CdrReader(std::string("\0\1\0\3", 4))) << "the padding is counted";
}

TEST(Cdr, EveryCutMessageIsRefused) {
    const std::array<double, 6> values{1, 0, 0, 0, 0, 0.5};
    CdrWriter out;
    out.put(std::uint32_t{3})
        .put(std::uint32_t{4})
        .put("map")
        .array(std::span<const double>(values));
    const std::string message = out.take();
    const RosTwist twist = twistOf(RosType::TwistStamped, message);
    EXPECT_EQ(twist.forward, 1);
    EXPECT_EQ(twist.turn.radians(), 0.5);
    for (std::size_t i = 0; i < message.size(); ++i)
        EXPECT_THROW(twistOf(RosType::TwistStamped, message.substr(0, i)), FormatError) << i;
}

TEST(Cdr, CountsBeyondTheEndAreRefused) {
    const std::string message = CdrWriter().put(std::uint32_t{0xffffffff}).put(true).take();
    EXPECT_THROW(CdrReader(message).count(), FormatError);
    EXPECT_THROW(CdrReader(message).text(), FormatError);
    EXPECT_THROW(CdrReader(message).values(0x4000'0000'0000'0001, 4), FormatError);
}

TEST(RosTypes, AreFoundInBothForms) {
    EXPECT_EQ(rosTypeNamed("geometry_msgs/msg/Twist"), RosType::Twist);
    EXPECT_EQ(rosTypeNamed("geometry_msgs/Twist"), RosType::Twist);
    EXPECT_EQ(rosTypeNamed("geometry_msgs/TwistStamped"), RosType::TwistStamped);
    for (const char* name : {"", "/", "geometry_msgs/", "geometry_msgs/ms/Twist", "Twist"})
        EXPECT_EQ(rosTypeNamed(name), std::nullopt) << name;
    for (std::size_t i = 0; i < kRosTypes; ++i) {
        const auto type = static_cast<RosType>(i);
        EXPECT_EQ(rosTypeNamed(nameOf(type)), type);
    }
}

/// All structs within a definition are defined in it: viewers know no other.
TEST(RosTypes, DefinitionsAreComplete) {
    const auto check = [](const auto& self, const RosStruct& type,
                          const std::string& text) -> void {
        for (const RosField& field : type.fields) {
            if (field.fields == nullptr) continue;
            EXPECT_NE(text.find("\nMSG: " + field.fields->name + "\n"), std::string::npos)
                << type.name << '.' << field.name;
            self(self, *field.fields, text);
        }
    };
    for (std::size_t i = 0; i < kRosTypes; ++i) {
        const auto type = static_cast<RosType>(i);
        check(check, rosFields(type), rosDefinition(type));
    }
}

TEST(RosTypes, FieldsHaveTheirLengths) {
    const RosStruct& odometry = rosFields(RosType::Odometry);
    ASSERT_EQ(odometry.fields.size(), 4U);
    EXPECT_EQ(odometry.fields[1].name, "child_frame_id");
    const RosField& covariance = odometry.fields[2].fields->fields[1];
    EXPECT_TRUE(covariance.is_array);
    EXPECT_EQ(covariance.length, 36U);
    const RosField& ranges = rosFields(RosType::LaserScan).fields[8];
    EXPECT_EQ(ranges.name, "ranges");
    EXPECT_TRUE(ranges.is_array);
    EXPECT_EQ(ranges.length, 0U);
    EXPECT_EQ(rosFields(RosType::Range).fields.size(), 7U) << "constants are no fields";
}

TEST(RosMessages, PosesAreReadInThePlane) {
    CdrWriter out;
    out.put(std::uint32_t{0}).put(std::uint32_t{0}).put("map");
    for (const double value : {1.0, -2.0, 9.0, 0.0, 0.0, 0.70710678118654752, 0.70710678118654752})
        out.put(value);
    const RosPose pose = poseOf(out.take());
    EXPECT_EQ(pose.frame, "map");
    EXPECT_EQ(pose.pose.position, Point2(1, -2));
    EXPECT_NEAR(pose.pose.heading.degrees(), 90, 1e-9);
}

TEST(RosMessages, OdometryHoldsItsCovariances) {
    const EstimatedPose estimate{{{1, 2}, Angle()},
                                 {.xx = 1, .xy = 2, .yy = 3, .xh = 4, .yh = 5, .hh = 6}};
    const MotionAlphas alphas{0.01, 0.004, 0.002, 0.001};
    constexpr double kSeconds = 0.02;
    const std::string bytes = odometryMessage({0, "r_odom"}, "r", estimate,
                                              {0.5, 0, Angle::radians(0.2)}, alphas, kSeconds);
    // Last come 36 doubles of the pose, 6 of the twist and 36 of its covariance.
    constexpr std::size_t kMatrix = 36, kRow = 6, kTwist = 6;
    const auto value = [&bytes](std::size_t from_end, std::size_t row, std::size_t column) {
        double number = 0;
        const std::size_t at = bytes.size() - 8 * (from_end - kRow * row - column);
        std::memcpy(&number, bytes.data() + at, sizeof number);
        return number;
    };
    constexpr std::size_t kPose = 2 * kMatrix + kTwist;
    EXPECT_EQ(value(kPose, 0, 0), 1);
    EXPECT_EQ(value(kPose, 0, 1), 2);
    EXPECT_EQ(value(kPose, 1, 0), 2);
    EXPECT_EQ(value(kPose, 1, 1), 3);
    EXPECT_EQ(value(kPose, 0, 5), 4);
    EXPECT_EQ(value(kPose, 5, 1), 5);
    EXPECT_EQ(value(kPose, 5, 5), 6);
    EXPECT_EQ(value(kPose, 2, 2), 0);
    EXPECT_NEAR(value(kMatrix, 0, 0), (0.002 * 0.5 + 0.001 * 0.2) / kSeconds, 1e-12);
    EXPECT_NEAR(value(kMatrix, 5, 5), (0.01 * 0.2 + 0.004 * 0.5) / kSeconds, 1e-12);
}

TEST(RosMessages, TwistsOfARecordAreMeansOverItsInterval) {
    const auto first_variance = [](double interval) {
        FormatOptions options;
        options.members = {{"r", false, {0.01, 0.004, 0.002, 0.001}}};
        options.moment_interval = interval;
        RunState state;
        state.speed = 0.5;
        state.odometry = EstimatedPose{};
        std::string bytes;
        makeFormat("mcap", {}, std::move(options))->appendMoment(bytes, 0, 1, 0, {&state, 1});
        double number = 0;
        constexpr std::size_t kMatrix = 36 * sizeof number;  // it ends the message
        std::memcpy(&number, bytes.data() + bytes.size() - kMatrix, sizeof number);
        return number;
    };
    EXPECT_NEAR(first_variance(0), 0.002 * 0.5 / 0.02, 1e-12);
    EXPECT_NEAR(first_variance(0.01), 0.002 * 0.5 / 0.02, 1e-12) << "as often as it is published";
    EXPECT_NEAR(first_variance(0.1), 0.002 * 0.5 / 0.1, 1e-12);
}

}  // namespace cdr_test
}  // namespace ispace
