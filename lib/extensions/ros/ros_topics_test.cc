// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_topics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "base/file.h"
#include "base/number.h"
#include "support/test_paths.h"

namespace ispace::ros {
namespace ros_topics_test {

using Words = std::vector<std::string>;

std::vector<Words> linesOf(const std::string& text) {
    std::vector<Words> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        lines.emplace_back();
        for (std::string word; words >> word;)
            lines.back().push_back(word.ends_with(',') ? word.substr(0, word.size() - 1) : word);
    }
    return lines;
}

std::string topicOf(const RosRow& row) {
    const std::string name(row.name);
    if (row.subject == RosRow::Of::World || row.subject == RosRow::Of::Room) return "/" + name;
    return "/R/" + name + (row.subject == RosRow::Of::Robot ? "" : "_N");
}

/// "nav_msgs/Odometry", as the manual has it.
std::string shortName(RosType type) {
    std::string name(nameOf(type));
    return name.erase(name.find("/msg"), 4);
}

TEST(RosRows, AreInTheManual) {
    const auto lines = linesOf(readAll(testing::sourcePath("lib/extensions/ros/ispace-ros.7")));
    for (const RosRow& row : rosRows()) {
        const std::string topic = topicOf(row), type = shortName(row.type);
        const auto line = std::find_if(lines.begin(), lines.end(), [&](const Words& words) {
            return !words.empty() && words[0] == topic &&
                   std::find(words.begin(), words.end(), type) != words.end();
        });
        ASSERT_NE(line, lines.end()) << topic << " " << type;
        if (row.decode != nullptr) continue;
        const std::string rate = row.rate > 0 ? formatDouble(row.rate) : "latched";
        ASSERT_EQ(line->size(), 5U) << topic;
        EXPECT_EQ((*line)[3], rate) << topic;
        EXPECT_EQ((*line)[4], std::to_string(row.quality.depth)) << topic;
    }
}

TEST(RosRows, EitherSendOrRead) {
    for (const RosRow& row : rosRows()) {
        EXPECT_NE(row.encode == nullptr, row.decode == nullptr) << row.name;
        EXPECT_EQ(row.quality.is_latched, row.encode != nullptr && row.rate == 0) << row.name;
        EXPECT_GT(row.quality.depth, 0U) << row.name;
    }
}

}  // namespace ros_topics_test
}  // namespace ispace::ros
