// SPDX-License-Identifier: GPL-3.0-or-later
// What Foxglove and rosbridge have in common.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/ros/ros_feed.h"
#include "extensions/ros/ros_orders.h"
#include "extensions/web/web_dialogue.h"

namespace ispace::ros {

/// A client of topics at a socket, whatever its language: subscriptions, orders, services.
///
/// Output is bounded: a slow reader loses the oldest messages of each subscription, and its
/// requests wait while it leaves answers unread.
class RosDialogue : public web::WebDialogue {
  public:
    /// \param peer address of the client
    RosDialogue(ServerState& state, RosFeed& feed, std::string peer);
    ~RosDialogue() override;

    /// Presents a token. \returns 0 if it is right, 401 if it is wrong, 429 after too many of them
    unsigned present(std::string_view token) { return orders_.present(token); }

    [[nodiscard]] std::size_t longest() const override { return std::size_t{1} << 18U; }
    [[nodiscard]] bool hasRoom() const override;
    void stepped() override;
    void proceed() override { orders_.proceed(); }
    [[nodiscard]] bool waiting() const override { return orders_.waiting(); }
    [[nodiscard]] bool waitsToChange() const override { return orders_.waitsToChange(); }
    std::optional<web::WebMessage> next() override;
    [[nodiscard]] bool isOverfull() const override;
    [[nodiscard]] bool closing() const override { return false; }
    [[nodiscard]] bool isEngaged() const override {
        return !subscriptions_.empty() || orders_.isDriving();
    }
    [[nodiscard]] bool isAwaited() const override { return true; }
    void dismiss() override;
    void finish() override { orders_.finish(); }

  protected:
    struct Queued {
        std::uint32_t key;
        std::shared_ptr<const RosMessage> message;
    };
    struct Subscription {
        std::uint32_t topic = 0;  ///< number in the feed
        std::size_t depth = 1;    ///< messages kept for a slow reader, the oldest dropped
        std::chrono::nanoseconds interval{};  ///< least wall time between two messages
        std::int64_t last = 0;                ///< number of the last message
        WallTime last_time{};
        std::deque<std::list<Queued>::const_iterator> queued = {};  ///< oldest first
    };
    enum class Level { Info = 0, Warning = 1, Error = 2 };

    /// Writes a message for the client. \param key of the subscription
    virtual web::WebMessage write(std::uint32_t key, const RosFeed::Entry& topic,
                                  const RosMessage& message) = 0;
    /// Reports a failure that answers no request.
    virtual void report(Level level, const std::string& text) = 0;
    /// Call after topics have come or gone. Subscriptions to removed topics are already gone.
    virtual void topicsChanged() = 0;

    [[nodiscard]] RosFeed& feed() { return *feed_; }
    [[nodiscard]] ServerState& state() { return *state_; }
    void send(web::WebMessage message);
    /// Sends the parts of one message.
    void sendParts(std::vector<web::WebMessage> parts);
    void sendText(std::string text) { send({.head = std::move(text)}); }
    /// Replaces an earlier subscription with this key. \returns false if there are too many
    /// \pre no other subscription has the topic
    bool subscribe(std::uint32_t key, Subscription subscription);
    void unsubscribe(std::uint32_t key);
    /// Changes depth and interval of a subscription, without sending its newest message again.
    /// \returns false if no subscription has this key
    bool adjust(std::uint32_t key, const Subscription& like);
    [[nodiscard]] bool hasSubscription(std::uint32_t key) const {
        return subscriptions_.contains(key);
    }
    /// Returns true if a subscription with another key has the topic.
    [[nodiscard]] bool readsElsewhere(std::uint32_t topic, std::uint32_t key) const {
        const auto found = keys_.find(topic);
        return found != keys_.end() && found->second != key;
    }
    /// Finds an input topic of this type; else null.
    [[nodiscard]] const RosChannel* input(std::string_view topic, RosType type) const;
    [[nodiscard]] RosOrders& orders() { return orders_; }
    /// True if answers are unsent, which come before all else.
    [[nodiscard]] bool hasAnswers() const { return !out_.empty(); }

  private:
    void collect();
    void enqueue(std::uint32_t key, Subscription& subscription,
                 const std::shared_ptr<const RosMessage>& message);
    void dropOldest(Subscription& subscription);

    ServerState* state_;
    RosFeed* feed_;
    RosOrders orders_;
    std::map<std::uint32_t, Subscription> subscriptions_;
    std::map<std::uint32_t, std::uint32_t> keys_;  // of subscriptions, by topic
    std::list<Queued> queue_;                      // oldest first
    std::size_t queue_bytes_ = 0;
    std::deque<web::WebMessage> out_;          // answers, sent before the queue
    std::size_t out_bytes_ = 0, largest_ = 0;  // of one answer so far
    std::int64_t version_;                     // of the feed's topics
};

}  // namespace ispace::ros
