// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "extensions/ros/tests/fake_participant.h"
#include "sense/formats/cdr.h"
#include "support/test_world.h"

namespace ispace::ros {
namespace ros_node_test {

/// A world in steps of 0.1 s with a node.
struct Noded {
    explicit Noded(const ServerLimits& limits = {}, Clock::Kind clock = Clock::Kind::Step)
        : room({clock, 1}), state(room.simulation, limits), feed(state, {}) {
        auto made = std::make_unique<testing::FakeParticipant>();
        dds = made.get();
        node.emplace(state, feed, std::move(made));
    }
    void step(int count = 1) {
        room.simulation.allow(count);
        for (int i = 0; i < count; ++i) {
            room.simulation.run({}, std::chrono::nanoseconds(0));
            state.collect();
            node->stepped();
            node->serve();
        }
    }
    void send(const std::string& topic, const std::string& message, const std::string& type = "") {
        dds->end(topic, type).arrived.push_back({message});
        dds->is_changed = true;
        node->serve();
    }
    /// Sends a request with the head of Cyclone's nodes and returns the answers.
    std::vector<std::string> call(const std::string& service) {
        CdrWriter request;
        request.put(std::uint64_t{7}).put(std::int64_t{9}).put(std::uint8_t{0});
        send("rq/" + service + "Request", request.take());
        for (int i = 0; i < 1000 && node->waiting(); ++i) {
            state.collect();
            node->serve();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return dds->end("rr/" + service + "Reply").sent;
    }

    testing::TestWorld room;
    ServerState state;
    RosFeed feed;
    testing::FakeParticipant* dds = nullptr;
    std::optional<RosNode> node;
};

std::string twist(double forward) {
    CdrWriter out;
    for (const double value : {forward, 0.0, 0.0, 0.0, 0.0, 0.0}) out.put(value);
    return out.take();
}

TEST(RosNode, HasTheNamesOfRos) {
    const Noded noded;
    const DdsTopic& scan = noded.dds->end("rt/l2/scan").topic;
    EXPECT_EQ(scan.type, "sensor_msgs::msg::dds_::LaserScan_");
    EXPECT_EQ(scan.user_data.substr(0, 24), "typehash=RIHS01_64c19139");
    EXPECT_EQ(scan.depth, 5U);
    EXPECT_FALSE(scan.is_latched);
    EXPECT_TRUE(noded.dds->end("rt/map").topic.is_latched);
    EXPECT_TRUE(noded.dds->end("rt/tf_static").topic.is_latched);
    EXPECT_FALSE(noded.dds->end("rt/r1/cmd_vel").topic.is_reliable) << "accepts any writer";
    EXPECT_EQ(noded.dds->end("rq/resetRequest").topic.type, "std_srvs::srv::dds_::Empty_Request_");
    EXPECT_EQ(noded.dds->end("rr/pauseReply").topic.type, "std_srvs::srv::dds_::Empty_Response_");
    const auto& graph = noded.dds->end("ros_discovery_info");
    ASSERT_EQ(graph.sent.size(), 1U);
    EXPECT_NE(graph.sent[0].find("simrun"), std::string::npos);
}

TEST(RosNode, LeavesOutTopicsThatAreTooMany) {
    Noded noded;
    EXPECT_EQ(noded.node->leftOut(), 0U);
    std::string lamps;
    for (int i = 0; i < 800; ++i) lamps += "lamp id=k" + std::to_string(i) + " at=1,1\n";
    noded.room.world.change(
        testing::scene("ispace size=8,6\n" + lamps, "robot id=r1 at=0,0\nlaser id=l2 at=2,2\n"));
    noded.state.sync();
    noded.step();
    EXPECT_GT(noded.node->leftOut(), 100U);
    EXPECT_EQ(noded.dds->end("rt/l2/scan").topic.depth, 5U) << "sensors come first";
    noded.room.world.change(testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n"));
    noded.state.sync();
    noded.step();
    EXPECT_EQ(noded.node->leftOut(), 0U);
}

TEST(RosNode, ComputesTopicsWithReaders) {
    Noded noded;
    auto& clock = noded.dds->end("rt/clock");
    noded.step(3);
    EXPECT_TRUE(clock.sent.empty());
    clock.is_read = noded.dds->is_changed = true;
    noded.node->serve();
    EXPECT_EQ(clock.sent.size(), 1U) << "at once";
    noded.step(3);
    EXPECT_EQ(clock.sent.size(), 4U);
    clock.is_read = false;
    noded.dds->is_changed = true;
    noded.step(3);
    EXPECT_EQ(clock.sent.size(), 5U) << "one before the reader is missed";
}

TEST(RosNode, DrivesByBothTypesAndStopsAlone) {
    Noded noded;
    noded.send("rt/r1/cmd_vel", twist(0.3), "geometry_msgs::msg::dds_::Twist_");
    noded.step(5);
    EXPECT_GT(noded.room.world.status(0).speed, 0);
    noded.step(30);
    EXPECT_EQ(noded.room.world.status(0).speed, 0);
    for (const std::string& broken :
         {std::string(), std::string("\0\1\0\0", 4), twist(0.3).substr(0, 40)})
        noded.send("rt/r1/cmd_vel", broken, "geometry_msgs::msg::dds_::TwistStamped_");
    noded.send("rt/r2/initialpose", std::string("\0\1\0\0\xff\xff\xff\x7f", 8));
    noded.step(5);
    EXPECT_EQ(noded.room.world.status(0).speed, 0) << "no orders";
}

TEST(RosNode, AnswersWithTheHeaderOfTheRequest) {
    Noded noded({}, Clock::Kind::Real);
    const auto answers = noded.call("pause");
    ASSERT_EQ(answers.size(), 1U);
    CdrReader in(answers[0]);
    EXPECT_EQ(in.number<std::uint64_t>(), 7U);
    EXPECT_EQ(in.number<std::int64_t>(), 9);
    EXPECT_EQ(answers[0].size(), 4U + 16U + 1U);
    EXPECT_TRUE(noded.room.simulation.paused());
    // Carried out without a header, but not answered.
    noded.send("rq/resumeRequest", std::string("\0\1\0\0\0", 5));
    EXPECT_FALSE(noded.room.simulation.paused());
    EXPECT_TRUE(noded.dds->end("rr/resumeReply").sent.empty());
    noded.send("rq/resumeRequest", "");
}

TEST(RosNode, AnswersByTheIdentityOfTheRequest) {
    Noded noded({}, Clock::Kind::Real);
    auto& requests = noded.dds->end("rq/pauseRequest");
    const auto& answers = noded.dds->end("rr/pauseReply");
    requests.arrived.push_back({std::string("\0\1\0\0\0", 5), DdsRequest{{3}, 12}});
    noded.dds->is_changed = true;
    noded.node->serve();
    EXPECT_TRUE(noded.room.simulation.paused());
    EXPECT_TRUE(answers.sent.empty());
    ASSERT_EQ(answers.answers.size(), 1U);
    EXPECT_EQ(answers.answers[0].first.reader, DdsGuid{3});
    EXPECT_EQ(answers.answers[0].first.number, 12);
    EXPECT_EQ(answers.answers[0].second, std::string("\0\1\0\0\0", 5)) << "no header";
}

TEST(RosNode, LeavesRequestsUnansweredThatNeedAToken) {
    ServerLimits limits;
    limits.token = "secret";
    limits.token_first = true;
    Noded noded(limits, Clock::Kind::Real);
    constexpr int kMoreThanPending = 40;
    for (int i = 0; i < kMoreThanPending; ++i) EXPECT_TRUE(noded.call("pause").empty());
    EXPECT_FALSE(noded.room.simulation.paused());
}

TEST(RosNode, EndsOnce) {
    Noded noded;
    noded.node->end();
    noded.node->stepped();
    noded.node->serve();
    noded.node->end();
    EXPECT_FALSE(noded.node->waiting());
    EXPECT_FALSE(noded.node->nextSend().has_value());
}

/// Bytes of a request with the head of Cyclone's nodes, or of the answer to it.
CdrWriter request() {
    CdrWriter out;
    out.put(std::uint64_t{7}).put(std::int64_t{9});
    return out;
}

std::array<std::uint8_t, 16> goalId(std::uint8_t number) { return {number, 1}; }

std::string goalRequest(std::uint8_t number, double x, double y) {
    CdrWriter out = request();
    out.array(std::span<const std::uint8_t>(goalId(number)));
    out.put(std::int32_t{0}).put(std::uint32_t{0}).put("map");
    for (const double value : {x, y, 0.0, 0.0, 0.0, 0.0, 1.0}) out.put(value);
    return out.put("").take();
}

std::string idRequest(std::uint8_t number, bool has_time) {
    CdrWriter out = request();
    out.array(std::span<const std::uint8_t>(goalId(number)));
    if (has_time) out.put(std::int32_t{0}).put(std::uint32_t{0});
    return out.take();
}

CdrReader answerOf(const std::string& message) {
    CdrReader in(message);
    EXPECT_EQ(in.number<std::uint64_t>(), 7U);
    EXPECT_EQ(in.number<std::int64_t>(), 9);
    return in;
}

/// The action of r2.
struct Acting : Noded {
    static std::string side(const std::string& service, bool is_request) {
        return std::string(is_request ? "rq" : "rr") + "/r2/navigate_to_pose/_action/" + service +
               (is_request ? "Request" : "Reply");
    }
    void ask(const std::string& service, const std::string& message) {
        send(side(service, true), message);
    }
    [[nodiscard]] std::vector<std::string>& answers(const std::string& service) {
        return dds->end(side(service, false)).sent;
    }
    [[nodiscard]] std::vector<std::string>& told(const std::string& topic) {
        return dds->end("rt/r2/navigate_to_pose/_action/" + topic).sent;
    }
    /// Returns the newest status of the last goal.
    int status() {
        CdrReader in(told("status").back());
        int newest = -1;
        for (std::size_t left = in.count(); left > 0; --left) {
            in.values(16, 1);
            in.number<std::int32_t>();
            in.number<std::uint32_t>();
            newest = in.number<std::int8_t>();
        }
        return newest;
    }
};

TEST(RosActions, HaveTheNamesOfRos) {
    Acting acting;
    EXPECT_EQ(acting.dds->end(Acting::side("send_goal", true)).topic.type,
              "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Request_");
    EXPECT_EQ(acting.dds->end(Acting::side("get_result", false)).topic.type,
              "nav2_msgs::action::dds_::NavigateToPose_GetResult_Response_");
    EXPECT_EQ(acting.dds->end(Acting::side("cancel_goal", true)).topic.type,
              "action_msgs::srv::dds_::CancelGoal_Request_");
    EXPECT_EQ(acting.dds->end("rt/r2/navigate_to_pose/_action/feedback").topic.type,
              "nav2_msgs::action::dds_::NavigateToPose_FeedbackMessage_");
    const DdsTopic& status = acting.dds->end("rt/r2/navigate_to_pose/_action/status").topic;
    EXPECT_EQ(status.type, "action_msgs::msg::dds_::GoalStatusArray_");
    EXPECT_TRUE(status.is_latched);
    EXPECT_FALSE(acting.dds->has("rq/navigate_to_pose/_action/send_goalRequest")) << "two robots";
}

TEST(RosActions, LeadARobotToItsGoal) {
    Acting acting;
    acting.ask("send_goal", goalRequest(1, -2, -1));
    ASSERT_EQ(acting.answers("send_goal").size(), 1U);
    EXPECT_EQ(answerOf(acting.answers("send_goal")[0]).number<std::uint8_t>(), 1) << "accepted";
    EXPECT_EQ(acting.status(), 2) << "under way";
    acting.ask("get_result", idRequest(1, false));
    EXPECT_TRUE(acting.answers("get_result").empty()) << "not before the end";
    acting.step(400);
    EXPECT_EQ(acting.status(), 4);
    ASSERT_EQ(acting.answers("get_result").size(), 1U);
    CdrReader result = answerOf(acting.answers("get_result")[0]);
    EXPECT_EQ(result.number<std::int8_t>(), 4);
    EXPECT_EQ(result.number<std::uint16_t>(), 0);
    EXPECT_EQ(result.text(), "");
    ASSERT_GT(acting.told("feedback").size(), 5U);
    CdrReader feedback(acting.told("feedback")[0]);
    EXPECT_EQ(feedback.values(16, 1)[0], '\1');
    feedback.number<std::int32_t>();
    feedback.number<std::uint32_t>();
    EXPECT_EQ(feedback.text(), "map");
    for (int i = 0; i < 7; ++i) feedback.number<double>();
    for (int i = 0; i < 4; ++i) feedback.number<std::uint32_t>();  // two durations
    EXPECT_EQ(feedback.number<std::int16_t>(), 0);
    EXPECT_GT(feedback.number<float>(), 1.F);
    acting.ask("get_result", idRequest(1, false));
    EXPECT_EQ(acting.answers("get_result").size(), 2U) << "again, at once";
    acting.ask("get_result", idRequest(9, false));
    EXPECT_EQ(answerOf(acting.answers("get_result").back()).number<std::int8_t>(), 0) << "unknown";
}

TEST(RosActions, RefuseReplaceAndCancel) {
    Acting acting;
    acting.ask("send_goal", goalRequest(1, 40, 0));
    EXPECT_EQ(answerOf(acting.answers("send_goal")[0]).number<std::uint8_t>(), 0) << "no way";
    acting.ask("send_goal", "short");
    EXPECT_EQ(acting.answers("send_goal").size(), 1U);
    acting.ask("send_goal", goalRequest(2, -2, -1));
    acting.step(5);
    acting.ask("send_goal", goalRequest(3, 3, 1));
    EXPECT_EQ(acting.status(), 2);
    acting.ask("get_result", idRequest(2, false));
    CdrReader replaced = answerOf(acting.answers("get_result").back());
    EXPECT_EQ(replaced.number<std::int8_t>(), 6);
    EXPECT_EQ(replaced.number<std::uint16_t>(), 1);
    EXPECT_NE(replaced.text(), "");
    acting.ask("cancel_goal", idRequest(9, true));
    EXPECT_EQ(answerOf(acting.answers("cancel_goal").back()).number<std::int8_t>(), 2) << "unknown";
    acting.ask("cancel_goal", idRequest(3, true));
    CdrReader canceled = answerOf(acting.answers("cancel_goal").back());
    EXPECT_EQ(canceled.number<std::int8_t>(), 0);
    ASSERT_EQ(canceled.count(), 1U);
    EXPECT_EQ(canceled.values(16, 1)[0], '\3');
    EXPECT_EQ(acting.status(), 5);
    acting.ask("cancel_goal", idRequest(3, true));
    EXPECT_EQ(answerOf(acting.answers("cancel_goal").back()).number<std::int8_t>(), 3) << "over";
}

TEST(RosQueries, ListAndDescribeParameters) {
    Noded noded;
    const auto ask = [&](const std::string& service, const std::string& message) {
        noded.send("rq/simrun/" + service + "Request", message);
        return answerOf(noded.dds->end("rr/simrun/" + service + "Reply").sent.back());
    };
    EXPECT_EQ(noded.dds->end("rq/simrun/list_parametersRequest").topic.type,
              "rcl_interfaces::srv::dds_::ListParameters_Request_");
    CdrReader list = ask("list_parameters", request().count(0).put(std::uint64_t{0}).take());
    std::vector<std::string> names;
    for (std::size_t left = list.count(); left > 0; --left) names.emplace_back(list.text());
    EXPECT_NE(std::find(names.begin(), names.end(), "clock.rate"), names.end());
    EXPECT_NE(std::find(names.begin(), names.end(), "r1.at"), names.end());
    CdrReader some =
        ask("list_parameters", request().count(1).put("r1").put(std::uint64_t{0}).take());
    EXPECT_EQ(some.count(), 2U);
    EXPECT_EQ(some.text(), "r1.at");
    EXPECT_EQ(some.text(), "r1.heading");
    EXPECT_EQ(some.count(), 1U);
    EXPECT_EQ(some.text(), "r1");
    CdrReader described =
        ask("describe_parameters", request().count(2).put("clock.paused").put("none").take());
    EXPECT_EQ(described.count(), 2U);
    EXPECT_EQ(described.text(), "clock.paused");
    EXPECT_EQ(described.number<std::uint8_t>(), 1);
    EXPECT_NE(described.text(), "");
    CdrReader types = ask("get_parameter_types",
                          request().count(3).put("clock.rate").put("r1.at").put("none").take());
    EXPECT_EQ(types.values(types.count(), 1), std::string_view("\3\10\0", 3));
    CdrReader values = ask("get_parameters", request().count(1).put("clock.rate").take());
    EXPECT_EQ(values.count(), 1U);
    EXPECT_EQ(values.number<std::uint8_t>(), 3);
    values.number<std::uint8_t>();
    values.number<std::int64_t>();
    EXPECT_EQ(values.number<double>(), 1.0);
}

/// Appends a parameter and its value, a field of each type.
void putParameter(CdrWriter& out, const std::string& name, std::uint8_t type, bool flag,
                  double number, const std::vector<double>& numbers) {
    out.put(name).put(type).put(flag).put(std::int64_t{5}).put(number).put("text");
    out.count(0).count(0).count(1).put(std::int64_t{5});
    out.sequence<double>(numbers).count(1).put("text");
}

/// Returns the reasons why parameters are not set, "" for those that are.
std::vector<std::string> setResults(const std::string& message, bool is_list) {
    CdrReader in = answerOf(message);
    std::vector<std::string> reasons;
    for (std::size_t left = is_list ? in.count() : 1; left > 0; --left) {
        const bool is_done = in.number<std::uint8_t>() != 0;
        reasons.emplace_back(in.text());
        EXPECT_EQ(is_done, reasons.back().empty());
    }
    return reasons;
}

/// Sets some parameters, and others that cannot be set.
std::vector<std::string> setSome(Noded& noded) {
    CdrWriter out = request();
    out.count(4);
    putParameter(out, "clock.paused", 1, true, 0, {});
    putParameter(out, "none", 1, true, 0, {});
    putParameter(out, "r1.at", 2, true, 0, {1, 1});
    putParameter(out, "r1.at", 8, true, 0, {1, -1});
    noded.send("rq/simrun/set_parametersRequest", out.take());
    return setResults(noded.dds->end("rr/simrun/set_parametersReply").sent.back(), true);
}

TEST(RosQueries, SetParameters) {
    Noded noded({}, Clock::Kind::Real);
    const auto reasons = setSome(noded);
    EXPECT_EQ(reasons[0], "");
    EXPECT_TRUE(noded.room.simulation.paused());
    EXPECT_EQ(reasons[1], "there is no parameter `none`");
    EXPECT_EQ(reasons[2], "`r1.at` is a list of 2 numbers") << "an integer";
    EXPECT_EQ(reasons[3], "clients may not change the world of this run");

    ServerLimits limits;
    limits.token = "secret";
    Noded guarded(limits, Clock::Kind::Real);
    EXPECT_EQ(setSome(guarded)[0], "nodes do not know the token of this run");
    EXPECT_FALSE(guarded.room.simulation.paused());
}

TEST(RosQueries, SetParametersAtomicallyOneByOne) {
    Noded noded({}, Clock::Kind::Real);
    const auto set = [&](std::uint32_t count) {
        CdrWriter out = request();
        out.count(count);
        for (std::uint32_t i = 0; i < count; ++i) putParameter(out, "clock.paused", 1, true, 0, {});
        noded.send("rq/simrun/set_parameters_atomicallyRequest", out.take());
        return setResults(noded.dds->end("rr/simrun/set_parameters_atomicallyReply").sent.back(),
                          false)[0];
    };
    EXPECT_NE(set(2), "");
    EXPECT_FALSE(noded.room.simulation.paused());
    EXPECT_EQ(set(1), "");
    EXPECT_TRUE(noded.room.simulation.paused());
}

}  // namespace ros_node_test
}  // namespace ispace::ros
