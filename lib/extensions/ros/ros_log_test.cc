// SPDX-License-Identifier: GPL-3.0-or-later
// Readers of others read its files: lib/extensions/ros/tests/simrun_mcap.sh.
#include "extensions/ros/ros_log.h"

#include <gtest/gtest.h>

#include <zstd.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "support/test_world.h"

namespace ispace::ros {
namespace ros_log_test {

/// The messages of a file by topic, without its index.
struct LogContent {
    explicit LogContent(const std::string& file) { readRecords(file.substr(8)); }
    std::map<std::string, std::vector<std::uint64_t>> times;  ///< nanoseconds

  private:
    template <typename Number>
    static Number numberAt(const std::string& bytes, std::size_t at) {
        Number value;
        std::memcpy(&value, bytes.data() + at, sizeof(value));
        return value;
    }
    void readRecords(const std::string& bytes) {
        constexpr std::uint8_t kChannel = 4, kMessage = 5, kChunk = 6, kDataEnd = 15;
        for (std::size_t at = 0; at + 9 <= bytes.size();) {
            const auto opcode = numberAt<std::uint8_t>(bytes, at);
            const auto size = numberAt<std::uint64_t>(bytes, at + 1);
            const std::string content = bytes.substr(at + 9, size);
            if (opcode == kDataEnd) return;
            if (opcode == kChannel)
                topics_[numberAt<std::uint16_t>(content, 0)] =
                    content.substr(8, numberAt<std::uint32_t>(content, 4));
            if (opcode == kMessage)
                times[topics_.at(numberAt<std::uint16_t>(content, 0))].push_back(
                    numberAt<std::uint64_t>(content, 6));
            if (opcode == kChunk) readChunk(content);
            at += 9 + size;
        }
    }
    void readChunk(const std::string& content) {
        const auto name = numberAt<std::uint32_t>(content, 28);
        ASSERT_EQ(content.substr(32, name), "zstd");
        std::string records(numberAt<std::uint64_t>(content, 16), '\0');
        const std::size_t begin = 32 + name + 8;
        ASSERT_EQ(ZSTD_decompress(records.data(), records.size(), content.data() + begin,
                                  content.size() - begin),
                  records.size());
        readRecords(records);
    }
    std::map<std::uint16_t, std::string> topics_;
};

/// A logged world in steps of 0.1 s.
struct Logged {
    explicit Logged(const std::string& more = "")
        : room({Clock::Kind::Step, 1}, {}, "", more),
          state(room.simulation),
          feed(state, {}),
          log(feed, [this](std::string_view bytes) { file += bytes; }) {}

    void step(std::int64_t count) {
        room.simulation.allow(count);
        for (std::int64_t i = 0; i < count; ++i) {
            room.simulation.run({}, std::chrono::nanoseconds(0));
            state.collect();
            log.stepped();
        }
    }
    [[nodiscard]] LogContent finish() {
        log.finish();
        return LogContent(file);
    }

    std::string file;
    testing::TestWorld room;
    ServerState state;
    RosFeed feed;
    RosLog log;
};

TEST(RosLog, HasEachTopicAtItsRate) {
    Logged logged("camera id=c1 at=0,-2,2 pixels=4,3 rate=5\nhuman id=h1 at=-2,2\n");
    logged.step(20);
    const LogContent content = logged.finish();
    const auto count = [&](const std::string& topic) { return content.times.at(topic).size(); };
    EXPECT_EQ(count("/clock"), 21U) << "from 0 on";
    EXPECT_EQ(count("/people"), 21U);
    EXPECT_EQ(count("/r1/odom"), 21U);
    EXPECT_EQ(count("/tf_static"), 1U);
    EXPECT_EQ(count("/diagnostics"), 3U) << "at 0, 1 and 2 s";
    EXPECT_NEAR(static_cast<double>(count("/c1/image_raw/compressed")), 10, 1);
    EXPECT_FALSE(content.times.contains("/r1/cmd_vel")) << "orders are no topics of the world";
    EXPECT_EQ(content.times.at("/clock").back(), 2'000'000'000U);
}

TEST(RosLog, FollowsChangesOfTheWorld) {
    Logged logged;
    logged.step(2);
    logged.room.world.change(testing::scene(
        "ispace size=8,6\n", "robot id=r9 at=0,0\nlaser id=l1 at=-3,-2 fov=4 step=2\n"));
    logged.state.sync();
    logged.step(3);
    const LogContent content = logged.finish();
    EXPECT_EQ(content.times.at("/r9/odom").size(), 3U) << "after each step";
    EXPECT_EQ(content.times.at("/r9/odom").back(), 500'000'000U);
    EXPECT_EQ(content.times.at("/r1/odom").back(), 200'000'000U);
    EXPECT_EQ(content.times.at("/l1/scan").back(), 500'000'000U);
    EXPECT_EQ(content.times.at("/tf_static").size(), 2U) << "one for each change";
}

TEST(RosLog, HoldsTheNewestMessageOfATopicWhileTimeStandsStill) {
    Logged logged;
    logged.step(1);
    for (int i = 0; i < 5; ++i) {
        logged.room.world.change(testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n"));
        logged.state.sync();
        logged.log.stepped();
    }
    logged.step(1);
    const LogContent content = logged.finish();
    EXPECT_EQ(content.times.at("/r1/odom"),
              (std::vector<std::uint64_t>{0, 100'000'000, 100'000'000, 200'000'000}))
        << "before and after the changes, the first of which removes topics";
}

TEST(RosLog, CountsTopicsBeyondTheChannels) {
    testing::TestWorld room({Clock::Kind::Step, 1}, {}, "", "");
    ServerState state(room.simulation);
    RosFeed feed(state, {});
    std::string file;
    RosLog log(
        feed, [&](std::string_view bytes) { file += bytes; }, 3);
    std::size_t topics = 0;
    for (const auto& [number, entry] : feed.entries()) topics += entry.channel.isInput() ? 0 : 1;
    ASSERT_GT(topics, 3U);
    EXPECT_EQ(log.leftOut(), topics - 3);
    const auto change = [&](const Scene& scene) {
        room.world.change(scene);
        state.sync();
        log.stepped();
    };
    for (int i = 0; i < 3; ++i) {
        change(testing::scene("ispace size=8,6\n", "robot id=r2 at=2,1.5\n"));
        change(room.scene);
        EXPECT_EQ(log.leftOut(), topics - 3) << "topics that go and come are counted once";
    }
    log.finish();
    EXPECT_LE(LogContent(file).times.size(), 3U);
}

TEST(RosLog, LeavesTheFeedWithoutSubscriptions) {
    testing::TestWorld room({Clock::Kind::Step, 1}, {}, "", "");
    ServerState state(room.simulation);
    RosFeed feed(state, {});
    {
        RosLog log(feed, [](std::string_view /*bytes*/) {});
    }
    for (const auto& [number, entry] : feed.entries()) EXPECT_EQ(entry.wanted, 0U);
}

}  // namespace ros_log_test
}  // namespace ispace::ros
