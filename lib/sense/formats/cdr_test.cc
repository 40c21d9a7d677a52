// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/cdr.h"

#include <gtest/gtest.h>

#include <array>

#include "sense/formats/ros_messages.h"

namespace ispace {
namespace {

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

}  // namespace
}  // namespace ispace
