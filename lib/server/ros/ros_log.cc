// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/ros/ros_log.h"

#include <utility>

namespace ispace {

RosLog::RosLog(RosFeed& feed, ByteSink write)
    : feed_(&feed),
      file_(std::move(write), "ros2", "cdr", rosSchemas(), {}, McapCompression::Zstd) {
    sync();
    writeNew();
}

RosLog::~RosLog() {
    for (const auto& [topic, line] : lines_) feed_->unwant(topic);
}

/// Adapts to the topics of a changed world.
void RosLog::sync() {
    feed_->sync();
    if (std::exchange(version_, feed_->version()) == feed_->version()) return;
    std::erase_if(lines_,
                  [this](const auto& one) { return !feed_->entries().contains(one.first); });
    for (const auto& [number, entry] : feed_->entries()) {
        if (entry.channel.isInput() || lines_.contains(number)) continue;
        if (channels_ == McapWriter::kMaxChannels) return;
        lines_[number].channel =
            file_.addChannel({static_cast<std::uint16_t>(entry.channel.type), entry.channel.topic});
        ++channels_;
        feed_->want(number);
    }
}

void RosLog::stepped() {
    sync();
    feed_->stepped();
    writeNew();
}

/// Messages of one time are ordered by their topics, as background jobs end in any order.
void RosLog::writeNew() {
    for (auto& [number, line] : lines_) {
        const auto& newest = feed_->entries().at(number).newest;
        if (!newest || std::exchange(line.last, newest->number()) == newest->number()) continue;
        appendMcapMessage(waiting_[{newest->time(), number}], line.channel, line.count++,
                          newest->time(), *newest->cdr());
    }
    while (!waiting_.empty() && waiting_.begin()->first.first < waiting_.rbegin()->first.first) {
        file_.add(waiting_.begin()->second);
        waiting_.erase(waiting_.begin());
    }
}

void RosLog::finish() {
    for (const auto& [topic, messages] : waiting_) file_.add(messages);
    waiting_.clear();
    file_.finish();
}

}  // namespace ispace
