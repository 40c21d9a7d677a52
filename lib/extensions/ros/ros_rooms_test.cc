// SPDX-License-Identifier: GPL-3.0-or-later
// Topics of a run with several worlds, and requests to them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "extensions/ros/ros_feed.h"
#include "extensions/ros/ros_orders.h"
#include "extensions/ros/ros_parameters.h"
#include "extensions/ros/ros_text.h"
#include "sim/worlds.h"
#include "support/test_layout.h"
#include "support/test_source.h"

namespace ispace::ros {
namespace ros_rooms_test {

using nlohmann::json;

constexpr const char* kRoom = "ispace size=8,6\n";
constexpr const char* kRobot =
    "robot id=ground/r1 at=1,2 heading=90\nlaser id=ground/eye on=ground/r1 at=0,0,0.3 fov=4\n";
constexpr const char* kFixed = "laser id=l at=-3,-2 fov=4 step=2 range=0.1,7.002\n";

/// Two storeys in steps of 0.1 s, the upper one turned and moved, and the cabin of a lift. The
/// robot begins on the lower one.
class ThreeRooms final : public Worlds {
  public:
    ThreeRooms() {
        simulations_[0].lead(simulations_[1]);
        simulations_[0].lead(simulations_[2]);
    }

    /// Moves the robot between two rooms.
    void go(std::size_t from, std::size_t to) {
        worlds_[from].change(testing::scene(kRoom, kFixed));
        worlds_[to].change(testing::scene(kRoom, std::string(kFixed) + kRobot));
        at_ = to;
        for (const Observer& observer : observers_) observer("ground/r1", from, to);
    }
    double cabin = 0;  ///< height
    std::string busy;  ///< reason of endTrip()
    std::vector<Outcome> ends;
    std::optional<RoomPoint> placed;  ///< of place()
    std::optional<Angle> turned;
    int restarts = 0;
    LiftState lift{.id = "l1", .storey = "ground", .riders = {}, .calls = {}};
    std::vector<std::string> calls;  ///< of call()

    [[nodiscard]] std::span<const RunRoom> rooms() const override { return rooms_; }
    [[nodiscard]] std::optional<std::size_t> roomOf(std::string_view mover) const override {
        return mover == "ground/r1" ? std::optional(at_) : std::nullopt;
    }
    [[nodiscard]] std::string whereText(std::size_t /*room*/) const override { return ""; }
    [[nodiscard]] RoomFrame frameOf(std::size_t room) const override {
        if (room == 2) return {{{0, 0, cabin}, {}, {}, {}}, false};
        if (room == 1) return {{{10, 0, 3}, Angle::degrees(90), {}, {}}, true};
        return {{}, true};
    }
    [[nodiscard]] std::vector<PassageOutline> passageOutlines(std::size_t room) const override {
        if (room == 2) return {};
        return {{.id = "l1", .kind = "lift", .outline = {}}};
    }
    [[nodiscard]] std::vector<PlannedPath> plannedPaths(std::size_t /*room*/) const override {
        return {};
    }
    TripAnswer travel(const std::string& /*mover*/, TripPlan /*plan*/) override { return {}; }
    TripAnswer ride(const std::string& /*mover*/, std::string_view /*lift*/,
                    std::string_view /*storey*/) override {
        return {};
    }
    std::string endTrip(const std::string& /*mover*/, Outcome outcome) override {
        ends.push_back(outcome);
        return busy;
    }
    void abandonTrip(const std::string& /*mover*/) override { ends.push_back(Outcome::Stopped); }
    std::string place(const std::string& /*mover*/, const std::optional<RoomPoint>& at,
                      std::optional<Angle> heading) override {
        if (at) placed = at;
        if (heading) turned = heading;
        return busy;
    }
    void restart() override { ++restarts; }
    std::string call(std::string_view lift, std::string_view storey) override {
        calls.push_back(std::string(lift) + ' ' + std::string(storey));
        return lift == "l1" ? "" : "there is no such lift";
    }
    std::string hold(std::string_view lift, std::string_view storey) override {
        calls.push_back("hold " + std::string(lift) + ' ' + std::string(storey));
        return "";
    }
    [[nodiscard]] std::vector<LiftState> lifts() const override { return {lift}; }
    [[nodiscard]] std::span<const TripEnd> tripEnds() const override { return {}; }
    void onMove(Observer observer) override { observers_.push_back(std::move(observer)); }

    World& world(std::size_t room) { return worlds_[room]; }
    Simulation& simulation(std::size_t room) { return simulations_[room]; }

  private:
    static constexpr auto kStep = std::chrono::milliseconds(100);
    static World worldOf(const std::string& layout) {
        return {std::make_shared<const Scene>(testing::scene(kRoom, layout)), kStep};
    }
    World worlds_[3] = {worldOf(std::string(kFixed) + kRobot), worldOf(kFixed), worldOf(kFixed)};
    Simulation simulations_[3] = {Simulation(worlds_[0], {}, {Clock::Kind::Step, 1}, {}),
                                  Simulation(worlds_[1], {}, {Clock::Kind::Fast, 1}, {}),
                                  Simulation(worlds_[2], {}, {Clock::Kind::Fast, 1}, {})};
    std::vector<RunRoom> rooms_ = {
        {"ground", &simulations_[0]}, {"upper", &simulations_[1]}, {"l1", &simulations_[2]}};
    std::vector<Observer> observers_;
    std::size_t at_ = 0;
};

struct Served {
    explicit Served(const ServerLimits& limits = {}, RosScenery scenery = {}) {
        for (std::size_t i = 0; i < 3; ++i) states.emplace_back(worlds.simulation(i), limits);
        for (ServerState& state : states) served.states.push_back(&state);
        served.worlds = &worlds;
        for (ServerState& state : states) state.joinRooms(served);
        worlds.onMove([this](const std::string& mover, std::size_t from, std::size_t to) {
            states[to].takeOver(states[from], mover);
        });
        feed.emplace(states.front(), std::move(scenery));
    }
    void step() {
        worlds.simulation(0).allow(1);
        worlds.simulation(0).run({}, std::chrono::nanoseconds(0));
        feed->stepped();
    }
    const RosFeed::Entry& entry(const std::string& topic) const {
        return feed->entries().at(feed->numbersOf(topic).front());
    }
    json newest(const std::string& topic) {
        const std::uint32_t number = feed->numbersOf(topic).front();
        feed->want(number);
        const auto& message = feed->entries().at(number).newest;
        return message ? json::parse(*message->json()) : json();
    }
    /// Returns the newest transforms by the frame that they are of.
    std::map<std::string, json> transforms() {
        std::map<std::string, json> all;
        for (const char* topic : {"/tf", "/tf_static"}) {
            const json message = newest(topic);
            for (const json& one : message["transforms"]) {
                EXPECT_FALSE(all.contains(one["child_frame_id"])) << one["child_frame_id"];
                all[one["child_frame_id"]] = one;
            }
        }
        return all;
    }

    ThreeRooms worlds;
    std::deque<ServerState> states;
    ServedRooms served;
    std::optional<RosFeed> feed;
};

TEST(RosRooms, HaveTopicsOfTheirStoreysAndThings) {
    const Served served;
    std::set<std::string> topics;
    for (const auto& [number, entry] : served.feed->entries()) topics.insert(entry.channel.topic);
    for (const char* topic :
         {"/clock", "/tf", "/tf_static", "/diagnostics", "/ground/map", "/upper/map", "/upper/room",
          "/upper/people", "/l1/people", "/ground_r1/odom", "/ground_r1/cmd_vel", "/cmd_vel",
          "/ground_eye/scan", "/ground_l/scan", "/upper_l/scan"})
        EXPECT_TRUE(topics.contains(topic)) << topic;
    for (const char* topic : {"/map", "/people", "/l1/map", "/l1/room", "/l/scan"})
        EXPECT_FALSE(topics.contains(topic)) << topic;
}

TEST(RosRooms, StandInOneMapAtTheirHeights) {
    Served served;
    served.step();
    auto frames = served.transforms();
    EXPECT_EQ(frames["upper"]["header"]["frame_id"], "map");
    EXPECT_EQ(frames["upper"]["transform"]["translation"],
              json({{"x", 10.0}, {"y", 0.0}, {"z", 3.0}}));
    EXPECT_NEAR(frames["upper"]["transform"]["rotation"]["z"].get<double>(), std::sqrt(0.5), 1e-9);
    EXPECT_EQ(frames["upper_l"]["header"]["frame_id"], "upper");
    EXPECT_EQ(frames["ground_r1_odom"]["header"]["frame_id"], "ground");
    EXPECT_EQ(frames["ground_r1"]["header"]["frame_id"], "ground_r1_odom");
    EXPECT_EQ(frames["ground_eye"]["header"]["frame_id"], "ground_r1");
    served.worlds.cabin = 1.5;
    served.step();
    EXPECT_EQ(served.transforms()["l1"]["transform"]["translation"]["z"], 1.5);
    EXPECT_EQ(served.newest("/upper_l/scan")["header"]["frame_id"], "upper_l");
    EXPECT_EQ(served.newest("/ground/people")["markers"][0]["header"]["frame_id"], "ground");
}

TEST(RosRooms, LiftsHaveStatesAndAreCalled) {
    Served served;
    EXPECT_EQ(served.newest("/l1/storey")["data"], "ground");
    EXPECT_EQ(served.newest("/l1/open")["data"], false);
    EXPECT_TRUE(served.entry("/l1/storey").channel.quality.is_latched);
    const auto storey = served.entry("/l1/storey").newest;
    served.worlds.lift.door = 0.5;
    served.step();
    EXPECT_EQ(served.newest("/l1/open")["data"], true);
    EXPECT_EQ(served.entry("/l1/storey").newest, storey) << "it has not changed";
    std::vector<std::string> told;
    RosOrders orders(served.states.front(), [&](const std::string& text) { told.push_back(text); });
    const RosChannel& set = served.entry("/l1/storey/set").channel;
    EXPECT_TRUE(set.isInput());
    orders.obey(set, textMessage("upper"));
    orders.obey(set, textMessage("two words"));
    orders.proceed();
    EXPECT_EQ(served.worlds.calls, std::vector<std::string>{"l1 upper"});
    EXPECT_EQ(told.size(), 1U);
}

TEST(RosRooms, LiftsAndFleetsAreThoseOfOpenRmf) {
    Served served({}, {.sources = {rmfTopics()}});
    json lift = served.newest("/lift_states");
    EXPECT_EQ(lift["lift_name"], "l1");
    EXPECT_EQ(lift["available_floors"], json({"ground", "upper"}));
    EXPECT_EQ(lift["current_floor"], "ground");
    EXPECT_EQ(lift["destination_floor"], "ground");
    EXPECT_EQ(lift["door_state"], 0);
    EXPECT_EQ(lift["motion_state"], 0);
    EXPECT_EQ(lift["available_modes"], "AQI=") << "bytes 1, 2";
    EXPECT_EQ(lift["current_mode"], 2);
    EXPECT_EQ(lift["session_id"], "");

    std::vector<std::string> told;
    RosOrders orders(served.states.front(), [&](const std::string& text) { told.push_back(text); });
    const auto ask = [&](const char* name, const char* session, int type, const char* floor) {
        orders.obey(served.entry("/lift_requests").channel,
                    rosMessage(RosType::LiftRequest, {{"lift_name", name},
                                                      {"session_id", session},
                                                      {"request_type", type},
                                                      {"destination_floor", floor}}));
        orders.proceed();
    };
    ask("l1", "adapter/r1", 1, "upper");
    ask("l1", "adapter/r2", 1, "ground");
    EXPECT_EQ(served.worlds.calls, std::vector<std::string>{"hold l1 upper"}) << "r1 has the lift";
    served.worlds.lift.calls = {"upper"};
    served.worlds.lift.height = 1;
    for (int i = 0; i < 3; ++i) served.step();
    lift = served.newest("/lift_states");
    EXPECT_EQ(lift["session_id"], "adapter/r1");
    EXPECT_EQ(lift["destination_floor"], "upper");
    EXPECT_EQ(lift["motion_state"], 1);
    served.worlds.lift = {
        .id = "l1", .storey = "upper", .height = 3, .door = 1, .riders = {}, .calls = {}};
    ask("l1", "adapter/r1", 0, "");
    EXPECT_EQ(served.worlds.calls.back(), "hold l1 ") << "its doors may close";
    ask("l1", "adapter/r2", 2, "ground");
    EXPECT_EQ(served.worlds.calls.back(), "l1 ground");
    for (int i = 0; i < 3; ++i) served.step();
    lift = served.newest("/lift_states");
    EXPECT_EQ(lift["current_floor"], "upper");
    EXPECT_EQ(lift["door_state"], 2);
    EXPECT_EQ(lift["motion_state"], 0);
    EXPECT_EQ(lift["session_id"], "adapter/r2");
    EXPECT_EQ(lift["current_mode"], 1) << "of people";
    EXPECT_EQ(told, std::vector<std::string>());
    ask("l9", "adapter/r1", 1, "upper");
    EXPECT_EQ(told.size(), 1U);

    const auto robots = [&] { return served.newest("/fleet_states")["robots"]; };
    ASSERT_EQ(robots().size(), 1U);
    EXPECT_EQ(robots()[0]["name"], "ground/r1");
    EXPECT_EQ(robots()[0]["battery_percent"], 100.0);
    EXPECT_EQ(robots()[0]["mode"]["mode"], 0);
    EXPECT_EQ(robots()[0]["location"]["level_name"], "ground");
    EXPECT_EQ(robots()[0]["location"]["x"], 1.0);
    served.worlds.go(0, 1);
    for (int i = 0; i < 6; ++i) served.step();
    EXPECT_EQ(robots()[0]["location"]["level_name"], "upper");
    // That storey stands at 10,0, turned by a quarter.
    EXPECT_NEAR(robots()[0]["location"]["x"].get<double>(), 8, 1e-6);
    EXPECT_NEAR(robots()[0]["location"]["y"].get<double>(), 1, 1e-6);
    EXPECT_NEAR(robots()[0]["location"]["yaw"].get<double>(), std::acos(-1.0), 1e-6);
}

TEST(RosRooms, FollowARobotToAnotherStorey) {
    Served served;
    const std::uint32_t odometry = served.feed->numbersOf("/ground_r1/odom").front();
    served.feed->want(odometry);
    served.worlds.go(0, 1);
    served.step();
    EXPECT_EQ(served.feed->numbersOf("/ground_r1/odom").front(), odometry);
    EXPECT_EQ(served.entry("/ground_r1/odom").channel.room, 1U);
    EXPECT_TRUE(served.entry("/ground_r1/odom").newest);
    EXPECT_EQ(served.transforms()["ground_r1_odom"]["header"]["frame_id"], "upper");
}

TEST(RosRooms, OrdersFindTheRobotWhereverItIs) {
    Served served;
    std::vector<std::string> told;
    RosOrders orders(served.states.front(), [&](const std::string& text) { told.push_back(text); });
    const auto drive = [&] {
        served.feed->sync();
        const RosChannel& channel = served.entry("/ground_r1/cmd_vel").channel;
        std::string message{"\0\1\0\0", 4};
        const double speed = 0.25, none = 0;
        message.append(reinterpret_cast<const char*>(&speed), sizeof speed);
        for (int i = 0; i < 5; ++i)
            message.append(reinterpret_cast<const char*>(&none), sizeof none);
        orders.obey(channel, message);
    };
    drive();
    served.step();
    orders.stepped();
    EXPECT_GT(served.worlds.world(0).status(0).speed, 0);
    served.worlds.go(0, 1);
    drive();
    for (int i = 0; i < 5; ++i) served.step();
    EXPECT_GT(served.worlds.world(1).status(0).speed, 0);
    EXPECT_EQ(told, std::vector<std::string>());
    // Silence stops it there, and frees it.
    for (int i = 0; i < 20; ++i) {
        served.step();
        orders.stepped();
    }
    EXPECT_FALSE(orders.isDriving());
    EXPECT_EQ(served.worlds.ends.back(), Outcome::Stopped);
    EXPECT_EQ(served.worlds.world(1).status(0).speed, 0);
    EXPECT_TRUE(served.states[1].hold("ground/r1"));
    served.worlds.busy = "it is in the lift l1";
    served.states[1].release("ground/r1", 2);
    drive();
    EXPECT_EQ(told.back(), "ground/r1: it is in the lift l1");
}

TEST(RosRooms, InitialPosesFindTheirStorey) {
    ServerLimits limits;
    limits.source = std::make_shared<testing::TextSource>(std::map<std::string, std::string>{});
    Served served(limits);
    std::vector<std::string> told;
    RosOrders orders(served.states.front(), [&](const std::string& text) { told.push_back(text); });
    const auto place = [&](const std::string& frame, Point3 at, double degrees) {
        served.worlds.placed.reset();
        served.worlds.turned.reset();
        const double half = Angle::degrees(degrees / 2).radians();
        json pose = {{"position", {{"x", at.x}, {"y", at.y}, {"z", at.z}}},
                     {"orientation", {{"z", std::sin(half)}, {"w", std::cos(half)}}}};
        orders.obey(served.entry("/ground_r1/initialpose").channel,
                    rosMessage(RosType::PoseWithCovarianceStamped,
                               {{"header", {{"frame_id", frame}}}, {"pose", {{"pose", pose}}}}));
        while (orders.waiting()) orders.proceed();
        orders.proceed();
    };
    place("map", {1, -2, 0}, 30);
    EXPECT_EQ(told, std::vector<std::string>());
    ASSERT_TRUE(served.worlds.placed);
    ASSERT_TRUE(served.worlds.turned);
    EXPECT_EQ(served.worlds.placed->room, 0U);
    EXPECT_EQ(served.worlds.placed->at, Point2(1, -2));
    EXPECT_NEAR(served.worlds.turned->degrees(), 30, 1e-9);
    // The upper storey stands at 10,0,3, turned by a quarter.
    place("", {9, 3, 2.5}, 30);
    ASSERT_TRUE(served.worlds.placed && served.worlds.turned);
    EXPECT_EQ(served.worlds.placed->room, 1U);
    EXPECT_NEAR(distance(served.worlds.placed->at, Point2{3, 1}), 0, 1e-9);
    EXPECT_NEAR(served.worlds.turned->degrees(), -60, 1e-9);
    place("upper", {2, 1, 0}, 0);
    ASSERT_TRUE(served.worlds.placed);
    EXPECT_EQ(served.worlds.placed->room, 1U);
    EXPECT_EQ(served.worlds.placed->at, Point2(2, 1));
    EXPECT_EQ(told, std::vector<std::string>());
    place("l1", {0, 0, 0}, 0);
    EXPECT_FALSE(served.worlds.placed);
    EXPECT_EQ(told.back(),
              "the pose of ground/r1 is wanted in the frame map or in that of a storey");
    served.worlds.busy = "it is in the lift l1";
    place("map", {1, -2, 0}, 0);
    EXPECT_EQ(told.back(), "it is in the lift l1");
    EXPECT_FALSE(served.worlds.turned) << "nor does it turn where it is";
    const std::size_t count = told.size();
    served.worlds.busy.clear();
    place("map", {2e6, -2, 0}, 0);
    ASSERT_EQ(told.size(), count + 1) << "one reason for one pose";
    EXPECT_NE(told.back().find("2000000 is above 1000000"), std::string::npos) << told.back();
    EXPECT_FALSE(served.worlds.placed || served.worlds.turned);
    bool is_done = false;
    orders.request("RESET", [&](bool done, std::string_view /*text*/) { is_done = done; });
    while (orders.waiting()) orders.proceed();
    orders.proceed();
    EXPECT_TRUE(is_done);
    EXPECT_EQ(served.worlds.restarts, 1);
}

TEST(RosRooms, ThingsOfAllRoomsAreParameters) {
    ServerLimits limits;
    limits.source = std::make_shared<testing::TextSource>(std::map<std::string, std::string>{});
    Served served(limits);
    ServerState& state = served.states.front();
    std::set<std::string> names;
    for (const RosParameter& one : rosParameters(state)) names.insert(one.name);
    EXPECT_EQ(names,
              (std::set<std::string>{"clock.paused", "clock.rate", "ground/r1.at",
                                     "ground/r1.heading", "ground/l.at", "ground/l.heading",
                                     "upper/l.at", "upper/l.heading", "l1/l.at", "l1/l.heading"}));
    Session world(state);
    world.request("WORLD");
    for (const auto& [name, value] :
         {std::pair("upper/l.at", json({1, 2, 0.5})), {"ground/r1.heading", json(90)}}) {
        static_cast<void>(world.take());
        world.request(settingOf(state, name, value).request);
        while (world.waiting()) world.proceed();
        EXPECT_EQ(world.take(), "OK SET t=0.000\n") << name;
    }
    EXPECT_EQ(served.worlds.world(1).sensors()[0].pose.position.y, 2);
    EXPECT_TRUE(served.worlds.turned);
    EXPECT_NE(settingOf(state, "r1.at", json({1, 2})).refusal, "");
}

TEST(ServedRooms, RequestsToOneRoomThatFollowShareAChange) {
    ServerLimits limits;
    limits.source = std::make_shared<testing::TextSource>(std::map<std::string, std::string>{});
    Served served(limits);
    Session world(served.states.front());
    world.request("WORLD");
    ASSERT_TRUE(world.take().starts_with("OK WORLD"));
    std::vector<std::string> lines;
    std::string wanted;
    for (int i = 0; i < 60; ++i) {
        // Two of the other storey are among them, and one that no storey has.
        const std::string id = (i == 20 || i == 21 ? "ground/m" : "upper/m") + std::to_string(i);
        lines.push_back("ADD tag id=" + (i == 40 ? "m" : id) + " at=0,1,1");
        wanted += i == 40 ? "ERR 404 `m` names no storey, as in ground/desk1\n"
                          : "OK ADD id=" + id + " t=0.000\n";
    }
    std::string answers;
    while (!lines.empty()) {
        const std::size_t joined = std::min(world.mayJoin(lines[0]), lines.size() - 1);
        for (std::size_t i = 1; i <= joined; ++i) world.join(lines[i]);
        world.request(lines[0]);
        for (answers += world.take(); world.waiting(); answers += world.take()) world.proceed();
        lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(joined) + 1);
    }
    EXPECT_EQ(answers, wanted);
    EXPECT_LT(served.worlds.world(1).changes(), 40) << "changes for 57 requests";
    EXPECT_EQ(served.worlds.world(0).scene().ids.back(), "m21");
    EXPECT_EQ(served.worlds.world(1).scene().ids.back(), "m59");
}

}  // namespace ros_rooms_test
}  // namespace ispace::ros
