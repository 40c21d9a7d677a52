// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/rosbag.h"

#include <gtest/gtest.h>

#include "sense/formats/ros_messages.h"

namespace ispace {
namespace rosbag_test {

TEST(RosBag, ChannelsNameTheirQuality) {
    const McapChannel map = bagChannel(0, "/map", {.depth = 1, .is_latched = true});
    const std::string& latched = map.metadata.at("offered_qos_profiles");
    EXPECT_NE(latched.find("  depth: 1\n  reliability: 1\n  durability: 1\n"), std::string::npos);
    const McapChannel scan = bagChannel(0, "/scan", {});
    const std::string& plain = scan.metadata.at("offered_qos_profiles");
    EXPECT_NE(plain.find("  depth: 10\n  reliability: 1\n  durability: 2\n"), std::string::npos);
}

TEST(RosBag, FilesHoldTheQualityAndMetadataCountsMessages) {
    std::string bytes, message;
    McapWriter file([&](std::string_view part) { bytes += part; }, "ros2", "cdr", rosSchemas(),
                    {bagChannel(0, "/map", {.depth = 1, .is_latched = true})});
    for (const std::uint64_t time : {3'000U, 5'000U}) {
        message.clear();
        appendMcapMessage(message, 0, 1, time, "x");
        file.add(message);
    }
    file.finish();
    EXPECT_NE(bytes.find("offered_qos_profiles"), std::string::npos);
    const std::string text = bagMetadata(file.content(), "run_0.mcap");
    for (const char* part :
         {"message_count: 2\n", "nanoseconds_since_epoch: 3000\n", "nanoseconds: 2000\n",
          "name: \"/map\"\n", "relative_file_paths:\n    - \"run_0.mcap\"\n", "durability: 1"})
        EXPECT_NE(text.find(part), std::string::npos) << part << text;
}

}  // namespace rosbag_test
}  // namespace ispace
