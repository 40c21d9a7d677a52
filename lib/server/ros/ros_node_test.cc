// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/ros/ros_node.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "sense/formats/cdr.h"
#include "support/fake_participant.h"
#include "support/test_world.h"

namespace ispace {
namespace {

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
        dds->end(topic, type).arrived.push_back(message);
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

}  // namespace
}  // namespace ispace
