// SPDX-License-Identifier: GPL-3.0-or-later
// Trips of robots as actions of ROS 2, for nodes over DDS. For the world's thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "extensions/ros/module/dds_participant.h"
#include "extensions/ros/ros_feed.h"
#include "extensions/ros/ros_orders.h"
#include "extensions/ros/ros_server.h"

namespace ispace::ros {

/// Nav2's action `navigate_to_pose` of each robot over DDS: three services, the topics of feedback
/// and status. A goal is one of the robot's topic `goal_pose`.
class RosActions {
  public:
    /// All outlive the actions. \param orders of the node
    RosActions(ServerState& state, RosFeed& feed, RosOrders& orders, DdsParticipant& participant)
        : state_(&state), feed_(&feed), orders_(&orders), participant_(&participant) {}
    RosActions(const RosActions&) = delete;
    RosActions& operator=(const RosActions&) = delete;
    ~RosActions() = default;

    /// Adapts to the topics of the feed.
    void sync();
    /// Reads requests that have arrived.
    void serve();
    /// Call after each step: sends feedback, twice in a simulated second.
    void stepped();
    /// Appends the ends of all actions in DDS.
    void addEnds(std::vector<DdsGuid>& readers, std::vector<DdsGuid>& writers) const;
    /// Further robots have no action.
    static constexpr std::size_t kMostActions = 256;

  private:
    using GoalId = std::array<std::uint8_t, 16>;
    struct Goal {
        GoalId id{};
        std::string robot;
        SimTime accepted{}, told{};
        std::int8_t status = 0;
        std::string error;
        std::vector<RosCaller> waiting;  ///< of requests for the result
    };
    struct Action {
        RosServer send, result, cancel;
        int feedback = 0, status = 0;
        std::deque<Goal> goals = {};  ///< in the order of their arrival
    };
    void add(const std::string& name);
    void remove(const Action& action);
    void takeGoal(const std::string& name, Action& action, const RosCall& call);
    void takeResultRequest(Action& action, const RosCall& call);
    void takeCancellation(Action& action, const RosCall& call);
    void end(const std::string& name, const GoalId& id, RosGoalEnd end, const std::string& why);
    void sendResult(const Action& action, const Goal& goal, const RosCaller& caller);
    void sendFeedback(const Action& action, Goal& goal);
    void sendStatus(const Action& action);

    ServerState* state_;
    RosFeed* feed_;
    RosOrders* orders_;
    DdsParticipant* participant_;
    std::map<std::string, Action> actions_;  // by name: "/r1/navigate_to_pose"
    // Guards ends of goals that outlive this.
    std::shared_ptr<RosActions*> self_ = std::make_shared<RosActions*>(this);
};

}  // namespace ispace::ros
