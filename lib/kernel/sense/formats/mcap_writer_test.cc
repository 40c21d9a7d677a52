// SPDX-License-Identifier: GPL-3.0-or-later
// What the files hold other people's readers tell: tests/pipelines/scan_mcap.sh.
#include "sense/formats/mcap_writer.h"

#include <gtest/gtest.h>

#include "sense/formats/ros_messages.h"

namespace ispace {
namespace mcap_writer_test {

std::string fileOf(const std::vector<std::string>& pieces) {
    std::string out;
    McapWriter file([&out](std::string_view bytes) { out += bytes; }, "ros2", "cdr", rosSchemas(),
                    {{0, "/tf"}, {1, "/l1/scan"}});
    for (const std::string& piece : pieces) file.add(piece);
    file.finish();
    return out;
}

TEST(McapWriter, MakesTheSameBytesHoweverMessagesAreHandedOver) {
    std::vector<std::string> one_by_one;
    std::string together;
    for (std::uint16_t i = 0; i < 300; ++i) {
        std::string message;
        appendMcapMessage(message, i % 2, i, std::uint64_t{1000} * i,
                          std::string(20'000U + i, 'x'));
        one_by_one.push_back(message);
        together += message;
    }
    const std::string file = fileOf({together});
    EXPECT_GT(file.size(), 300U * 20'000U);
    EXPECT_TRUE(fileOf(one_by_one) == file);
    EXPECT_EQ(file.substr(0, 8), std::string("\x89MCAP0\r\n"));
    EXPECT_EQ(file.substr(file.size() - 8), file.substr(0, 8));
}

TEST(McapWriter, WritesOtherSchemasBeforeTheirFirstChannel) {
    const auto count = [](const std::vector<McapChannel>& channels, std::uint16_t later) {
        std::string out;
        McapWriter file([&out](std::string_view bytes) { out += bytes; }, "ros2", "cdr",
                        rosSchemas(), channels, McapCompression::None, 2);
        file.addChannel({later, "/later"});
        file.finish();
        std::size_t found = 0;
        for (const McapSchema& schema : rosSchemas())
            for (std::size_t at = out.find(schema.text); !schema.text.empty() && at != out.npos;
                 at = out.find(schema.text, at + 1))
                ++found;
        return found;
    };
    // Each once in the data and once in the summary.
    EXPECT_EQ(count({}, 1), 2U * 2);
    EXPECT_EQ(count({{0, "/tf"}}, 6), 2U * 3);
    EXPECT_EQ(count({{6, "/p/position"}}, 6), 2U * 3);
}

TEST(RosName, IsOneThatTopicsMayHave) {
    for (const auto& [id, name] :
         std::vector<std::pair<std::string, std::string>>{{"laser1", "laser1"},
                                                          {"camera 2/left", "camera_2_left"},
                                                          {"a__b", "a_b"},
                                                          {"2nd", "s2nd"},
                                                          {"_x", "s_x"},
                                                          {"", "s"},
                                                          {"äö", "s_"}})
        EXPECT_EQ(rosName(id), name);
}

TEST(RosSchemas, HoldAllTheTypesTheyName) {
    std::vector<McapSchema> recorded = rosSchemas();
    recorded.resize(kRecordedRosTypes);
    for (const McapSchema& schema : recorded) {
        EXPECT_NE(schema.text.find("MSG: builtin_interfaces/Time\n"), std::string::npos)
            << schema.name;
        EXPECT_NE(schema.text.find("MSG: std_msgs/Header\n"), std::string::npos) << schema.name;
    }
    EXPECT_EQ(rosSchemas()[static_cast<std::size_t>(RosType::PointStamped)].name,
              "geometry_msgs/msg/PointStamped");
}

}  // namespace mcap_writer_test
}  // namespace ispace
