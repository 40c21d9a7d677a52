// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/rosbridge_dialogue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "base/message.h"
#include "extensions/ros/tests/ros_talk.h"

namespace ispace::ros {
namespace rosbridge_dialogue_test {

using nlohmann::json;
using testing::RosTalk;

class BridgeTalk : public RosTalk<RosbridgeDialogue> {
  public:
    explicit BridgeTalk(const ServerLimits& limits = RosTalk::limits()) : RosTalk(limits, {}) {}

    void subscribe(const json& more) {
        json request = {{"op", "subscribe"}, {"id", "s1"}};
        request.update(more);
        send(request);
    }
    json call(const std::string& service, const json& args = json::object()) {
        send({{"op", "call_service"}, {"id", "c"}, {"service", service}, {"args", args}});
        settle();
        const json answer = text();
        EXPECT_EQ(answer.value("op", ""), "service_response") << answer;
        EXPECT_EQ(answer.value("id", ""), "c");
        return answer;
    }
};

TEST(Rosbridge, SaysNothingUnasked) {
    BridgeTalk talk;
    talk.step(3);
    EXPECT_FALSE(talk.next());
}

TEST(Rosbridge, SendsMessagesOfSubscriptions) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/l1/scan"}, {"type", "sensor_msgs/LaserScan"}});
    const json first = talk.text();
    EXPECT_EQ(first["op"], "publish");
    EXPECT_EQ(first["topic"], "/l1/scan");
    EXPECT_EQ(first["msg"]["ranges"], json::parse("[null,7.0,null]"));
    talk.step(3);
    int count = 0;
    while (talk.next()) ++count;
    EXPECT_EQ(count, 3);
    talk.send({{"op", "unsubscribe"}, {"id", "s1"}, {"topic", "/l1/scan"}});
    talk.step();
    EXPECT_FALSE(talk.next());
}

TEST(Rosbridge, QueuesAsLongAsItIsTold) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/l1/scan"}, {"queue_length", 2}});
    talk.drain();
    talk.step(6);
    EXPECT_EQ(talk.text()["msg"]["header"]["stamp"]["nanosec"], 500'000'000);
    EXPECT_EQ(talk.text()["msg"]["header"]["stamp"]["nanosec"], 600'000'000);
    EXPECT_FALSE(talk.next());
}

TEST(Rosbridge, ThrottlesInWallTime) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/l1/scan"}, {"throttle_rate", 900'000}});
    talk.step(6);
    int count = 0;
    while (talk.next()) ++count;
    EXPECT_EQ(count, 1);
    talk.subscribe({{"topic", "/l1/scan"}, {"id", "s2"}});
    talk.drain();
    talk.step(2);
    for (count = 0; talk.next();) ++count;
    EXPECT_EQ(count, 2) << "the quickest request of a client counts";
}

TEST(Rosbridge, RequestsOfOneTopicHaveTheirCommonForm) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/l1/scan"}, {"compression", "cbor"}, {"queue_length", 4}});
    talk.subscribe({{"topic", "/l1/scan"}, {"id", "s2"}, {"queue_length", 2}});
    talk.drain();
    talk.step(6);
    EXPECT_EQ(json::from_cbor(talk.next().value_or(""), true, true,
                              json::cbor_tag_handler_t::ignore)["topic"],
              "/l1/scan")
        << "as rosbridge_suite: cbor before none, whichever came last";
    EXPECT_TRUE(talk.next());
    EXPECT_FALSE(talk.next()) << "the shortest queue counts";
    talk.send({{"op", "unsubscribe"}, {"id", "s1"}, {"topic", "/l1/scan"}});
    EXPECT_FALSE(talk.next()) << "the newest message has been sent";
    talk.step();
    EXPECT_EQ(talk.text()["topic"], "/l1/scan") << "no cbor is left";
    talk.send({{"op", "unsubscribe"}, {"id", "s2"}, {"topic", "/l1/scan"}});
    talk.step();
    EXPECT_FALSE(talk.next());
}

TEST(Rosbridge, SendsFragments) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/l1/scan"}, {"fragment_size", 1e6}});
    const json whole = talk.text();
    EXPECT_EQ(whole["op"], "publish") << "it fits";
    talk.send({{"op", "unsubscribe"}, {"topic", "/l1/scan"}});
    talk.subscribe({{"topic", "/l1/scan"}, {"fragment_size", 1}});
    std::string text;
    std::size_t num = 0, total = 1;
    for (; num < total; ++num) {
        const json part = talk.text();
        ASSERT_EQ(part["op"], "fragment") << part;
        EXPECT_EQ(part["num"], num);
        EXPECT_EQ(part["id"], "0");
        total = part["total"];
        EXPECT_LE(part["data"].get<std::string>().size(), 256U);
        text += part["data"];
    }
    EXPECT_GT(total, 1U);
    EXPECT_EQ(json::parse(text), whole);
    EXPECT_FALSE(talk.next());
    talk.subscribe({{"topic", "/l1/scan"}, {"compression", "cbor"}, {"fragment_size", 256}});
    EXPECT_EQ(json::from_cbor(talk.next().value_or(""), true, true,
                              json::cbor_tag_handler_t::ignore)["op"],
              "publish")
        << "bytes stay whole, as in rosbridge_suite";
}

TEST(Rosbridge, EachNameOfATopicHasItsMessages) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "l1/scan"}});
    talk.subscribe({{"topic", "/l1/scan"}, {"id", "s2"}});
    talk.drain();
    talk.step();
    std::set<std::string> names{talk.text()["topic"], talk.text()["topic"]};
    EXPECT_EQ(names, (std::set<std::string>{"/l1/scan", "l1/scan"}));
    EXPECT_FALSE(talk.next());
    talk.send({{"op", "unsubscribe"}, {"topic", "l1/scan"}});
    talk.step();
    EXPECT_EQ(talk.text()["topic"], "/l1/scan");
    EXPECT_FALSE(talk.next());
}

TEST(Rosbridge, OtherTypesThanATopicsAreRefused) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/l1/scan"}, {"type", "nav_msgs/Odometry"}});
    const json status = talk.text();
    EXPECT_EQ(status["level"], "error");
    EXPECT_EQ(status["id"], "s1");
    EXPECT_NE(status["msg"].get<std::string>().find("sensor_msgs/msg/LaserScan"),
              std::string::npos);
    talk.step();
    EXPECT_FALSE(talk.next());
}

TEST(Rosbridge, SendsCbor) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/l1/scan"}, {"compression", "cbor"}});
    const std::string bytes = talk.next().value_or("");
    const json message = json::from_cbor(bytes, true, false, json::cbor_tag_handler_t::store);
    EXPECT_EQ(message["topic"], "/l1/scan");
    EXPECT_EQ(message["msg"]["ranges"].get_binary().subtype(), 85U);
    talk.subscribe({{"topic", "/clock"}, {"compression", "cbor-raw"}});
    const json raw = json::from_cbor(talk.next().value_or(""));
    EXPECT_EQ(raw["msg"]["secs"], 0);
    EXPECT_EQ(raw["msg"]["bytes"].get_binary().size(), 12U) << "head and two numbers";
}

TEST(Rosbridge, PublishedTwistsDrive) {
    BridgeTalk talk;
    talk.send({{"op", "advertise"},
               {"id", "a"},
               {"topic", "/r1/cmd_vel"},
               {"type", "geometry_msgs/TwistStamped"}});
    talk.send({{"op", "publish"},
               {"topic", "/r1/cmd_vel"},
               {"msg", {{"twist", {{"linear", {{"x", 0.2}}}}}}}});
    talk.send({{"op", "publish"}, {"topic", "r2/cmd_vel"}, {"msg", {{"angular", {{"z", 0.5}}}}}});
    talk.step(10);
    EXPECT_NEAR(talk.room.world.status(0).speed, 0.2, 1e-9);
    EXPECT_NEAR(talk.room.world.status(1).rotspeed.radians(), 0.5, 1e-9) << "without advertising";
    EXPECT_FALSE(talk.next());
    talk.dialogue.reset();
    EXPECT_TRUE(talk.state.hold("r1")) << "free when the client is gone";
    talk.room.simulation.allow(10);
    for (int i = 0; i < 10; ++i) talk.room.simulation.run({}, std::chrono::nanoseconds(0));
    EXPECT_EQ(talk.room.world.status(0).speed, 0);
}

TEST(Rosbridge, OrdersCanBeRead) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/r1/cmd_vel"}, {"type", "geometry_msgs/Twist"}});
    talk.step();
    EXPECT_FALSE(talk.next());
    for (const double speed : {0.2, 0.3}) {
        talk.send(
            {{"op", "publish"}, {"topic", "/r1/cmd_vel"}, {"msg", {{"linear", {{"x", speed}}}}}});
        talk.step();
        const json echo = talk.text();
        EXPECT_EQ(echo["topic"], "/r1/cmd_vel");
        EXPECT_EQ(echo["msg"]["linear"]["x"], speed);
        talk.step();
        EXPECT_FALSE(talk.next()) << "each once";
    }
}

TEST(Rosbridge, CallsServices) {
    BridgeTalk talk;
    talk.room.world.command(1, {Verb::Speed, 0.5});
    talk.step(10);
    EXPECT_EQ(talk.call("reset")["result"], true) << "without a slash, as roslib has it";
    EXPECT_EQ(talk.room.world.status(1).pose.position, Point2(2, 1.5));
    const json failed = talk.call("/resume");
    EXPECT_EQ(failed["result"], false);
    EXPECT_NE(failed["values"].get<std::string>().find("STEP"), std::string::npos);
    EXPECT_EQ(talk.call("/none")["result"], false);
}

TEST(Rosbridge, ChangesNeedTheirRight) {
    ServerLimits limits = BridgeTalk::limits();
    limits.token = "secret";
    BridgeTalk talk(limits);
    EXPECT_EQ(talk.call("/reset")["result"], false);
    EXPECT_EQ(talk.dialogue->present("wrong"), 401U);
    EXPECT_EQ(talk.dialogue->present("secret"), 0U);
    EXPECT_EQ(talk.call("/reset")["result"], true);
}

TEST(Rosbridge, AnswersRosapi) {
    BridgeTalk talk;
    const json topics = talk.call("/rosapi/topics")["values"];
    const auto scan = std::find(topics["topics"].begin(), topics["topics"].end(), "/l1/scan");
    ASSERT_NE(scan, topics["topics"].end());
    EXPECT_EQ(topics["types"][static_cast<std::size_t>(scan - topics["topics"].begin())],
              "sensor_msgs/msg/LaserScan");
    EXPECT_EQ(topics["topics"].size(), topics["types"].size());
    EXPECT_EQ(talk.call("rosapi/topic_type", {{"topic", "/tf"}})["values"]["type"],
              "tf2_msgs/msg/TFMessage");
    EXPECT_EQ(
        talk.call("rosapi/topics_for_type", {{"type", "sensor_msgs/LaserScan"}})["values"]["topics"]
            .size(),
        2U);
    EXPECT_EQ(talk.call("rosapi/services")["values"]["services"].size(), 3U);
    EXPECT_EQ(talk.call("rosapi/nodes")["values"]["nodes"], json::parse(R"(["/simrun"])"));
    EXPECT_EQ(talk.call("/rosapi/publishers", {{"topic", "/tf"}})["values"]["publishers"].size(),
              1U);
    EXPECT_EQ(talk.call("rosapi/get_param", {{"name", "clock.paused"}})["values"]["value"], "true");
    talk.step(15);
    EXPECT_EQ(talk.call("rosapi/get_param", {{"name", "/simrun:clock.paused"}})["values"]["value"],
              "true");
    EXPECT_EQ(talk.call("rosapi/get_param", {{"name", "/simrun:none"}})["values"]["value"], "\"\"");
    EXPECT_EQ(talk.call("rosapi/get_param",
                        {{"name", "none"}, {"default_value", "7"}})["values"]["value"],
              "7");
    EXPECT_EQ(talk.call("rosapi/get_param_names")["values"]["names"][0], "/simrun:clock.paused");
    EXPECT_EQ(talk.call("rosapi/has_param", {{"name", "clock.rate"}})["values"]["exists"], true);
    EXPECT_EQ(talk.call("rosapi/has_param", {{"name", "none"}})["values"]["exists"], false);
    EXPECT_EQ(talk.call("rosapi/delete_param", {{"name", "clock.rate"}})["values"]["successful"],
              false);
    EXPECT_EQ(talk.call("rosapi/action_servers")["values"]["action_servers"],
              json({"/r1/navigate_to_pose", "/r2/navigate_to_pose"}));
    const json set = talk.call("rosapi/set_param",
                               {{"name", "/simrun:clock.paused"}, {"value", "\"x\""}})["values"];
    EXPECT_EQ(set["successful"], false);
    EXPECT_EQ(set["reason"], "`clock.paused` is true or false");
    for (const char* details :
         {"rosapi/service_request_details", "rosapi/service_response_details"})
        EXPECT_EQ(talk.call(details, {{"type", "std_srvs/srv/Empty"}})["values"]["typedefs"].size(),
                  1U);
    EXPECT_EQ(talk.call("rosapi/get_time")["values"]["time"],
              json({{"sec", 1}, {"nanosec", 500'000'000}}));
    const json twist = talk.call("rosapi/message_details",
                                 {{"type", "geometry_msgs/Twist"}})["values"]["typedefs"];
    ASSERT_EQ(twist.size(), 2U);
    EXPECT_EQ(twist[0]["fieldtypes"][1], "geometry_msgs/Vector3");
    EXPECT_EQ(talk.call("rosapi/topics_and_raw_types")["values"]["typedefs_full_text"].size(),
              topics["topics"].size());
    EXPECT_EQ(talk.call("rosapi/none")["result"], false);
}

TEST(Rosbridge, HostileMessagesAreAnswered) {
    BridgeTalk talk;
    for (const char* text :
         {"", "{", "[]", "7", "null", "{}", R"({"op":5})", R"({"op":"fragment"})",
          R"({"op":"advertise","topic":"/tf","type":"geometry_msgs/Twist"})",
          R"({"op":"publish","topic":"/tf"})", R"({"op":"publish","topic":"/r1/cmd_vel","msg":[]})",
          R"({"op":"publish","topic":"/tf2_web_republisher/goal","msg":{}})"}) {
        talk.dialogue->receive(text, true);
        EXPECT_EQ(talk.text().value("op", ""), "status") << text;
    }
    talk.dialogue->receive("{}", false);
    EXPECT_EQ(talk.text().value("op", ""), "status") << "binary";
    talk.send({{"op", "subscribe"}, {"topic", 5}, {"throttle_rate", "x"}, {"queue_length", -1}});
    talk.step();
    EXPECT_FALSE(talk.next()) << "a topic that does not exist";
    for (int i = 0; i < 5000; ++i)
        talk.send({{"op", "subscribe"}, {"topic", "/t" + std::to_string(i)}});
    EXPECT_EQ(talk.text().value("msg", ""), "too many subscriptions");
}

TEST(Rosbridge, SendsMessagesInPictures) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/l1/scan"}, {"compression", "png"}});
    const json message = talk.text();
    EXPECT_EQ(message["op"], "png");
    const auto data = message["data"].get<std::string>();
    EXPECT_TRUE(data.starts_with(base64("\x89PNG\r\n"))) << "roslib decodes it: tests/npm";
}

/// A goal of roslib's TF clients.
json framesGoal(const char* target, double threshold) {
    return {{"source_frames", {"r2", "/l1", "none"}},
            {"target_frame", target},
            {"trans_thres", threshold},
            {"angular_thres", 0.01},
            {"rate", 100}};
}

TEST(Rosbridge, SendsPosesOfFramesThatMove) {
    BridgeTalk talk;
    talk.send({{"op", "send_action_goal"},
               {"id", "g"},
               {"action", "/tf2_web_republisher"},
               {"args", framesGoal("/map", 0.01)}});
    talk.step();
    const json feedback = talk.text();
    EXPECT_EQ(feedback["op"], "action_feedback");
    EXPECT_EQ(feedback["id"], "g");
    const json& transforms = feedback["values"]["transforms"];
    ASSERT_EQ(transforms.size(), 2U);
    EXPECT_EQ(transforms[0]["child_frame_id"], "l1");
    EXPECT_EQ(transforms[0]["header"]["frame_id"], "map");
    const Pose2 robot = talk.room.world.status(1).pose;
    const json& pose = transforms[1]["transform"];
    EXPECT_EQ(transforms[1]["child_frame_id"], "r2");
    EXPECT_NEAR(pose["translation"]["x"], robot.position.x, 1e-9);
    EXPECT_NEAR(pose["translation"]["y"], robot.position.y, 1e-9);
    EXPECT_NEAR(
        2 * std::atan2(pose["rotation"]["z"].get<double>(), pose["rotation"]["w"].get<double>()),
        robot.heading.radians(), 1e-9);
    talk.step(3);
    EXPECT_FALSE(talk.next()) << "at rest";
    talk.send({{"op", "cancel_action_goal"}, {"id", "g"}, {"action", "/tf2_web_republisher"}});
    EXPECT_EQ(talk.text()["status"], 5);

    // By topics, as in ROS 1, in the frame of the robot.
    talk.subscribe({{"topic", "tf2_web_republisher/feedback"}});
    talk.send({{"op", "publish"},
               {"topic", "/tf2_web_republisher/goal"},
               {"msg", {{"goal_id", {{"id", "h"}}}, {"goal", framesGoal("r2", 0)}}}});
    talk.step();
    const json message = talk.text();
    EXPECT_EQ(message["op"], "publish");
    EXPECT_EQ(message["topic"], "tf2_web_republisher/feedback") << "as it was subscribed to";
    EXPECT_EQ(message["msg"]["status"]["goal_id"]["id"], "h");
    const json& own = message["msg"]["feedback"]["transforms"];
    ASSERT_EQ(own.size(), 2U);
    EXPECT_NEAR(own[1]["transform"]["translation"]["x"], 0, 1e-9) << "itself";
    talk.send(
        {{"op", "publish"}, {"topic", "/tf2_web_republisher/cancel"}, {"msg", {{"id", "h"}}}});
    talk.step(3);
    EXPECT_FALSE(talk.next());
    for (int i = 0; i < 20; ++i)
        talk.send({{"op", "send_action_goal"},
                   {"id", std::to_string(i)},
                   {"action", "/tf2_web_republisher"},
                   {"args", framesGoal("nowhere", 0)}});
    EXPECT_EQ(talk.text()["values"], "too many goals");
}

TEST(Rosbridge, RepublishesFramesOnTopics) {
    BridgeTalk talk;
    const json args = {{"source_frames", {"/r1", "l1"}},
                       {"target_frame", "map"},
                       {"rate", 100},
                       {"timeout", {{"secs", 2}, {"nsecs", 0}}}};
    const std::string topic = talk.call("/republish_tfs", args)["values"]["topic_name"];
    EXPECT_EQ(topic, "/tf2_web_republisher/tf_repub_0");
    talk.step(2);
    EXPECT_FALSE(talk.next()) << "unread as yet";
    talk.subscribe({{"topic", topic}, {"type", "tf2_web_republisher/TFArray"}});
    talk.step(2);
    const json message = talk.text();
    EXPECT_EQ(message["topic"], topic);
    ASSERT_EQ(message["msg"]["transforms"].size(), 2U) << message;
    EXPECT_EQ(message["msg"]["transforms"][1]["child_frame_id"], "r1");
    talk.drain();
    talk.send({{"op", "unsubscribe"}, {"topic", topic}});
    talk.room.world.command(0, {Verb::Speed, 0.5});
    talk.step(20);
    EXPECT_FALSE(talk.next());
    // Those that are never read give way to later ones.
    for (int i = 0; i < 40; ++i) EXPECT_EQ(talk.call("republish_tfs", args)["result"], true);
    for (int i = 30; i < 46; ++i)
        talk.subscribe(
            {{"topic", "/tf2_web_republisher/tf_repub_" + std::to_string(i)}, {"id", i}});
    talk.drain();
    EXPECT_EQ(talk.call("/republish_tfs", args)["result"], true) << "some have gone";
}

TEST(Rosbridge, SubscriptionsAwaitTheirTopic) {
    BridgeTalk talk;
    talk.subscribe({{"topic", "/r9/odom"}});
    talk.step();
    EXPECT_FALSE(talk.next());
    talk.room.world.change(testing::scene("ispace size=8,6\n", "robot id=r9 at=0,0\n"));
    talk.state.sync();
    talk.stepped();
    EXPECT_EQ(talk.text().value("topic", ""), "/r9/odom");
}

TEST(Rosbridge, AnswersIdsThatAreNumbersAsNumbers) {
    BridgeTalk talk;
    talk.send({{"op", "call_service"}, {"id", 9}, {"service", "/rosapi/topics"}});
    talk.settle();
    EXPECT_EQ(talk.text()["id"], json(9));
    talk.send({{"op", "nonsense"}, {"id", 2.5}});
    EXPECT_EQ(talk.text()["id"], json(2.5));
    talk.send({{"op", "nonsense"}, {"id", ~std::uint64_t{0}}});
    EXPECT_EQ(talk.text()["id"], json(~std::uint64_t{0}));
}

TEST(Rosbridge, ReadsOrdersWithoutAdvertisementByTheirMembers) {
    BridgeTalk talk;
    const auto drive = [&talk](const json& message) {
        talk.send({{"op", "publish"}, {"topic", "/r1/cmd_vel"}, {"msg", message}});
        talk.step(3);
        return talk.room.world.status(0).speed;
    };
    EXPECT_GT(drive({{"twist", {{"linear", {{"x", 0.4}}}}}}), 0);
    EXPECT_FALSE(talk.next());
    EXPECT_GT(drive({{"linear", {{"x", 0.4}}}}), 0);
    EXPECT_FALSE(talk.next());
    (void)drive({{"velocity", 0.4}});
    const json answer = talk.text();
    EXPECT_EQ(answer["level"], "error");
    EXPECT_EQ(answer["msg"], "geometry_msgs/msg/Twist has no member `velocity`");
}

/// A goal of r2 as roslib sends it.
json goalOf(double x, double y, const std::string& id = "g") {
    return {{"op", "send_action_goal"},
            {"id", id},
            {"action", "/r2/navigate_to_pose"},
            {"action_type", "nav2_msgs/action/NavigateToPose"},
            {"feedback", true},
            {"args",
             {{"pose",
               {{"header", {{"frame_id", "map"}}},
                {"pose", {{"position", {{"x", x}, {"y", y}}}, {"orientation", {{"w", 1.0}}}}}}},
              {"behavior_tree", ""}}}};
}

TEST(Rosbridge, NavigatesToGoalsOfActions) {
    BridgeTalk talk;
    talk.send(goalOf(-2, -1));
    std::vector<double> left;
    json last = json::object();
    for (int i = 0; i < 400 && last.value("op", "") != "action_result"; ++i) {
        talk.step();
        for (json message = talk.text(); !message.is_null(); message = talk.text()) {
            last = message;
            EXPECT_EQ(message["id"], "g");
            EXPECT_EQ(message["action"], "/r2/navigate_to_pose");
            if (message["op"] != "action_feedback") continue;
            left.push_back(message["values"]["distance_remaining"]);
            EXPECT_EQ(message["values"]["current_pose"]["header"]["frame_id"], "map");
        }
    }
    EXPECT_EQ(last["op"], "action_result") << last;
    EXPECT_EQ(last["status"], 4);
    EXPECT_EQ(last["result"], true);
    ASSERT_GT(left.size(), 5U);
    EXPECT_GT(left.front(), 3);
    EXPECT_LT(left.back(), 1);
    const Point2 at = talk.room.world.status(1).pose.position;
    EXPECT_NEAR(distance(at, Point2{-2, -1}), 0, 0.05);
}

TEST(Rosbridge, CancelsReplacesAndRefusesGoals) {
    BridgeTalk talk;
    talk.send(goalOf(40, 0));
    const json refused = talk.text();
    EXPECT_EQ(refused["op"], "action_result");
    EXPECT_EQ(refused["result"], false);
    EXPECT_TRUE(refused["values"].is_string()) << refused;
    talk.send(goalOf(-2, -1, "first"));
    talk.step(3);
    talk.send(goalOf(3, 1, "second"));
    const json replaced = talk.text();
    EXPECT_EQ(replaced["id"], "first");
    EXPECT_EQ(replaced["status"], 6) << replaced;
    talk.step(3);
    talk.send({{"op", "cancel_action_goal"}, {"id", "second"}, {"action", "/r2/navigate_to_pose"}});
    const json canceled = talk.text();
    EXPECT_EQ(canceled["id"], "second");
    EXPECT_EQ(canceled["status"], 5) << canceled;
    talk.step(20);
    EXPECT_EQ(talk.room.world.status(1).speed, 0);
    const auto hold = talk.state.hold("r2");
    ASSERT_TRUE(hold) << "it is free";
    talk.state.release("r2", *hold);
    talk.drain();
    talk.send({{"op", "cancel_action_goal"}, {"id", "second"}, {"action", "/r2/navigate_to_pose"}});
    EXPECT_EQ(talk.text()["op"], "status");
    talk.send(goalOf(3, 1, "third"));
    talk.send({{"op", "call_service"}, {"service", "/r2/navigate_to_pose/_action/cancel_goal"}});
    EXPECT_EQ(talk.text()["status"], 5);
    EXPECT_EQ(talk.text()["op"], "service_response");
    talk.send(goalOf(3, 1, "fourth"));
    talk.send({{"op", "cancel_action_goal"}, {"id", "fourth"}, {"action", "/r1/navigate_to_pose"}});
    EXPECT_EQ(talk.text()["op"], "status") << "of another action";
    talk.send({{"op", "cancel_action_goal"}, {"id", "fourth"}});
    EXPECT_EQ(talk.text()["status"], 5);
    talk.send({{"op", "call_service"}, {"service", "/r9/navigate_to_pose/_action/cancel_goal"}});
    EXPECT_EQ(talk.text()["result"], false) << "there is no such robot";
    json other = goalOf(0, 0);
    other["action"] = "/r2/dock_robot";
    talk.send(other);
    EXPECT_EQ(talk.text()["result"], false);
    other = goalOf(0, 0);
    other["args"] = "";
    talk.send(other);
    EXPECT_EQ(talk.text()["result"], false);
}

}  // namespace rosbridge_dialogue_test
}  // namespace ispace::ros
