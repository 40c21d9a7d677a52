// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/foxglove_dialogue.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "extensions/ros/ros_text.h"
#include "extensions/ros/tests/ros_talk.h"

namespace ispace::ros {
namespace foxglove_dialogue_test {

using nlohmann::json;
using testing::numberAt;
using testing::RosTalk;

class FoxgloveTalk : public RosTalk<FoxgloveDialogue> {
  public:
    explicit FoxgloveTalk(const ServerLimits& limits = RosTalk::limits(), RosScenery scenery = {})
        : RosTalk(limits, std::move(scenery), "room.env", "7") {
        info = ask("serverInfo");
        channels = ask("advertise")["channels"];
        services = ask("advertiseServices")["services"];
    }
    /// Returns the next message, which has this op.
    json ask(const std::string& op) {
        const auto message = text();
        EXPECT_EQ(message.value("op", ""), op) << message;
        return message;
    }
    [[nodiscard]] json channel(const std::string& topic) const {
        for (const json& one : channels)
            if (one["topic"] == topic) return one;
        return {};
    }
    void subscribe(std::uint32_t key, const std::string& topic) {
        send({{"op", "subscribe"},
              {"subscriptions", {{{"id", key}, {"channelId", channel(topic)["id"]}}}}});
    }
    void publish(std::uint32_t channel, const std::string& payload) {
        std::string message = "\1";
        appendLittle(message, channel);
        dialogue->receive(message + payload, false);
    }
    void advertise(std::uint32_t id, const std::string& topic, const std::string& type,
                   const std::string& encoding = "json") {
        send({{"op", "advertise"},
              {"channels",
               {{{"id", id}, {"topic", topic}, {"encoding", encoding}, {"schemaName", type}}}}});
    }
    json info, channels, services;
};

TEST(Foxglove, SpeaksFirst) {
    const FoxgloveTalk talk;
    EXPECT_EQ(talk.info["supportedEncodings"], json::parse(R"(["json","cdr"])"));
    EXPECT_EQ(talk.info["sessionId"], "7");
    const json scan = talk.channel("/l1/scan");
    EXPECT_EQ(scan["schemaName"], "sensor_msgs/msg/LaserScan");
    EXPECT_EQ(scan["encoding"], "cdr");
    EXPECT_EQ(scan["schemaEncoding"], "ros2msg");
    EXPECT_NE(scan["schema"].get<std::string>().find("MSG: std_msgs/Header"), std::string::npos);
    EXPECT_TRUE(talk.channel("/r1/cmd_vel").is_null()) << "the client publishes it";
    EXPECT_EQ(talk.services.size(), 3U);
    for (const char* const schema : {"requestSchema", "responseSchema"})
        EXPECT_EQ(json::parse(talk.services[0].value(schema, ""))["type"], "object") << schema;
}

TEST(Foxglove, SendsMessagesOfSubscriptions) {
    FoxgloveTalk talk;
    talk.subscribe(77, "/l1/scan");
    talk.step();
    std::string scan;
    for (auto message = talk.next(); message; message = talk.next())
        if (message->at(0) == 1) scan = *message;
    ASSERT_GT(scan.size(), 13U);
    EXPECT_EQ(numberAt<std::uint32_t>(scan, 1), 77U);
    EXPECT_EQ(numberAt<std::uint64_t>(scan, 5), 100'000'000U);
    const json values = json::parse(rosJson(RosType::LaserScan, scan.substr(13)));
    EXPECT_EQ(values["ranges"], json::parse("[null,7.0,null]"));
    talk.send({{"op", "unsubscribe"}, {"subscriptionIds", {77}}});
    talk.step();
    for (auto message = talk.next(); message; message = talk.next())
        EXPECT_EQ(message->at(0), 2) << "the time alone";
}

TEST(Foxglove, TellsTheGraphOfNodes) {
    FoxgloveTalk talk;
    talk.send({{"op", "subscribeConnectionGraph"}});
    const json graph = talk.ask("connectionGraphUpdate");
    const auto has = [&graph](const char* list, const std::string& name, const char* members) {
        const json wanted = {{"name", name}, {members, {"/simrun"}}};
        return std::count(graph[list].begin(), graph[list].end(), wanted) == 1;
    };
    EXPECT_TRUE(has("publishedTopics", "/l1/scan", "publisherIds"));
    EXPECT_TRUE(has("subscribedTopics", "/r1/cmd_vel", "subscriberIds")) << "once for both types";
    EXPECT_TRUE(has("advertisedServices", "/reset", "providerIds"));
    EXPECT_FALSE(has("publishedTopics", "/r1/cmd_vel", "publisherIds"));
    EXPECT_EQ(graph["removedTopics"], json::array());

    const auto change = [&talk](const std::string& layout) {
        talk.room.world.change(testing::scene("ispace size=8,6\n", layout));
        talk.state.sync();
        talk.stepped();
        std::vector<json> updates;
        for (auto message = talk.next(); message; message = talk.next())
            if (message->front() == '{')
                if (json text = json::parse(*message); text["op"] == "connectionGraphUpdate")
                    updates.push_back(std::move(text));
        return updates;
    };
    const std::vector<json> updates = change("robot id=r1 at=0,0\nrobot id=r9 at=2,0\n");
    ASSERT_EQ(updates.size(), 1U);
    const auto lists = [&updates](const char* list, const char* name) {
        const json& all = updates[0][list];
        return std::find(all.begin(), all.end(), name) != all.end();
    };
    EXPECT_TRUE(lists("removedTopics", "/l2/scan"));
    EXPECT_FALSE(lists("removedTopics", "/r1/odom"));
    for (const json& one : updates[0]["publishedTopics"])
        EXPECT_EQ(one["name"].get<std::string>().find("/r1/"), std::string::npos) << one;
    EXPECT_EQ(updates[0]["advertisedServices"], json::array());

    talk.send({{"op", "unsubscribeConnectionGraph"}});
    EXPECT_TRUE(change("robot id=r1 at=0,0\n").empty());
}

TEST(Foxglove, SlowReadersLoseTheOldestMessages) {
    FoxgloveTalk talk;
    talk.subscribe(1, "/l1/scan");
    talk.subscribe(2, "/tf_static");
    talk.step(40);
    int scans = 0, others = 0;
    std::uint64_t last = 0;
    for (auto message = talk.next(); message; message = talk.next()) {
        if (message->at(0) != 1) continue;
        const bool is_scan = numberAt<std::uint32_t>(*message, 1) == 1;
        ++(is_scan ? scans : others);
        if (is_scan) last = numberAt<std::uint64_t>(*message, 5);
    }
    EXPECT_EQ(scans, 5) << "sensor data keeps five";
    EXPECT_EQ(others, 1);
    EXPECT_EQ(last, 4'000'000'000U) << "the newest is among them";
}

TEST(Foxglove, AChannelHasOneSubscription) {
    FoxgloveTalk talk;
    talk.subscribe(1, "/clock");
    talk.subscribe(2, "/clock");
    EXPECT_EQ(talk.ask("status")["message"], "another subscription has this channel");
    talk.subscribe(1, "/clock");
    talk.send({{"op", "unsubscribe"}, {"subscriptionIds", {1}}});
    talk.subscribe(2, "/clock");
    talk.drain();
    talk.step();
    EXPECT_EQ(numberAt<std::uint32_t>(talk.binary(1), 1), 2U);
}

TEST(Foxglove, SubscriptionsOfAllClientsAreBounded) {
    FoxgloveTalk talk;
    const auto number = talk.channel("/clock")["id"].get<std::uint32_t>();
    while (!talk.feed.isFull()) talk.feed.want(number);
    talk.subscribe(1, "/clock");
    EXPECT_EQ(talk.ask("status")["message"], "too many subscriptions");
    talk.feed.unwant(number);
    talk.subscribe(1, "/clock");
    EXPECT_TRUE(talk.dialogue->isEngaged());
}

TEST(Foxglove, OneLargeAnswerMayWait) {
    constexpr std::size_t kLarge = 5'000'000;
    FoxgloveTalk talk(RosTalk<FoxgloveDialogue>::limits(),
                      {.room = [](const Scene&) { return std::string(kLarge, 'm'); }});
    const auto fetch = [&] {
        talk.send({{"op", "fetchAsset"}, {"uri", "package://ispace/room.glb"}, {"requestId", 3}});
    };
    fetch();
    talk.send({{"op", "getParameters"}, {"parameterNames", {"r1.at"}}});
    EXPECT_FALSE(talk.dialogue->isOverfull());
    fetch();
    fetch();
    EXPECT_TRUE(talk.dialogue->isOverfull());
}

TEST(Foxglove, TwistsDriveUntilTheySilence) {
    FoxgloveTalk talk;
    talk.advertise(5, "/r1/cmd_vel", "geometry_msgs/Twist");
    talk.publish(5, R"({"linear":{"x":0.4},"angular":{"z":0.1}})");
    talk.step(10);
    EXPECT_NEAR(talk.room.world.status(0).speed, 0.3, 1e-9) << "0.3 m/s^2 for a second";
    EXPECT_FALSE(talk.state.hold("r1")) << "it is held";
    talk.step(30);
    EXPECT_EQ(talk.room.world.status(0).speed, 0) << "the watchdog";
    EXPECT_TRUE(talk.state.hold("r1")) << "it is free";
}

TEST(Foxglove, OrdersBecomeChannelsOfTheOthers) {
    FoxgloveTalk talk;
    talk.advertise(5, "/r1/cmd_vel", "geometry_msgs/Twist");
    talk.publish(5, R"({"linear":{"x":0.25}})");
    talk.step();
    const json told = talk.text();
    ASSERT_EQ(told["op"], "advertise") << told;
    ASSERT_EQ(told["channels"].size(), 1U);
    const json channel = told["channels"][0];
    EXPECT_EQ(channel["topic"], "/r1/cmd_vel");
    EXPECT_EQ(channel["schemaName"], "geometry_msgs/msg/Twist");
    talk.send(
        {{"op", "subscribe"}, {"subscriptions", {{{"id", 3}, {"channelId", channel["id"]}}}}});
    // Among times, which are for players.
    const auto next_message = [&talk] {
        std::string bytes = talk.next().value_or("");
        while (bytes.starts_with('\2')) bytes = talk.next().value_or("");
        return bytes;
    };
    const std::string echo = next_message();
    constexpr std::size_t kHead = 13;  // of a message in bytes
    ASSERT_GT(echo.size(), kHead);
    EXPECT_NEAR(twistOf(RosType::Twist, std::string_view(echo).substr(kHead)).forward, 0.25, 1e-12);
    talk.publish(5, R"({"linear":{"x":0.3}})");
    talk.step();
    EXPECT_NE(next_message(), "");
    EXPECT_EQ(next_message(), "") << "it is a channel already";
}

TEST(Foxglove, StampedTwistsInCdrDriveToo) {
    FoxgloveTalk talk;
    talk.advertise(6, "/r2/cmd_vel", "geometry_msgs/msg/TwistStamped", "cdr");
    const json twist = {{"twist", {{"linear", {{"x", 99}}}}}};
    talk.publish(6, rosMessage(RosType::TwistStamped, twist));
    talk.step(14);
    EXPECT_GT(talk.room.world.status(1).speed, 0.5);
    EXPECT_LE(talk.room.world.status(1).speed, 1.6) << "its greatest speed";
}

TEST(Foxglove, HeldRobotsAreNotDriven) {
    FoxgloveTalk talk;
    ASSERT_TRUE(talk.state.hold("r1"));
    talk.advertise(5, "/r1/cmd_vel", "geometry_msgs/Twist");
    talk.publish(5, R"({"linear":{"x":0.4}})");
    EXPECT_EQ(talk.ask("status")["level"], 2);
    talk.step(5);
    EXPECT_EQ(talk.room.world.status(0).speed, 0);
}

TEST(Foxglove, InitialPosesMoveRobots) {
    FoxgloveTalk talk;
    talk.advertise(5, "/r1/initialpose", "geometry_msgs/PoseWithCovarianceStamped");
    talk.publish(5, R"({"header":{"frame_id":"map"},"pose":{"pose":{"position":{"x":-1,"y":1},
                        "orientation":{"z":1,"w":0}}}})");
    talk.settle();
    EXPECT_EQ(talk.room.world.status(0).pose.position, Point2(-1, 1));
    EXPECT_NEAR(std::abs(talk.room.world.status(0).pose.heading.degrees()), 180, 1e-9);
    talk.publish(5, R"({"pose":{"pose":{"position":{"x":2000000,"y":1},"orientation":{"w":1}}}})");
    EXPECT_NE(talk.ask("status")["message"].get<std::string>().find("above 1000000"),
              std::string::npos);
    talk.settle();
    EXPECT_NEAR(std::abs(talk.room.world.status(0).pose.heading.degrees()), 180, 1e-9)
        << "a refused pose does not turn it";
    talk.publish(5, R"({"header":{"frame_id":"l1"}})");
    EXPECT_NE(talk.ask("status")["message"].get<std::string>().find("frame map"),
              std::string::npos);
}

TEST(Foxglove, ServicesChangeTheRun) {
    FoxgloveTalk talk;
    const auto call = [&](std::uint32_t service) {
        std::string message = "\2";
        for (const std::uint32_t number : {service, 9U, 4U}) appendLittle(message, number);
        talk.dialogue->receive(message + "json{}", false);
        talk.settle();
    };
    talk.room.world.command(1, {Verb::Speed, 0.5});
    talk.step(10);
    EXPECT_NE(talk.room.world.status(1).pose.position, Point2(2, 1.5));
    talk.drain();
    call(0);
    EXPECT_EQ(talk.room.world.status(1).pose.position, Point2(2, 1.5)) << "reset";
    const std::string answer = talk.binary(3);
    EXPECT_EQ(numberAt<std::uint32_t>(answer, 1), 0U);
    EXPECT_EQ(numberAt<std::uint32_t>(answer, 5), 9U);
    EXPECT_EQ(answer.substr(9), std::string("\4\0\0\0json{}", 10));
    call(2);
    EXPECT_EQ(talk.ask("serviceCallFailure")["callId"], 9) << "the clock is `step`";
    call(3);
    EXPECT_EQ(talk.ask("serviceCallFailure")["serviceId"], 3);
}

TEST(Foxglove, ParametersAreReadAndSet) {
    FoxgloveTalk talk;
    talk.send({{"op", "getParameters"}, {"parameterNames", {"r1.at", "none"}}, {"id", "q"}});
    json values = talk.ask("parameterValues");
    EXPECT_EQ(values["id"], "q");
    EXPECT_EQ(values["parameters"],
              json::parse(R"([{"name":"r1.at","value":[0.0,0.0],"type":"float64_array"}])"));
    talk.send({{"op", "subscribeParameterUpdates"}, {"parameterNames", {"r1.at"}}});
    talk.send({{"op", "setParameters"},
               {"parameters", {{{"name", "r1.at"}, {"value", {1, -1}}}}},
               {"id", "s"}});
    talk.settle();
    EXPECT_EQ(talk.room.world.status(0).pose.position, Point2(1, -1));
    values = talk.ask("parameterValues");
    EXPECT_EQ(values["parameters"][0]["value"], json::parse("[1.0,-1.0]"));
    for (const char* bad :
         {R"([{"name":"r1.at","value":1}])", R"([{"name":"x\nSHUTDOWN"}])",
          R"([{"name":"r1.at","value":[1,"2"]}])", R"([{"name":"clock.rate"}])"}) {
        talk.drain();
        talk.send({{"op", "setParameters"}, {"parameters", json::parse(bad)}});
        EXPECT_EQ(talk.ask("status")["level"], 2) << bad;
    }
    talk.drain();
    const json paused = json::parse(R"([{"name":"clock.paused","value":1}])");
    talk.send({{"op", "setParameters"}, {"parameters", paused}, {"id", "t"}});
    EXPECT_EQ(talk.ask("status")["level"], 2);
    values = talk.ask("parameterValues");
    EXPECT_EQ(values["id"], "t");
    EXPECT_EQ(values["parameters"][0]["value"], true) << "a clock in steps";
}

TEST(Foxglove, ParametersNeedTheToken) {
    ServerLimits limits = RosTalk<FoxgloveDialogue>::limits();
    limits.token = "secret";
    FoxgloveTalk talk(limits);
    const json paused = json::parse(R"([{"name":"clock.paused","value":true}])");
    talk.send({{"op", "setParameters"}, {"parameters", paused}});
    const json refusal = talk.ask("status");
    EXPECT_NE(refusal.value("message", "").find("token"), std::string::npos) << refusal;
    EXPECT_EQ(talk.dialogue->present("secret"), 0U);
    talk.send({{"op", "setParameters"}, {"parameters", paused}, {"id", "t"}});
    talk.settle();
    EXPECT_EQ(talk.ask("parameterValues")["id"], "t");
}

TEST(Foxglove, WatchesAllParametersOfAnEmptyList) {
    FoxgloveTalk talk;
    talk.send({{"op", "subscribeParameterUpdates"}, {"parameterNames", json::array()}});
    const auto move = [&talk](const json& to) {
        talk.send({{"op", "setParameters"}, {"parameters", {{{"name", "r1.at"}, {"value", to}}}}});
        talk.settle();
        talk.step();
    };
    move({1, -1});
    EXPECT_GT(talk.ask("parameterValues")["parameters"].size(), 3U);
    talk.send({{"op", "unsubscribeParameterUpdates"}, {"parameterNames", json::array()}});
    talk.drain();
    move({1, 1});
    for (auto message = talk.next(); message; message = talk.next())
        EXPECT_EQ(message->find("parameterValues"), std::string::npos);
}

TEST(Foxglove, AssetsOfTheScene) {
    FoxgloveTalk talk(RosTalk<FoxgloveDialogue>::limits(),
                      {.room = [](const Scene&) { return std::string("glTF"); }});
    const auto fetch = [&](const char* uri) {
        talk.send({{"op", "fetchAsset"}, {"uri", uri}, {"requestId", 3}});
        return talk.binary(4);
    };
    EXPECT_EQ(fetch("package://ispace/room.glb"), std::string("\4\3\0\0\0\0\0\0\0\0glTF", 14));
    const std::string other = fetch("file:///etc/passwd");
    EXPECT_EQ(other[5], 1);
    EXPECT_EQ(other.find("root"), std::string::npos);
}

TEST(Foxglove, HostileMessagesAreAnswered) {
    FoxgloveTalk talk;
    for (const char* text :
         {"", "{", "[]", "7", "null", R"({"op":5})", R"({"op":"subscribe","subscriptions":[5]})",
          R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
          R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":4294967296}]})",
          R"({"op":"advertise","channels":[{"id":1,"topic":"/tf","encoding":"ros1"}]})",
          R"({"op":"advertise","channels":[null]})", R"({"op":"fetchAsset"})"}) {
        talk.dialogue->receive(text, true);
        EXPECT_EQ(talk.ask("status")["op"], "status") << text;
    }
    for (const std::string_view bytes :
         {std::string_view("\2"), std::string_view("\2\0\0\0\0\0\0\0\0\377\377\377\377", 13),
          std::string_view("\7"), std::string_view()}) {
        talk.dialogue->receive(bytes, false);
        EXPECT_EQ(talk.ask("status")["op"], "status");
    }
    talk.publish(1234, "{}");
    EXPECT_FALSE(talk.next()) << "channels that were refused are ignored";
}

TEST(Foxglove, TopicsThatAreNotReadAreToldWithTheFirstMessage) {
    FoxgloveTalk talk;
    const std::vector<std::pair<const char*, const char*>> unread = {
        {"/clicked_point", "geometry_msgs/PointStamped"},
        {"/r1/cmd_vel", "geometry_msgs/PoseStamped"},
        {"/r1/odom", "nav_msgs/msg/Odometry"}};
    for (const auto& [topic, type] : unread) {
        talk.advertise(5, topic, type);
        EXPECT_FALSE(talk.next()) << topic;
        talk.publish(5, "{}");
        EXPECT_EQ(talk.ask("status")["level"], 1) << topic;
        talk.publish(5, "{}");
        EXPECT_FALSE(talk.next()) << topic;
    }
}

TEST(Foxglove, ReadersOfNothingHaveToWait) {
    FoxgloveTalk talk;
    for (int i = 0; i < 10'000 && talk.dialogue->hasRoom(); ++i) talk.dialogue->receive("{", true);
    EXPECT_FALSE(talk.dialogue->hasRoom());
    EXPECT_FALSE(talk.dialogue->isOverfull()) << "its requests wait";
}

/// A change is adopted between steps, and messages may come before it is told.
TEST(Foxglove, MessagesMeetAChangedWorld) {
    FoxgloveTalk talk;
    talk.advertise(5, "/r2/cmd_vel", "geometry_msgs/Twist");
    talk.room.world.change(testing::scene("ispace size=8,6\n", "robot id=r9 at=0,0\n"));
    talk.publish(5, R"({"linear":{"x":0.4}})");
    EXPECT_EQ(talk.ask("status")["level"], 2) << "r2 is gone";
    talk.subscribe(1, "/l2/scan");
    EXPECT_EQ(talk.ask("status")["level"], 2) << "so is its laser";
}

TEST(Foxglove, ChannelsComeAndGoWithTheWorld) {
    FoxgloveTalk talk;
    talk.subscribe(1, "/l2/scan");
    talk.room.world.change(testing::scene("ispace size=8,6\n", "robot id=r9 at=0,0\n"));
    talk.state.sync();
    talk.stepped();
    const json gone = talk.ask("unadvertise")["channelIds"];
    EXPECT_NE(std::find(gone.begin(), gone.end(), talk.channel("/l2/scan")["id"]), gone.end());
    bool has_r9 = false;
    const json added = talk.ask("advertise")["channels"];
    for (const json& one : added) has_r9 = has_r9 || one["topic"] == "/r9/odom";
    EXPECT_TRUE(has_r9);
    EXPECT_FALSE(talk.dialogue->isEngaged()) << "its subscription is gone";
}

}  // namespace foxglove_dialogue_test
}  // namespace ispace::ros
