// SPDX-License-Identifier: GPL-3.0-or-later
// The run as a node of ROS 2.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/ros/module/dds_participant.h"
#include "extensions/ros/ros_actions.h"
#include "extensions/ros/ros_feed.h"
#include "extensions/ros/ros_orders.h"
#include "extensions/ros/ros_server.h"

namespace ispace::ros {

/// The running world as a node of ROS 2, over DDS. Only topics with readers are computed.
///
/// All publishers of orders count as one client. Orders that cannot be read or carried out are
/// dropped, and requests of services then get no answer.
class RosNode {
  public:
    /// Opens the module of DDS. \throws FormatError naming the package if there is none,
    /// std::runtime_error
    RosNode(ServerState& state, RosFeed& feed, const DdsSettings& settings);
    RosNode(ServerState& state, RosFeed& feed, std::unique_ptr<DdsParticipant> participant);
    RosNode(const RosNode&) = delete;
    RosNode& operator=(const RosNode&) = delete;
    ~RosNode();

    /// Call after each step or change of the world.
    void stepped();
    /// Call between steps: reads messages that have arrived.
    void serve();
    [[nodiscard]] bool waiting() const { return orders_.waiting(); }
    [[nodiscard]] bool waitsToChange() const { return orders_.waitsToChange(); }
    /// Time at which serve() has messages to send; empty without any.
    [[nodiscard]] std::optional<WallTime> nextSend() const {
        return has_unsent_ ? std::optional(next_send_) : std::nullopt;
    }
    /// Leaves the network.
    void end();
    /// More topics of the feed are left out: sensors come before states of things.
    static constexpr std::size_t kMostTopics = 4096;
    /// Returns the number of topics that are left out now.
    [[nodiscard]] std::size_t leftOut() const { return left_out_; }

  private:
    /// The writer or reader of a topic of the feed.
    struct End {
        int number = 0;  ///< in DDS
        bool is_input = false;
        bool is_wanted = false;
        std::int64_t last = 0;  ///< number of the last message
    };
    struct Service {
        RosServer server;
        std::function<void(const RosServer& server, const RosCall& call)> serve;
    };
    void addServices();
    void sync();
    void add(std::uint32_t topic, const RosChannel& channel);
    void notifyGraph();
    void lookForReaders();
    void send();
    void takeOrders();
    void carryOut(const std::string& request, const RosServer& server, const RosCaller& caller);
    void set(const RosServer& server, const RosCall& call, bool is_atomic);

    RosFeed* feed_;
    RosOrders orders_;
    std::unique_ptr<DdsParticipant> participant_;  // null after end()
    std::map<std::uint32_t, End> ends_;            // by number in the feed
    std::vector<Service> services_;
    std::optional<RosActions> actions_;  // empty after end()
    std::uint32_t turn_ = 0;             // topic that is the first to be sent
    bool has_unsent_ = false;
    WallTime next_send_{};
    std::size_t left_out_ = 0;
    int graph_ = 0;              // writer of the node's description
    std::int64_t version_ = -1;  // of the feed's topics
    // Guards answers that outlive the node.
    std::shared_ptr<RosNode*> self_ = std::make_shared<RosNode*>(this);
};

}  // namespace ispace::ros
