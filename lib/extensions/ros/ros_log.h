// SPDX-License-Identifier: GPL-3.0-or-later
// Topics as an MCAP file or bag.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "base/file.h"
#include "extensions/ros/ros_feed.h"
#include "sense/formats/mcap_writer.h"

namespace ispace::ros {

/// Writes all topics of a running world to an MCAP file, as `ros2 bag record` of the same world
/// would. Topics that a change of the world adds get channels of their own; those beyond the
/// channels of a file are left out and counted.
class RosLog {
  public:
    /// Subscribes to all topics of the feed, which outlives the log. \param write receives the file
    RosLog(RosFeed& feed, ByteSink write, std::size_t max_channels = McapWriter::kMaxChannels);
    RosLog(const RosLog&) = delete;
    RosLog& operator=(const RosLog&) = delete;
    ~RosLog();

    /// Call after each step or change of the world, and when background jobs have delivered:
    /// writes the new messages.
    void stepped();
    /// Writes the end of the file.
    void finish();
    /// Returns the number of topics without a channel in the file; one that comes again counts
    /// once.
    [[nodiscard]] std::size_t leftOut() const { return left_out_.size(); }
    /// Returns the text of the bag's metadata, see bagMetadata(). \param file name of the MCAP file
    [[nodiscard]] std::string metadata(const std::string& file) const;

  private:
    /// A topic of the feed in the file.
    struct Line {
        std::uint16_t channel = 0;
        std::uint32_t count = 0;  ///< of messages
        std::int64_t last = 0;    ///< number of the last message in the feed
    };
    void sync();
    void writeNew();
    void writeBefore(std::uint64_t time);

    RosFeed* feed_;
    McapWriter file_;
    std::map<std::uint32_t, Line> lines_;  // by number in the feed
    /// Of the present time, by time and topic.
    std::map<std::pair<std::uint64_t, std::uint32_t>, std::shared_ptr<const RosMessage>> waiting_;
    std::size_t max_channels_, channels_ = 0;
    std::set<std::string> left_out_;  // topics, some of which a change has removed
    std::int64_t version_ = -1;       // of the feed's topics
};

}  // namespace ispace::ros
