// SPDX-License-Identifier: GPL-3.0-or-later
// Messages are written in the order of times and, within a time, of topics: background jobs end in
// any order, and the file must not depend on it. So those of a time wait until the next one.
#include "extensions/ros/ros_log.h"

#include <limits>
#include <string>
#include <utility>

#include "sense/formats/rosbag.h"

namespace ispace::ros {

namespace {
constexpr std::uint64_t kEnd = std::numeric_limits<std::uint64_t>::max();
}  // namespace

RosLog::RosLog(RosFeed& feed, ByteSink write, std::size_t max_channels)
    : feed_(&feed),
      file_(std::move(write), "ros2", "cdr", rosSchemas(), {}, McapCompression::Zstd, kRunRosTypes),
      max_channels_(max_channels) {
    sync();
    writeNew();
}

RosLog::~RosLog() {
    for (const auto& [topic, line] : lines_) feed_->unwant(topic);
}

std::string RosLog::metadata(const std::string& file) const {
    return bagMetadata(file_.content(), file);
}

/// Adapts to the topics of a changed world.
void RosLog::sync() {
    feed_->sync();
    if (std::exchange(version_, feed_->version()) == feed_->version()) return;
    writeBefore(kEnd);
    const RosFeed::Entries& entries = feed_->entries();
    std::erase_if(lines_, [&entries](const auto& one) { return !entries.contains(one.first); });
    for (const auto& [number, entry] : entries) {
        if (entry.channel.isInput() || entry.channel.is_alias || lines_.contains(number)) continue;
        if (channels_ == max_channels_) {
            left_out_.insert(entry.channel.topic);
            continue;
        }
        lines_[number].channel = file_.addChannel(
            bagChannel(static_cast<std::uint16_t>(entry.channel.type), entry.channel.topic,
                       {entry.channel.quality.depth, entry.channel.quality.is_latched}));
        ++channels_;
        feed_->want(number);
    }
}

void RosLog::stepped() {
    sync();
    feed_->stepped();
    writeNew();
}

/// Messages of one time are ordered by their topics, as background jobs end in any order; of
/// several of a topic, as a paused world has, the newest is written.
void RosLog::writeNew() {
    for (auto& [number, line] : lines_) {
        const auto& newest = feed_->entries().at(number).newest;
        if (!newest || std::exchange(line.last, newest->number()) == newest->number()) continue;
        waiting_[{newest->time(), number}] = newest;
    }
    if (!waiting_.empty()) writeBefore(waiting_.rbegin()->first.first);
}

void RosLog::writeBefore(std::uint64_t time) {
    std::string messages;
    while (!waiting_.empty() && waiting_.begin()->first.first < time) {
        const auto& [topic, message] = *waiting_.begin();
        Line& line = lines_.at(topic.second);
        appendMcapMessage(messages, line.channel, line.count++, message->time(), *message->cdr());
        waiting_.erase(waiting_.begin());
    }
    file_.add(messages);
}

void RosLog::finish() {
    writeBefore(kEnd);
    file_.finish();
}

}  // namespace ispace::ros
