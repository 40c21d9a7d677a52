// SPDX-License-Identifier: GPL-3.0-or-later
// Queues of a client. A subscription keeps as many messages as its depth, all of them together 8
// MiB, answers 4 MiB; the oldest message is dropped first, and dropped messages are counted as
// losses.
#include "extensions/ros/ros_dialogue.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace ispace::ros {

namespace {

constexpr std::size_t kMaxSubscriptions = 4096;
/// Bytes of unsent messages and of unsent answers; one of each may be larger.
constexpr std::size_t kMaxQueue = std::size_t{1} << 23U, kMaxAnswers = std::size_t{1} << 22U;

}  // namespace

RosDialogue::RosDialogue(ServerState& state, RosFeed& feed, std::string peer)
    : state_(&state),
      feed_(&feed),
      orders_(
          state, [this](const std::string& error) { report(Level::Error, error); },
          std::move(peer)) {
    feed.enter();
    version_ = feed.version();
}

RosDialogue::~RosDialogue() {
    for (const auto& [key, subscription] : subscriptions_) feed_->unwant(subscription.topic);
    feed_->leave();
}

bool RosDialogue::hasRoom() const {
    return orders_.mayRequest() && out_bytes_ <= state_->limits().pending;
}

bool RosDialogue::isOverfull() const { return out_bytes_ > kMaxAnswers + largest_; }

void RosDialogue::send(web::WebMessage message) {
    out_bytes_ += message.size();
    largest_ = std::max(largest_, message.size());
    out_.push_back(std::move(message));
}

void RosDialogue::sendParts(std::vector<web::WebMessage> parts) {
    std::size_t size = 0;
    for (web::WebMessage& part : parts) {
        size += part.size();
        send(std::move(part));
    }
    largest_ = std::max(largest_, size);
}

bool RosDialogue::subscribe(std::uint32_t key, Subscription subscription) {
    unsubscribe(key);
    if (subscriptions_.size() >= kMaxSubscriptions || feed_->isFull()) return false;
    const auto topic = feed_->entries().find(subscription.topic);
    if (topic == feed_->entries().end()) return true;
    feed_->want(subscription.topic);
    keys_[subscription.topic] = key;
    Subscription& own = subscriptions_.emplace(key, std::move(subscription)).first->second;
    if (topic->second.newest) enqueue(key, own, topic->second.newest);
    return true;
}

void RosDialogue::unsubscribe(std::uint32_t key) {
    const auto found = subscriptions_.find(key);
    if (found == subscriptions_.end()) return;
    while (!found->second.queued.empty()) dropOldest(found->second);
    keys_.erase(found->second.topic);
    feed_->unwant(found->second.topic);
    subscriptions_.erase(found);
}

bool RosDialogue::adjust(std::uint32_t key, const Subscription& like) {
    const auto found = subscriptions_.find(key);
    if (found == subscriptions_.end()) return false;
    found->second.depth = like.depth;
    found->second.interval = like.interval;
    return true;
}

void RosDialogue::enqueue(std::uint32_t key, Subscription& subscription,
                          const std::shared_ptr<const RosMessage>& message) {
    if (message->number() == subscription.last) return;
    const WallTime now = std::chrono::steady_clock::now();
    const bool is_first = subscription.last == 0;
    if (!is_first && now - subscription.last_time < subscription.interval) return;
    subscription.last = message->number();
    subscription.last_time = now;
    const auto lose_oldest = [this](Subscription& of) {
        dropOldest(of);
        ++state_->losses().messages;
    };
    if (subscription.queued.size() >= subscription.depth) lose_oldest(subscription);
    while (!queue_.empty() && queue_bytes_ + message->cdr()->size() > kMaxQueue)
        lose_oldest(subscriptions_.at(queue_.front().key));
    queue_.push_back({key, message});
    queue_bytes_ += message->cdr()->size();
    subscription.queued.push_back(std::prev(queue_.end()));
}

/// Drops the oldest message of a subscription. \pre it has one
void RosDialogue::dropOldest(Subscription& subscription) {
    const auto oldest = subscription.queued.front();
    subscription.queued.pop_front();
    queue_bytes_ -= oldest->message->cdr()->size();
    queue_.erase(oldest);
}

std::optional<web::WebMessage> RosDialogue::next() {
    if (!out_.empty()) {
        web::WebMessage message = std::move(out_.front());
        out_.pop_front();
        out_bytes_ -= message.size();
        return message;
    }
    while (!queue_.empty()) {
        const auto [key, message] = queue_.front();
        Subscription& subscription = subscriptions_.at(key);
        const auto topic = feed_->entries().find(subscription.topic);
        dropOldest(subscription);
        if (topic != feed_->entries().end()) return write(key, topic->second, *message);
    }
    return std::nullopt;
}

/// Takes new messages of the feed, and adapts to its topics.
void RosDialogue::collect() {
    if (std::exchange(version_, feed_->version()) != feed_->version()) {
        std::vector<std::uint32_t> gone;
        for (const auto& [key, subscription] : subscriptions_)
            if (!feed_->entries().contains(subscription.topic)) gone.push_back(key);
        for (const std::uint32_t key : gone) unsubscribe(key);
        topicsChanged();
    }
    for (auto& [key, subscription] : subscriptions_) {
        const auto topic = feed_->entries().find(subscription.topic);
        if (topic != feed_->entries().end() && topic->second.newest)
            enqueue(key, subscription, topic->second.newest);
    }
}

void RosDialogue::stepped() {
    orders_.stepped();
    collect();
}

void RosDialogue::dismiss() {
    queue_.clear();
    queue_bytes_ = 0;
    for (auto& [key, subscription] : subscriptions_) subscription.queued.clear();
}

const RosChannel* RosDialogue::input(std::string_view topic, RosType type) const {
    for (const std::uint32_t number : feed_->numbersOf(topic)) {
        const RosChannel& channel = feed_->entries().at(number).channel;
        if (channel.isInput() && channel.type == type) return &channel;
    }
    return nullptr;
}

}  // namespace ispace::ros
