// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/nodes/nodes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/nodes/node_network.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/session.h"

namespace ispace::nodes {
namespace nodes_test {

constexpr std::string_view kRoom = R"(#env 1
fence path=-3,-3;3,-3;3,3;-3,3 closed=yes
inside at=0,0
)";

Scene sceneOf(const std::string& layout) {
    static const bool added = [] {
        addSceneSchemas(nodeSchemas());
        return true;
    }();
    EXPECT_TRUE(added);
    const Document placed = readRecordText("#3dm 1\n" + layout, "room.3dm", sceneSchemas());
    return makeScene(readRecordText(kRoom, "room.env", sceneSchemas()), &placed, shippedDevices());
}

const std::string kLasers =
    "laser id=l1 at=-2,0 fov=180 rate=10\nlaser id=l2 at=2,0 heading=180 fov=180 rate=10\n";

std::string failureOf(const std::string& layout) {
    try {
        nodesOf(sceneOf(layout), "");
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

TEST(NodeRecord, IsReadWithUnits) {
    const Scene scene =
        sceneOf(kLasers +
                "node id=n1 sensors=l1,l2 delay=20ms,5ms loss=1% skew=50ppm offset=0.5 rate=100\n"
                "node id=hub lockstep=yes\n");
    const std::vector<Node> nodes = nodesOf(scene, "ground/");
    ASSERT_EQ(nodes.size(), 2U);
    EXPECT_EQ(nodes[0].id, "ground/n1");
    EXPECT_EQ(nodes[0].sensors, (std::vector<std::string>{"ground/l1", "ground/l2"}));
    EXPECT_DOUBLE_EQ(nodes[0].delay, 0.02);
    EXPECT_DOUBLE_EQ(nodes[0].jitter, 0.005);
    EXPECT_DOUBLE_EQ(nodes[0].loss, 0.01);
    EXPECT_DOUBLE_EQ(nodes[0].skew, 50e-6);
    EXPECT_EQ(nodes[0].rate, 100);
    EXPECT_FALSE(nodes[0].lockstep);
    EXPECT_TRUE(nodes[1].lockstep);
    EXPECT_DOUBLE_EQ(nodes[0].clock(std::chrono::seconds(100)), 0.5 + 100 * (1 + 50e-6));
}

TEST(NodeRecord, ContradictionsAreErrorsAtTheRecord) {
    EXPECT_NE(failureOf(kLasers + "node sensors=l1,l3\n").find("no placed sensor"),
              std::string::npos);
    EXPECT_NE(failureOf(kLasers + "node sensors=l1\nnode id=b sensors=l1\n").find("already"),
              std::string::npos);
    EXPECT_NE(failureOf("node delay=0,1ms\n").find("a deviation needs a mean"), std::string::npos);
    EXPECT_NE(failureOf("node skew=fast\n").find("millionths"), std::string::npos);
    EXPECT_EQ(failureOf(kLasers + "node sensors=\"l1, l2\"\n"), "");
    EXPECT_NE(failureOf(kLasers + "node sensors=l9\n").find("room.3dm:4"), std::string::npos);
}

TEST(NodeRecord, WorldTimeIsTheInverseOfTheClock) {
    const Node node{.id = "n", .skew = -3e-4, .offset = 2};
    for (const double at : {2.0, 2.1, 2.3, 17.25, 4000.125}) {
        const auto time = node.worldTime(at);
        ASSERT_TRUE(time);
        EXPECT_GE(node.clock(*time), at - 0.5e-6);
        if (*time > SimTime(1)) {
            EXPECT_LT(node.clock(*time - SimTime(1000)), at);
        }
    }
    EXPECT_FALSE(node.worldTime(1.9));
    EXPECT_FALSE(node.worldTime(1e30));
    EXPECT_FALSE(node.worldTime(std::nan("")));
}

NodeNetwork networkOf(const Node& node, std::uint64_t seed = 1) {
    return {{node, Node{.id = "other"}}, seed};
}

TEST(NodeNetwork, DelaysHaveMeanAndDeviationAndLossesTheirShare) {
    NodeNetwork network = networkOf({.id = "n", .delay = 0.02, .jitter = 0.005, .loss = 0.1});
    constexpr int kCount = 5000;
    for (int i = 0; i < kCount; ++i) network.send(0, "x", SimTime(0));
    double sum = 0, squares = 0;
    const auto all = network.arrived(std::chrono::seconds(10));
    for (const NodeMessage& message : all) {
        const double delay = seconds(message.arrival);
        EXPECT_GT(delay, 0);
        sum += delay;
        squares += delay * delay;
    }
    const auto count = static_cast<double>(all.size());
    const double mean = sum / count;
    EXPECT_NEAR(count / kCount, 0.9, 4 * std::sqrt(0.09 / kCount));
    EXPECT_NEAR(mean, 0.02, 4 * 0.005 / std::sqrt(count));
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 0.005, 0.0004);
    EXPECT_EQ(network.tally(0).sent, kCount);
    EXPECT_EQ(network.tally(0).lost, kCount - static_cast<int>(all.size()));
}

TEST(NodeNetwork, ArrivesInOrderAndOnce) {
    NodeNetwork network = networkOf({.id = "n", .delay = 0.1, .jitter = 0.1});
    for (int i = 0; i < 100; ++i) network.send(0, std::to_string(i), std::chrono::milliseconds(i));
    std::size_t count = 0;
    SimTime last{};
    bool overtakes = false;
    std::int64_t number = 0;
    for (int ms = 0; ms <= 5000; ms += 5)
        for (const NodeMessage& message : network.arrived(std::chrono::milliseconds(ms))) {
            EXPECT_LE(message.arrival, std::chrono::milliseconds(ms));
            EXPECT_GT(message.arrival, std::chrono::milliseconds(ms - 5));
            EXPECT_GE(message.arrival, last);
            last = message.arrival;
            overtakes = overtakes || message.number < number;
            number = message.number;
            EXPECT_EQ(message.text, std::to_string(message.number - 1));
            ++count;
        }
    EXPECT_EQ(count, 100U);
    EXPECT_TRUE(overtakes);
}

TEST(NodeNetwork, DependsOnSeedNodeAndNumberAlone) {
    const Node node{.id = "n", .delay = 0.1, .jitter = 0.05, .loss = 0.2};
    const auto arrivals = [](NodeNetwork network, bool others) {
        std::vector<SimTime> times;
        for (int i = 0; i < 50; ++i) {
            if (others) network.send(1, "y", SimTime(0));
            network.send(0, "x", SimTime(0));
        }
        for (const NodeMessage& message : network.arrived(std::chrono::seconds(9)))
            if (message.from == 0) times.push_back(message.arrival);
        return times;
    };
    EXPECT_EQ(arrivals(networkOf(node), false), arrivals(networkOf(node), true));
    EXPECT_NE(arrivals(networkOf(node), false), arrivals(networkOf(node, 2), false));
}

TEST(NodeNetwork, ALineOfARateQueuesAndDrops) {
    NodeNetwork network = networkOf({.id = "n", .rate = 10});
    for (int i = 0; i < 30; ++i) network.send(0, "x", SimTime(0));
    const auto all = network.arrived(std::chrono::seconds(9));
    ASSERT_EQ(all.size(), 11U);  // the queue is a second long
    for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_NEAR(seconds(all[i].arrival), 0.1 * static_cast<double>(i + 1), 1e-6);
    EXPECT_EQ(network.tally(0).dropped, 19);
}

/// A world with nodes that talk by the sessions of a server.
class NodesTest : public ::testing::Test {
  protected:
    explicit NodesTest(const std::string& nodes =
                           "node id=n1 sensors=l1 delay=20ms skew=1000ppm\n"
                           "node id=hub lockstep=yes\n")
        : scene_(sceneOf(kLasers + nodes)),
          world_(scene_, std::chrono::milliseconds(5)),
          simulation_(world_, {}, parseClock("step"), std::nullopt),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makeNodes({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
    }

    std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }
    void step(int count, const std::vector<Session*>& sessions) {
        for (int i = 0; i < count; ++i) {
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), std::chrono::seconds(1));
            service_->stepped();
            for (Session* const session : sessions) session->proceed();
        }
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
    ServerState state_;
    RunRoom room_;
    std::unique_ptr<RoleService> service_;
};

TEST_F(NodesTest, ReadsItsSensorsByItsClock) {
    Session node(state_);
    EXPECT_EQ(ask(node, "NODE n1"), "OK NODE n1 t=0.000000 sensors=l1 lockstep=0\n");
    step(200, {&node});
    EXPECT_EQ(ask(node, "TIME"), "OK TIME t=1.001000\n");
    EXPECT_EQ(ask(node, "SCAN l1").substr(0, 27), "SCAN l1 t=1.001000 seq=10 a");
    EXPECT_EQ(ask(node, "SCAN l2").substr(0, 8), "ERR 404 ");
    EXPECT_EQ(ask(node, "STREAM l1 every=2"), "OK STREAM l1 every=2\n");
    step(20, {&node});
    EXPECT_EQ(node.take(), "");
    step(20, {&node});
    EXPECT_EQ(node.take().substr(0, 26), "SCAN l1 t=1.201200 seq=12 ");
    EXPECT_EQ(ask(node, "STOP"), "OK STOP\n");
    step(80, {&node});
    EXPECT_EQ(node.take(), "");
}

TEST_F(NodesTest, OneProgramANode) {
    auto first = std::make_unique<Session>(state_);
    Session second(state_);
    ask(*first, "NODE n1");
    EXPECT_EQ(ask(second, "NODE n1"), "ERR 409 node `n1` is held by another client\n");
    EXPECT_EQ(ask(second, "NODE n2"), "ERR 404 no node `n2`, did you mean `n1`?\n");
    first.reset();
    EXPECT_EQ(ask(second, "NODE n1").substr(0, 10), "OK NODE n1");
    EXPECT_NE(ask(second, "HELP").find("SEND text"), std::string::npos);
}

TEST_F(NodesTest, MessagesArriveAfterTheirDelay) {
    Session node(state_), hub(state_);
    ask(node, "NODE n1");
    ask(hub, "NODE hub");
    EXPECT_EQ(ask(hub, "HEAR n1"), "OK HEAR t=0.000000\n");
    EXPECT_EQ(ask(node, "SEND two  words"), "OK SEND n=1\n");
    step(3, {&node, &hub});
    EXPECT_EQ(hub.take(), "");
    step(1, {&node, &hub});
    EXPECT_EQ(hub.take(), "EVENT message t=0.020000 from=n1 n=1 text=two  words\n");
    EXPECT_EQ(node.take(), "");
    EXPECT_EQ(ask(hub, "HEAR n7").substr(0, 8), "ERR 404 ");
}

TEST_F(NodesTest, AwaitAnswersInTimeAndLockstepHoldsTheWorld) {
    EXPECT_TRUE(service_->holdsWorld());  // before its program has come
    EXPECT_EQ(service_->waitsFor(), "the programs of nodes in lockstep: hub");
    auto hub = std::make_unique<Session>(state_);
    ask(*hub, "NODE hub");
    EXPECT_TRUE(service_->holdsWorld());
    EXPECT_EQ(ask(*hub, "AWAIT 0.0125"), "");
    EXPECT_TRUE(hub->waiting());
    EXPECT_FALSE(service_->holdsWorld());
    step(2, {hub.get()});
    EXPECT_EQ(hub->take(), "");
    EXPECT_FALSE(service_->holdsWorld());
    step(1, {hub.get()});
    EXPECT_EQ(hub->take(), "OK AWAIT t=0.015000\n");
    EXPECT_TRUE(service_->holdsWorld());
    EXPECT_EQ(ask(*hub, "AWAIT 0.01"), "OK AWAIT t=0.015000\n");
    EXPECT_TRUE(service_->holdsWorld());
    EXPECT_EQ(ask(*hub, "AWAIT soon").substr(0, 8), "ERR 416 ");
    EXPECT_EQ(ask(*hub, "AWAIT 9"), "");
    hub->finish();
    EXPECT_EQ(hub->take(), "ERR 405 the run has ended\n");
    hub.reset();
    EXPECT_FALSE(service_->holdsWorld());
}

TEST_F(NodesTest, TracksAreToldByWorldAndNodes) {
    Session node(state_), world(state_);
    ask(node, "NODE n1");
    ask(world, "WORLD");
    step(200, {&node, &world});
    EXPECT_EQ(ask(world, "TRACK 3 1.25,-0.5 t=0.9 kind=person"), "OK TRACK t=1.000\n");
    EXPECT_EQ(ask(node, "TRACK a 1,2"), "OK TRACK t=1.000\n");
    const auto present = simulation_.tracks().present(world_.time());
    ASSERT_EQ(present.size(), 2U);
    std::string rows;
    for (const ToldTrack* const track : present) appendTrackRow(rows, *track);
    EXPECT_EQ(rows, "0.9,3,person,1.250,-0.500,,1\n1.001,n1/a,,1.000,2.000,n1,1\n");
    for (const char* const bad : {"TRACK 3 1", "TRACK 3 1,x", "TRACK 3 1,2 kind=cat",
                                  "TRACK 3 1e9,2", "TRACK a,b 1,2", "TRACK 3 1,2 t=nan"})
        EXPECT_EQ(ask(world, bad).substr(0, 8), "ERR 400 ") << bad;
    EXPECT_EQ(ask(world, "TRACK 3").substr(0, 8), "ERR 400 ");
    step(201, {});
    EXPECT_TRUE(simulation_.tracks().present(world_.time()).empty());
}

}  // namespace nodes_test
}  // namespace ispace::nodes
