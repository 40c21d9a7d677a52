// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "extensions/ros/ros_orders.h"
#include "extensions/ros/ros_text.h"
#include "sim/sensor_reading.h"
#include "support/test_source.h"
#include "support/test_world.h"

namespace ispace::ros {
namespace ros_feed_test {

using nlohmann::json;

/// A world in steps of 0.1 s, and its feed.
struct Fed {
    explicit Fed(const std::string& more = "", RosScenery scenery = {})
        : room({Clock::Kind::Step, 1}, {}, "", more),
          state(room.simulation, limits()),
          feed(state, std::move(scenery)) {}

    static ServerLimits limits() {
        ServerLimits limits;
        limits.source = std::make_shared<const testing::TextSource>();
        return limits;
    }
    void step(std::int64_t count = 1) {
        room.simulation.allow(count);
        for (std::int64_t i = 0; i < count; ++i) {
            room.simulation.run({}, std::chrono::nanoseconds(0));
            state.collect();
            feed.stepped();
        }
    }
    [[nodiscard]] std::uint32_t number(const std::string& topic) const {
        for (const auto& [number, entry] : feed.entries())
            if (entry.channel.topic == topic) return number;
        return 0;
    }
    [[nodiscard]] const RosFeed::Entry& entry(const std::string& topic) const {
        return feed.entries().at(number(topic));
    }
    [[nodiscard]] json newest(const std::string& topic) const {
        const auto& message = entry(topic).newest;
        return message ? json::parse(*message->json()) : json();
    }

    testing::TestWorld room;
    ServerState state;
    RosFeed feed;
};

TEST(RosFeed, HasARowForEachTopic) {
    const Fed fed("camera id=c1 at=0,-2,2 pixels=4,3\nhuman id=h1 at=-2,2\n");
    std::set<std::string> topics;
    for (const auto& [number, entry] : fed.feed.entries()) topics.insert(entry.channel.topic);
    for (const char* topic :
         {"/clock", "/tf", "/tf_static", "/map", "/room", "/people", "/diagnostics", "/r1/odom",
          "/r1/sonar_0", "/r1/sonar_7", "/r1/cmd_vel", "/r2/initialpose", "/r1/goal_pose",
          "/l1/scan", "/l2/scan", "/c1/image_raw/compressed", "/c1/camera_info"})
        EXPECT_TRUE(topics.contains(topic)) << topic;
    EXPECT_FALSE(topics.contains("/cmd_vel")) << "two robots";
    EXPECT_FALSE(topics.contains("/r2/sonar_0")) << "a robot without sonars";
}

TEST(RosFeed, ComputesWantedTopicsAtTheirRates) {
    Fed fed;
    fed.step();
    EXPECT_FALSE(fed.entry("/r1/odom").newest) << "not wanted";
    fed.feed.want(fed.number("/clock"));
    fed.feed.want(fed.number("/diagnostics"));
    EXPECT_EQ(fed.newest("/clock")["clock"], json({{"sec", 0}, {"nanosec", 100'000'000}}));
    const auto first = fed.entry("/diagnostics").newest;
    fed.step(5);
    EXPECT_EQ(fed.entry("/diagnostics").newest, first) << "once a second";
    fed.step(5);
    EXPECT_NE(fed.entry("/diagnostics").newest, first);
    EXPECT_EQ(fed.newest("/clock")["clock"], json({{"sec", 1}, {"nanosec", 100'000'000}}));
    fed.feed.unwant(fed.number("/clock"));
    EXPECT_FALSE(fed.entry("/clock").newest);
}

TEST(RosFeed, ScansAreThoseOfTheWorld) {
    Fed fed;
    fed.feed.want(fed.number("/l1/scan"));
    fed.step(3);
    const json scan = fed.newest("/l1/scan");
    EXPECT_EQ(scan["header"]["frame_id"], "l1");
    EXPECT_EQ(scan["ranges"], json::parse("[null,7.0,null]"));
    EXPECT_NEAR(scan["range_max"].get<double>(), 7.002, 1e-6);
}

TEST(RosFeed, EachKindOfSensorHasTopics) {
    Fed fed(
        "tag id=item at=1,1,1\nmat id=w1 at=-3,2 size=1,1\ngate id=g1 at=1,2 width=1\n"
        "human id=h1 at=-3,2\n");
    const std::pair<const char*, RosType> kTopics[] = {{"/w1/on", RosType::String},
                                                       {"/g1/in", RosType::Int32},
                                                       {"/g1/out", RosType::Int32},
                                                       {"/g1/broken", RosType::Bool}};
    for (const auto& [topic, type] : kTopics) {
        ASSERT_NE(fed.number(topic), 0U) << topic;
        EXPECT_EQ(fed.entry(topic).channel.type, type) << topic;
        fed.feed.want(fed.number(topic));
    }
    fed.step(2);
    for (const auto& [topic, type] : kTopics) EXPECT_TRUE(fed.entry(topic).newest) << topic;
    EXPECT_EQ(fed.newest("/w1/on")["data"], "[\"h1\"]");
    EXPECT_EQ(fed.newest("/g1/in")["data"], 0);
}

TEST(RosFeed, StatesAreTopicsOnceTheyChange) {
    Fed fed(
        "lamp id=main-light at=0,0 on=yes level=0.5 color=1,0.5,0\n"
        "heater id=warm at=2,0 on=yes\n");
    for (const auto& [topic, type] : {std::pair("/main_light/on", RosType::Bool),
                                      {"/main_light/on/set", RosType::Bool},
                                      {"/main_light/level", RosType::Float64},
                                      {"/main_light/color", RosType::String},
                                      {"/warm/on", RosType::Bool}}) {
        ASSERT_NE(fed.number(topic), 0U) << topic;
        EXPECT_EQ(fed.entry(topic).channel.type, type) << topic;
        fed.feed.want(fed.number(topic));
    }
    EXPECT_EQ(fed.newest("/main_light/on")["data"], true);
    EXPECT_EQ(fed.newest("/main_light/level")["data"], 0.5);
    EXPECT_EQ(fed.newest("/main_light/color")["data"], "1,0.5,0");
    EXPECT_EQ(fed.newest("/warm/on")["data"], true);
    RosOrders orders(fed.state, [](const std::string& why) { FAIL() << why; });
    orders.obey(fed.entry("/main_light/on/set").channel, boolMessage(false));
    orders.obey(fed.entry("/main_light/level/set").channel, numberMessage(0.25));
    const auto kept = fed.entry("/warm/on").newest;
    for (int i = 0; i < 2000 && fed.newest("/main_light/level")["data"] != 0.25; ++i) {
        fed.state.collect();
        orders.proceed();
        orders.stepped();
        fed.feed.stepped();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(fed.newest("/main_light/on")["data"], false);
    EXPECT_EQ(fed.newest("/main_light/level")["data"], 0.25);
    EXPECT_EQ(fed.entry("/warm/on").newest, kept) << "it has not changed";
}

TEST(RosFeed, DoorsAreThoseOfOpenRmf) {
    Fed fed("door id=d1 at=0,-3 open=yes\ndoor id=d2 at=0,3 open=no\n", {.sources = {rmfTopics()}});
    EXPECT_EQ(fed.number("/lift_states"), 0U) << "a room has no lifts";
    const auto numbers = fed.feed.numbersOf("/door_states");
    ASSERT_EQ(numbers.size(), 2U) << "a channel each";
    for (const std::uint32_t number : numbers) fed.feed.want(number);
    const auto door = [&](std::size_t i) {
        return json::parse(*fed.feed.entries().at(numbers[i]).newest->json());
    };
    EXPECT_EQ(door(0)["door_name"], "d1");
    EXPECT_EQ(door(0)["current_mode"]["value"], 2);
    EXPECT_EQ(door(1)["door_name"], "d2");
    EXPECT_EQ(door(1)["current_mode"]["value"], 0);
    RosOrders orders(fed.state, [](const std::string& why) { FAIL() << why; });
    const auto ask = [&](const char* name, int mode) {
        orders.obey(fed.entry("/door_requests").channel,
                    rosMessage(RosType::DoorRequest,
                               {{"door_name", name}, {"requested_mode", {{"value", mode}}}}));
    };
    for (const int other : {1, 3, 4}) ask("d1", other);
    ask("d2", 2);
    for (int i = 0; i < 2000 && door(1)["current_mode"]["value"] != 2; ++i) {
        fed.step();
        orders.proceed();
        orders.stepped();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(door(1)["current_mode"]["value"], 2);
    EXPECT_EQ(door(0)["current_mode"]["value"], 2) << "no mode to be in";
    fed.feed.want(fed.number("/fleet_states"));
    const json fleet = fed.newest("/fleet_states");
    EXPECT_EQ(fleet["robots"].size(), 2U);
    EXPECT_EQ(fleet["robots"][0]["location"]["level_name"], "L1");
}

TEST(RosFeed, RobotsAreMarkers) {
    Fed fed;
    fed.feed.want(fed.number("/robots"));
    const json markers = fed.newest("/robots")["markers"];
    ASSERT_EQ(markers.size(), 5U) << "a deletion, two bodies, two names";
    EXPECT_EQ(markers[1]["type"], 3);
    EXPECT_EQ(markers[2]["text"], "r1");
}

TEST(RosFeed, RobotsHaveABatteryJointsAndAModel) {
    int written = 0;
    Fed fed("", {.robot_model = [&written](const Scene&, std::size_t robot,
                                           const std::string& frame, auto wheels, auto sensors) {
                ++written;
                std::string text = std::to_string(robot) + frame;
                for (const std::string& each : wheels) text += ' ' + each;
                for (const std::string& each : sensors) text += ' ' + each;
                return text;
            }});
    for (const char* topic : {"/r2/battery_state", "/r1/joint_states", "/r2/robot_description"})
        fed.feed.want(fed.number(topic));
    const json battery = fed.newest("/r2/battery_state");
    EXPECT_EQ(battery["voltage"], 12.5);
    EXPECT_EQ(battery["percentage"], 1.0);
    EXPECT_EQ(battery["power_supply_status"], 4);
    EXPECT_EQ(battery["present"], true);
    EXPECT_TRUE(battery["current"].is_null());
    EXPECT_EQ(battery["serial_number"], "");
    EXPECT_EQ(fed.newest("/r1/joint_states")["name"],
              json({"r1_left_wheel_joint", "r1_right_wheel_joint"}));
    const auto model = fed.entry("/r2/robot_description").newest;
    EXPECT_EQ(fed.newest("/r2/robot_description")["data"],
              "1r2 r2_left_wheel r2_right_wheel l1 l2");
    EXPECT_TRUE(fed.entry("/r2/robot_description").channel.quality.is_latched);
    fed.room.world.change(Scene(fed.room.world.scene()));
    fed.state.sync();
    fed.feed.stepped();
    EXPECT_EQ(written, 2);
    EXPECT_EQ(fed.entry("/r2/robot_description").newest, model) << "it is the same";
}

TEST(RosFeed, FramesLeadFromTheMapToEachSensor) {
    Fed fed("camera id=c1 on=r1 at=0,0,1 pixels=4,3\nhuman id=h1 at=-2,2\n");
    for (const char* topic : {"/tf", "/tf_static"}) fed.feed.want(fed.number(topic));
    std::map<std::string, std::string> parents;
    for (const char* topic : {"/tf", "/tf_static"}) {
        const json message = fed.newest(topic);
        for (const json& one : message["transforms"]) {
            const bool is_new =
                parents.emplace(one["child_frame_id"], one["header"]["frame_id"]).second;
            EXPECT_TRUE(is_new) << one["child_frame_id"];
        }
    }
    for (const char* leaf : {"l1", "l2", "c1_optical", "h1", "r2", "r1_sonar_3"}) {
        std::string frame = leaf;
        for (int i = 0; i < 6 && frame != "map"; ++i) frame = parents[frame];
        EXPECT_EQ(frame, "map") << leaf;
    }
    EXPECT_EQ(parents["r1"], "r1_odom");
    EXPECT_EQ(parents["l2"], "r1");
}

TEST(RosFeed, OdometryAndFramesAgreeWithTheWorld) {
    Fed fed;
    fed.feed.want(fed.number("/r2/odom"));
    fed.feed.want(fed.number("/tf"));
    const std::size_t r2 = fed.room.world.robotNamed("r2").value();
    fed.room.world.command(r2, {Verb::Speed, 0.5});
    fed.step(10);
    const json odometry = fed.newest("/r2/odom");
    EXPECT_EQ(odometry["child_frame_id"], "r2");
    EXPECT_NEAR(odometry["twist"]["twist"]["linear"]["x"].get<double>(), 0.5, 1e-9);
    EXPECT_NEAR(odometry["pose"]["pose"]["position"]["x"].get<double>(),
                fed.room.world.odometry(r2).pose.position.x, 1e-12);
    const json frames = fed.newest("/tf");
    for (const json& one : frames["transforms"]) {
        if (one["child_frame_id"] != "r2_odom") continue;
        EXPECT_NEAR(one["transform"]["translation"]["x"].get<double>(), 2, 1e-9) << "its start";
        EXPECT_NEAR(one["transform"]["rotation"]["z"].get<double>(), std::sqrt(0.5), 1e-9);
    }
}

TEST(RosFeed, WheelsAgreeInFramesAndJoints) {
    Fed fed;
    for (const char* topic : {"/r1/joint_states", "/tf"}) fed.feed.want(fed.number(topic));
    World& world = fed.room.world;
    world.command(0, {Verb::Speed, 0.5});
    fed.step(20);
    world.command(0, {Verb::Rotspeed, 30});
    fed.step(20);
    const Wheels wheels{.radius = 0.0825, .track = 0.33};
    const RobotStatus status = world.status(0);
    ASSERT_GT(std::abs(status.rotspeed.radians()), 0.1);
    const json joints = fed.newest("/r1/joint_states");
    const json frames = fed.newest("/tf")["transforms"];
    for (const double side : {1, -1}) {
        const std::string frame = side > 0 ? "r1_left_wheel" : "r1_right_wheel";
        const std::size_t joint = side > 0 ? 0 : 1;
        EXPECT_EQ(joints["name"][joint], frame + "_joint");
        const double angle = joints["position"][joint];
        EXPECT_EQ(angle, world.wheelTravel(0).of(wheels, side).radians());
        EXPECT_NEAR(joints["velocity"][joint].get<double>(),
                    (status.speed - side * status.rotspeed.radians() * 0.165) / 0.0825, 1e-12);
        const auto one = std::find_if(frames.begin(), frames.end(), [&](const json& each) {
            return each["child_frame_id"] == frame;
        });
        ASSERT_NE(one, frames.end()) << frame;
        EXPECT_EQ((*one)["header"]["frame_id"], "r1");
        EXPECT_EQ((*one)["transform"]["translation"]["y"], side * 0.165);
        EXPECT_EQ((*one)["transform"]["translation"]["z"], 0.0825);
        // The axis of the joint is y.
        const json& turn = (*one)["transform"]["rotation"];
        const double half =
            std::atan2(turn["y"].get<double>(), turn["w"].get<double>()) - angle / 2;
        EXPECT_NEAR(std::sin(half), 0, 1e-9);
        EXPECT_NEAR(std::hypot(turn["x"].get<double>(), turn["z"].get<double>()), 0, 1e-12);
    }
}

TEST(RosFeed, OnlyDifferentialDrivesHaveTwoWheels) {
    Fed fed("robot id=r3 at=-2,-1 drive=omni\n");
    for (const char* topic : {"/r3/joint_states", "/tf"}) fed.feed.want(fed.number(topic));
    EXPECT_EQ(fed.newest("/r3/joint_states")["name"], json::array());
    EXPECT_EQ(fed.newest("/r3/joint_states")["velocity"], json::array());
    EXPECT_EQ(fed.newest("/tf").dump().find("r3_left_wheel"), std::string::npos);
}

TEST(RosFeed, TheFramesOfOneRobotHaveTheirUsualNames) {
    const auto parents = [](const std::string& robot, const std::string& more) {
        Fed fed(more, {.robot = robot});
        fed.feed.want(fed.number("/tf_static"));
        std::map<std::string, std::string> out;
        const json message = fed.newest("/tf_static");
        for (const json& one : message["transforms"])
            out.emplace(one["child_frame_id"], one["header"]["frame_id"]);
        return out;
    };
    EXPECT_FALSE(parents("", "").contains("base_link")) << "two robots";
    auto of_r2 = parents("r2", "");
    EXPECT_EQ(of_r2["odom"], "r2_odom");
    EXPECT_EQ(of_r2["base_footprint"], "r2");
    EXPECT_EQ(of_r2["base_link"], "r2");
    EXPECT_EQ(parents("r2", "laser id=odom at=1,1\n")["odom"], "map") << "something else has it";
}

TEST(RosFeed, SonarsAndPeopleFollowTheWorld) {
    Fed fed("human id=h1 at=-2,2\n");
    for (const char* topic : {"/r1/sonar_0", "/people"}) fed.feed.want(fed.number(topic));
    const float wanted = fed.room.world.sonar(0)[0];
    EXPECT_FLOAT_EQ(fed.newest("/r1/sonar_0")["range"].get<float>(), wanted);
    EXPECT_EQ(fed.newest("/r1/sonar_0")["header"]["frame_id"], "r1_sonar_0");
    const json markers = fed.newest("/people")["markers"];
    ASSERT_EQ(markers.size(), 3U);
    EXPECT_EQ(markers[0]["action"], 3) << "first deletes all";
    EXPECT_EQ(markers[1]["type"], 3);
    EXPECT_EQ(markers[1]["pose"]["position"]["x"], -2.0);
    EXPECT_EQ(markers[2]["text"], "h1");
}

TEST(RosFeed, FramesOfCamerasAreTakenWhenWanted) {
    Fed fed("camera id=c1 at=0,-2,2 pixels=4,3 rate=5\nranger id=d1 at=0,2,1 pixels=4,3\n");
    fed.step();
    fed.feed.want(fed.number("/c1/image_raw/compressed"));
    fed.feed.want(fed.number("/d1/points"));
    fed.step(2);
    const json picture = fed.newest("/c1/image_raw/compressed");
    EXPECT_EQ(picture["format"], "png");
    EXPECT_TRUE(picture["data"].get<std::string>().starts_with("iVBOR")) << "PNG";
    EXPECT_EQ(fed.newest("/d1/points")["width"], 4);
    EXPECT_FALSE(fed.entry("/c1/camera_info").newest) << "not wanted";
}

TEST(RosFeed, DrawsTheMapOnce) {
    int drawn = 0;
    Fed fed("", {.map = [&drawn](const Scene&) {
                ++drawn;
                return RosGrid{{}, 0.05, 2, {0, 100}};
            }});
    EXPECT_EQ(drawn, 0);
    fed.feed.want(fed.number("/map"));
    fed.step(3);
    EXPECT_EQ(drawn, 1);
    EXPECT_EQ(fed.newest("/map")["data"], json::parse("[0,100]"));
}

TEST(RosFeed, TopicsKeepTheirNumbersInAChangedWorld) {
    Fed fed;
    const std::uint32_t scan = fed.number("/l1/scan");
    fed.feed.want(scan);
    const std::int64_t version = fed.feed.version();
    Scene scene = testing::scene("ispace size=8,6\n",
                                 "robot id=r9 at=0,0\nlaser id=l1 at=-3,-2 fov=4 step=2\n");
    fed.room.world.change(std::move(scene));
    fed.state.sync();
    fed.feed.stepped();
    EXPECT_NE(fed.feed.version(), version);
    EXPECT_EQ(fed.number("/l1/scan"), scan);
    EXPECT_EQ(fed.entry("/l1/scan").wanted, 1U);
    EXPECT_EQ(fed.number("/r1/odom"), 0U);
    EXPECT_NE(fed.number("/r9/odom"), 0U);
    EXPECT_NE(fed.number("/cmd_vel"), 0U) << "one robot";
    EXPECT_EQ(fed.number("/scan"), 0U) << "without a laser";
    const std::uint32_t odometry = fed.number("/odom");
    fed.feed.want(odometry);
    EXPECT_EQ(fed.newest("/odom")["child_frame_id"], "r9");
    fed.room.world.change(testing::scene("ispace size=8,6\n",
                                         "robot id=r0 at=2,0\nrobot id=r9 at=0,0\n"
                                         "laser id=a on=r0\nlaser id=b on=r9 fov=4 step=2\n"
                                         "laser id=c on=r9 fov=4 step=2\n"));
    fed.state.sync();
    fed.feed.stepped();
    EXPECT_EQ(fed.number("/odom"), odometry) << "the robot that was alone keeps it";
    EXPECT_EQ(fed.newest("/odom")["child_frame_id"], "r9");
    fed.feed.want(fed.number("/scan"));
    EXPECT_EQ(fed.newest("/scan")["header"]["frame_id"], "b") << "of the first on that robot";
}

TEST(RosFeed, AChosenRobotHasTopicsWithoutAPrefix) {
    Fed fed("", {.robot = "r2"});
    fed.feed.want(fed.number("/odom"));
    EXPECT_EQ(fed.newest("/odom")["child_frame_id"], "r2");
    EXPECT_NE(fed.number("/cmd_vel"), 0U);
    fed.room.world.change(testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n"));
    fed.state.sync();
    fed.feed.sync();
    EXPECT_EQ(fed.number("/odom"), 0U) << "no other robot takes its names";
    fed.room.world.change(
        testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\nrobot id=r2 at=2,0\n"));
    fed.state.sync();
    fed.feed.sync();
    fed.feed.want(fed.number("/odom"));
    EXPECT_EQ(fed.newest("/odom")["child_frame_id"], "r2");
}

TEST(RosFeed, EqualNamesGetNumbers) {
    const Fed fed("laser id=a-b at=0,-2\nlaser id=a_b at=0,2\nlaser id=map at=1,2\n");
    EXPECT_NE(fed.number("/a_b/scan"), 0U);
    EXPECT_NE(fed.number("/a_b_2/scan"), 0U);
    EXPECT_NE(fed.number("/map_2/scan"), 0U) << "map is the world's frame";
}

}  // namespace ros_feed_test
}  // namespace ispace::ros
