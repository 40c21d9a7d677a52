// SPDX-License-Identifier: GPL-3.0-or-later
// An action is three services and two topics (design.ros2.org, "Actions"): send_goal, get_result,
// cancel_goal, feedback, status. At most 32 goals are remembered for each robot.
#include "extensions/ros/ros_actions.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "base/error.h"
#include "extensions/ros/navigate_action.h"
#include "sense/formats/cdr.h"

namespace ispace::ros {

namespace {

constexpr std::size_t kDepth = 10;
/// Goals of an action that are remembered for their results, those under way included.
constexpr std::size_t kMostGoals = 32;
/// Requests for the result of a goal that are answered at its end.
constexpr std::size_t kMostWaiting = 16;

// Of action_msgs/srv/CancelGoal.
constexpr std::int8_t kNoError = 0, kRejected = 1, kUnknownGoal = 2, kTerminated = 3;

bool isUnderWay(std::int8_t status) { return status == kExecuting; }

void putTime(CdrWriter& out, SimTime time) {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    const std::uint64_t nanoseconds = rosTimeOf(time);
    out.put(static_cast<std::int32_t>(nanoseconds / kSecond));
    out.put(static_cast<std::uint32_t>(nanoseconds % kSecond));
}

template <typename Id>
void readId(CdrReader& in, Id& id) {
    const std::string_view bytes = in.values(id.size(), 1);
    std::copy(bytes.begin(), bytes.end(), id.begin());
}

}  // namespace

void RosActions::add(const std::string& name) {
    const std::string type = "nav2_msgs/action/NavigateToPose_", prefix = name + "/_action/";
    const auto server = [&](const char* service, const std::string& of) {
        return RosServer(*participant_, prefix + service, of);
    };
    Action action{server("send_goal", type + "SendGoal"), server("get_result", type + "GetResult"),
                  server("cancel_goal", "action_msgs/srv/CancelGoal")};
    const std::string topic = ddsTopicOf("rt", prefix);
    action.feedback = participant_->addWriter(
        {.name = topic + "feedback", .type = ddsTypeOf(type + "FeedbackMessage"), .depth = kDepth});
    action.status = participant_->addWriter({.name = topic + "status",
                                             .type = ddsTypeOf("action_msgs/msg/GoalStatusArray"),
                                             .is_latched = true});
    sendStatus(action);
    actions_.emplace(name, std::move(action));
}

void RosActions::remove(const Action& action) {
    for (const RosServer* one : {&action.send, &action.result, &action.cancel}) one->remove();
    participant_->remove(action.feedback);
    participant_->remove(action.status);
}

void RosActions::sync() {
    std::set<std::string> names;
    for (const auto& [number, entry] : feed_->entries()) {
        const std::string& topic = entry.channel.topic;
        if (entry.channel.row != nullptr && entry.channel.isInput() && topic.ends_with(kGoalTopic))
            names.insert(topic.substr(0, topic.size() - kGoalTopic.size()) +
                         std::string(kNavigate));
    }
    std::erase_if(actions_, [&](const auto& one) {
        if (names.contains(one.first)) return false;
        remove(one.second);
        return true;
    });
    for (const std::string& name : names)
        if (!actions_.contains(name) && actions_.size() < kMostActions) add(name);
}

void RosActions::addEnds(std::vector<DdsGuid>& readers, std::vector<DdsGuid>& writers) const {
    for (const auto& [name, action] : actions_) {
        for (const RosServer* one : {&action.send, &action.result, &action.cancel})
            one->addEnds(readers, writers);
        writers.push_back(participant_->guid(action.feedback));
        writers.push_back(participant_->guid(action.status));
    }
}

void RosActions::serve() {
    for (auto& named : actions_) {
        const std::string& name = named.first;
        Action& action = named.second;
        action.send.serve([&](const RosCall& call) { takeGoal(name, action, call); });
        action.result.serve([&](const RosCall& call) { takeResultRequest(action, call); });
        action.cancel.serve([&](const RosCall& call) { takeCancellation(action, call); });
    }
}

void RosActions::takeGoal(const std::string& name, Action& action, const RosCall& call) {
    CdrReader in(call.content);
    Goal goal;
    readId(in, goal.id);
    // The pose stands at a multiple of eight bytes, as in a PoseStamped alone.
    const std::string pose = std::string(call.content).erase(kCdrHead.size(), goal.id.size());
    feed_->sync();
    const std::string topic =
        name.substr(0, name.size() - kNavigate.size()) + std::string(kGoalTopic);
    const auto numbers = feed_->numbersOf(topic);
    const bool is_new = std::none_of(action.goals.begin(), action.goals.end(),
                                     [&](const Goal& one) { return one.id == goal.id; });
    bool is_accepted = false;
    goal.accepted = goal.told = state_->simulation().world().time();
    if (is_new && !numbers.empty()) {
        const RosChannel& channel = feed_->entries().at(numbers.front()).channel;
        goal.robot = orders_->robotOf(channel);
        is_accepted = orders_
                          ->pursue(channel, pose,
                                   [self = std::weak_ptr(self_), name, id = goal.id](
                                       RosGoalEnd how, const std::string& why) {
                                       if (const auto actions = self.lock())
                                           (*actions)->end(name, id, how, why);
                                   })
                          .empty();
    }
    CdrWriter answer;
    answer.put(is_accepted);
    putTime(answer, goal.accepted);
    if (is_accepted) {
        goal.status = kExecuting;
        action.goals.push_back(std::move(goal));
        if (action.goals.size() > kMostGoals) action.goals.pop_front();
    }
    action.send.answer(call.caller, answer.take());
    if (is_accepted) sendStatus(action);
}

void RosActions::takeResultRequest(Action& action, const RosCall& call) {
    CdrReader in(call.content);
    GoalId id{};
    readId(in, id);
    const auto goal = std::find_if(action.goals.begin(), action.goals.end(),
                                   [&](const Goal& one) { return one.id == id; });
    if (goal == action.goals.end()) return sendResult(action, Goal{}, call.caller);
    if (!isUnderWay(goal->status)) return sendResult(action, *goal, call.caller);
    if (goal->waiting.size() < kMostWaiting) goal->waiting.push_back(call.caller);
}

/// A goal without an id and a time is all of them, one with a time those up to then.
void RosActions::takeCancellation(Action& action, const RosCall& call) {
    CdrReader in(call.content);
    GoalId id{};
    readId(in, id);
    const SimTime time = std::chrono::seconds(in.number<std::int32_t>()) +
                         std::chrono::nanoseconds(in.number<std::uint32_t>());
    const bool is_any = id == GoalId{};
    std::vector<std::pair<GoalId, SimTime>> canceled;
    std::int8_t code = is_any ? kNoError : kUnknownGoal;
    std::vector<std::string> robots;
    for (const Goal& goal : action.goals) {
        const bool is_meant = is_any ? time == SimTime(0) || goal.accepted <= time : goal.id == id;
        if (!is_meant) continue;
        if (!isUnderWay(goal.status)) {
            if (!is_any) code = kTerminated;
            continue;
        }
        canceled.emplace_back(goal.id, goal.accepted);
        robots.push_back(goal.robot);
        code = kNoError;
    }
    for (std::size_t i = robots.size(); i-- > 0;) {
        if (orders_->cancel(robots[i]).empty()) continue;
        canceled.erase(canceled.begin() + static_cast<std::ptrdiff_t>(i));
        code = kRejected;
    }
    CdrWriter answer;
    answer.put(code).count(canceled.size());
    for (const auto& [goal, accepted] : canceled) {
        answer.array(std::span<const std::uint8_t>(goal));
        putTime(answer, accepted);
    }
    action.cancel.answer(call.caller, answer.take());
}

void RosActions::end(const std::string& name, const GoalId& id, RosGoalEnd end,
                     const std::string& why) {
    const auto found = actions_.find(name);
    if (found == actions_.end()) return;
    Action& action = found->second;
    const auto goal = std::find_if(action.goals.begin(), action.goals.end(),
                                   [&](const Goal& one) { return one.id == id; });
    if (goal == action.goals.end()) return;
    goal->status = statusOf(end);
    goal->error = why;
    sendStatus(action);
    for (const RosCaller& caller : std::exchange(goal->waiting, {}))
        sendResult(action, *goal, caller);
}

void RosActions::sendResult(const Action& action, const Goal& goal, const RosCaller& caller) {
    const std::uint16_t error = goal.status == kAborted || goal.status == kUnknown ? 1 : 0;
    action.result.answer(caller, CdrWriter().put(goal.status).put(error).put(goal.error).take());
}

void RosActions::sendFeedback(const Action& action, Goal& goal) {
    const auto progress = orders_->progress(goal.robot);
    if (!progress) return;
    constexpr double kStanding = 0.01, kNanoseconds = 1e9;
    const SimTime now = state_->simulation().world().time();
    const std::string room = state_->worlds()[progress->room].id;
    const double half = progress->pose.heading.radians() / 2;
    const double left = progress->speed > kStanding ? progress->distance / progress->speed : 0;
    CdrWriter out;
    out.array(std::span<const std::uint8_t>(goal.id));
    putTime(out, now);
    out.put(room.empty() ? std::string(kRosWorld) : rosName(room));
    out.put(progress->pose.position.x).put(progress->pose.position.y).put(0.0);
    out.put(0.0).put(0.0).put(std::sin(half)).put(std::cos(half));
    putTime(out, now - goal.accepted);
    putTime(out, SimTime(std::llround(left * kNanoseconds)));
    out.put(std::int16_t{0}).put(static_cast<float>(progress->distance));
    participant_->write(action.feedback, out.take());
    goal.told = now;
}

void RosActions::sendStatus(const Action& action) {
    CdrWriter out;
    out.count(action.goals.size());
    for (const Goal& goal : action.goals) {
        out.array(std::span<const std::uint8_t>(goal.id));
        putTime(out, goal.accepted);
        out.put(goal.status);
    }
    participant_->write(action.status, out.take());
}

void RosActions::stepped() {
    constexpr SimTime kPeriod = std::chrono::milliseconds(500);
    const SimTime now = state_->simulation().world().time();
    for (auto& [name, action] : actions_)
        for (Goal& goal : action.goals)
            if (isUnderWay(goal.status) && now - goal.told >= kPeriod) sendFeedback(action, goal);
}

}  // namespace ispace::ros
