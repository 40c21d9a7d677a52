// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "sense/formats/ros_messages.h"

namespace ispace::ros {
namespace ros_text_test {

using nlohmann::json;

std::string scanOf(const std::vector<float>& ranges) {
    Laser laser;
    laser.beams = static_cast<int>(ranges.size());
    return laserScanMessage({1'500'000'000, "l1"}, laser, 0, ranges);
}

TEST(RosText, WritesJsonAsRosbridgeDoes) {
    constexpr float kInf = std::numeric_limits<float>::infinity();
    const json scan = json::parse(rosJson(RosType::LaserScan, scanOf({1.5F, kInf})));
    EXPECT_EQ(scan["header"]["stamp"], json({{"sec", 1}, {"nanosec", 500'000'000}}));
    EXPECT_EQ(scan["header"]["frame_id"], "l1");
    EXPECT_EQ(scan["ranges"], json::parse("[1.5,null]"));
    EXPECT_EQ(scan["intensities"], json::array());
    const json map = json::parse(
        rosJson(RosType::OccupancyGrid, mapMessage({0, "map"}, {{}, 0.05, 2, {-1, 100}})));
    EXPECT_EQ(map["data"], json::parse("[-1,100]")) << "signed bytes are a list";
    EXPECT_EQ(map["info"]["height"], 1);
    const json picture = json::parse(
        rosJson(RosType::CompressedImage, compressedImageMessage({0, "c"}, "png", "abc")));
    EXPECT_EQ(picture["data"], "YWJj");
}

/// nlohmann reads typed arrays as bytes with their tag.
TEST(RosText, CborHoldsTheSameValues) {
    const std::string bytes = rosCbor(RosType::LaserScan, scanOf({1.5F, std::nanf("")}));
    const json scan = json::from_cbor(bytes, true, false, json::cbor_tag_handler_t::store);
    ASSERT_FALSE(scan.is_discarded());
    EXPECT_EQ(scan["header"]["stamp"]["nanosec"], 500'000'000);
    const auto& ranges = scan["ranges"].get_binary();
    EXPECT_EQ(ranges.subtype(), 85U);
    ASSERT_EQ(ranges.size(), 8U);
    EXPECT_EQ(ranges[3], 0x3f) << "1.5 is 3fc00000, little-endian";
    EXPECT_EQ(ranges[2], 0xc0);
    SonarRing ring;
    ring.min_range = 0.25;
    const json range = json::from_cbor(rosCbor(RosType::Range, rangeMessage({0, "s"}, ring, 2.5F)));
    EXPECT_EQ(range["range"], 2.5);
    EXPECT_EQ(range["min_range"], 0.25);
    const json state = json::from_cbor(rosCbor(RosType::Bool, boolMessage(true)));
    EXPECT_EQ(state, json({{"data", true}}));
    const json stamp = {{"sec", -7}, {"nanosec", 4'294'967'295U}};
    const std::string early = rosCbor(
        RosType::LaserScan, rosMessage(RosType::LaserScan, {{"header", {{"stamp", stamp}}}}));
    const json negative = json::from_cbor(early, true, true, json::cbor_tag_handler_t::store);
    EXPECT_EQ(negative["header"]["stamp"], stamp);
}

TEST(RosText, CborHeadsGrowWithTheirNumbers) {
    for (const std::uint64_t value :
         {0ULL, 23ULL, 24ULL, 255ULL, 256ULL, 65535ULL, 65536ULL, 4294967295ULL, 4294967296ULL}) {
        std::string out;
        appendCborHead(out, CborHead::Unsigned, value);
        EXPECT_EQ(json::from_cbor(out), json(value));
    }
    std::string text;
    appendCborText(text, "msg");
    EXPECT_EQ(json::from_cbor(text), json("msg"));
}

TEST(RosText, ReadsJsonWithDefaults) {
    const json twist = {{"linear", {{"x", 0.5}}}, {"angular", {{"z", -1}}}};
    const RosTwist read = twistOf(RosType::Twist, rosMessage(RosType::Twist, twist));
    EXPECT_EQ(read.forward, 0.5);
    EXPECT_EQ(read.left, 0);
    EXPECT_EQ(read.turn.radians(), -1);
    const json pose = {{"header", {{"stamp", {{"secs", 3}, {"nsecs", 4}}}, {"frame_id", "map"}}},
                       {"pose", {{"pose", {{"position", {{"x", 1}, {"y", 2}}}}}}}};
    const RosPose at = poseOf(rosMessage(RosType::PoseWithCovarianceStamped, pose));
    EXPECT_EQ(at.pose.position, Point2(1, 2));
    EXPECT_EQ(at.pose.heading.degrees(), 0) << "an absent orientation is the identity";
    const json stamped = {{"twist", {{"linear", {{"x", nullptr}}}}}};
    EXPECT_TRUE(std::isnan(
        twistOf(RosType::TwistStamped, rosMessage(RosType::TwistStamped, stamped)).forward));
}

TEST(RosText, ReadsTimesOfEveryName) {
    const auto stamped = [](const json& stamp) {
        return rosMessage(RosType::TwistStamped, {{"header", {{"stamp", stamp}}}});
    };
    const std::string today = stamped({{"sec", 3}, {"nanosec", 4}});
    EXPECT_EQ(stamped({{"secs", 3}, {"nsecs", 4}}), today) << "ROS 1";
    EXPECT_EQ(stamped({{"sec", 3}, {"nsec", 4}}), today) << "Foxglove Studio";
    EXPECT_NE(stamped({{"sec", 3}}), today);
}

TEST(RosText, RefusesValuesOfOtherTypes) {
    const auto refuses = [](RosType type, const char* text) {
        EXPECT_THROW(rosMessage(type, json::parse(text)), FormatError) << text;
    };
    refuses(RosType::Twist, "[]");
    refuses(RosType::Twist, "7");
    refuses(RosType::Twist, R"({"linear":[1,2,3]})");
    refuses(RosType::Twist, R"({"linear":{"x":"fast"}})");
    refuses(RosType::Bool, R"({"data":1})");
    refuses(RosType::TwistStamped, R"({"header":{"frame_id":7}})");
    refuses(RosType::TwistStamped, R"({"header":{"stamp":{"sec":1.5}}})");
    refuses(RosType::TwistStamped, R"({"header":{"stamp":{"sec":1e12}}})");
    refuses(RosType::Twist, R"({"seq":1})");
    refuses(RosType::TwistStamped, R"({"header":{"stamp":{"msec":1}}})");
    refuses(RosType::PoseWithCovarianceStamped, R"({"pose":{"covariance":[1]}})");
    refuses(RosType::PoseWithCovarianceStamped, R"({"pose":{"covariance":0}})");
}

TEST(RosText, RefusesMessagesThatAreCutOff) {
    const std::string scan = scanOf({1, 2, 3});
    for (std::size_t i = 0; i < scan.size(); ++i) {
        EXPECT_THROW(rosJson(RosType::LaserScan, scan.substr(0, i)), FormatError) << i;
        EXPECT_THROW(rosCbor(RosType::LaserScan, scan.substr(0, i)), FormatError) << i;
    }
}

TEST(RosText, JsonOfClientsIsBounded) {
    EXPECT_TRUE(parseClientJson(R"({"op":"x"})"));
    EXPECT_FALSE(parseClientJson(""));
    EXPECT_FALSE(parseClientJson("{"));
    EXPECT_FALSE(parseClientJson("{}{}"));
    EXPECT_FALSE(parseClientJson("\"\xff\""));
    EXPECT_TRUE(parseClientJson(std::string(20, '[') + std::string(20, ']')));
    EXPECT_FALSE(parseClientJson(std::string(100, '[') + std::string(100, ']')));
    EXPECT_FALSE(parseClientJson(std::string(100'000, '[')));
    const std::string brackets(100, '[');
    EXPECT_TRUE(parseClientJson("[\"" + brackets + "\", \"\\\"" + brackets + "\"]"));
    EXPECT_FALSE(parseClientJson("[\"" + brackets + "\\"));
}

TEST(RosText, LongListsOfClientsTakeTimeByTheirLength) {
    constexpr int kObjects = 200'000;  // 20 000 million looks if each item begins a search
    std::string text = "[{}";
    for (int i = 1; i < kObjects; ++i) text += ",{}";
    EXPECT_EQ(parseClientJson(text + "]")->size(), kObjects);
}

}  // namespace ros_text_test
}  // namespace ispace::ros
