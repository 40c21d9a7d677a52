// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of clients to robots and to the world, whatever protocol brings them.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/ros/ros_topics.h"
#include "server/server_state.h"
#include "server/session.h"

namespace ispace::ros {

/// A service of the world, of type std_srvs/srv/Empty, and the request that carries it out.
struct RosService {
    std::string_view name, request;
};
std::span<const RosService> rosServices();
/// The name under which clients see the run.
inline constexpr std::string_view kRosNode = "/simrun";
inline constexpr std::string_view kRosEmptyService = "std_srvs/srv/Empty";
/// The CDR of its answer: a struct without fields has one byte.
inline constexpr std::string_view kRosEmpty{"\0\1\0\0\0", 5};

/// A robot without orders for this long stops, in simulated time: the teleoperation panel of
/// Lichtblick repeats its order each second.
inline constexpr SimTime kRosSilence = std::chrono::milliseconds(1500);

/// How the way of a robot to a goal ended.
enum class RosGoalEnd { Reached, Canceled, Failed };

/// The rest of a robot's way to its goal.
struct RosProgress {
    std::size_t room = 0;  ///< in which the robot is
    Pose2 pose;
    double distance = 0;  ///< metres along the way, in that room
    double speed = 0;     ///< m/s
};

/// Orders of one client of topics to robots, and its requests to the world.
///
/// A robot is held while orders come; it stops and is free again when none has come for
/// kRosSilence. One that goes to a goal is held until it is there, or cannot go on, or gets speeds.
/// Among several worlds, orders find it in whichever it is.
class RosOrders {
  public:
    /// \param tell reports a failure that answers no request \param peer address of the client
    RosOrders(ServerState& state, std::function<void(const std::string& error)> tell,
              std::string peer = {});
    RosOrders(const RosOrders&) = delete;
    RosOrders& operator=(const RosOrders&) = delete;
    ~RosOrders();

    /// Presents a token. \returns 0 if it is right, 401 if it is wrong, 429 after too many of them
    unsigned present(std::string_view token);
    /// False if changes of the world require a token that the client has not given.
    [[nodiscard]] bool hasToken() const { return session_.hasToken(); }
    /// Carries out a message to a topic. \throws FormatError if it cannot be read
    void obey(const RosChannel& channel, std::string_view message);

    using GoalEnded = std::function<void(RosGoalEnd end, const std::string& why)>;
    /// Sends a robot to a goal, as the same message to its topic `goal_pose` does. `ended` is
    /// called once when the way ends, unless the run or the client ends before. \returns the reason
    /// why the robot does not go, or "" \throws FormatError if the message cannot be read
    std::string pursue(const RosChannel& channel, std::string_view message, GoalEnded ended);
    /// Stops a robot on its way, which ends as Canceled. \returns the reason why it goes on, or ""
    std::string cancel(const std::string& robot);
    /// Returns the rest of the way of a robot; empty if it goes to no goal.
    [[nodiscard]] std::optional<RosProgress> progress(const std::string& robot) const;
    /// Returns the id of the robot of a channel.
    [[nodiscard]] std::string robotOf(const RosChannel& channel);

    using Answer = std::function<void(bool is_done, std::string_view text)>;
    /// Makes a request of the role WORLD. `answer` gets the words after OK, or the error.
    void request(std::string line, Answer answer);
    /// False while too many requests are pending for request().
    [[nodiscard]] bool mayRequest() const;

    /// Call after each step or change of the world.
    void stepped();
    /// Call after other clients were served.
    void proceed();
    [[nodiscard]] bool waiting() const { return session_.waiting(); }
    [[nodiscard]] bool waitsToChange() const { return session_.waitsToChange(); }
    [[nodiscard]] bool isDriving() const { return !driven_.empty() || !going_.empty(); }
    /// Call at the end of the run.
    void finish();

  private:
    struct Driven {
        std::int64_t hold = 0;
        SimTime last{};
    };
    void answerRequests();
    void takeAnswer();
    [[nodiscard]] ServerState& stateOf(std::size_t room);
    [[nodiscard]] ServerState& stateOf(const std::string& robot);
    void take(const std::vector<RosTrack>& tracks, ServerState& state);
    void request(const RosChannel& channel, std::string_view message);
    void set(const RosState& state, const std::string& value);
    void drive(const std::string& robot, const RosTwist& twist);
    void release(const std::string& robot, std::int64_t hold);
    /// A pose as requests name it: "1,2" or "upper/1,2", and degrees.
    struct Target {
        std::string at;
        double heading = 0;
    };
    [[nodiscard]] std::optional<Target> targetOf(const std::string& robot, const RosPose& pose);
    void place(const std::string& robot, const RosPose& pose);
    /// A robot on its way, as a client that holds it.
    struct Going {
        std::unique_ptr<Session> session;
        GoalEnded ended = nullptr;
    };
    using AllGoing = std::map<std::string, Going>;
    bool go(const std::string& robot, const RosGoal& goal);
    AllGoing::iterator endGoal(AllGoing::iterator going, RosGoalEnd end, const std::string& why);
    bool ask(const std::string& robot, Session& session, const std::string& line);
    void watch();
    void watchGoals();

    ServerState* state_;
    std::function<void(const std::string&)> tell_;
    Session session_;  // of the role WORLD
    std::deque<std::pair<std::string, Answer>> requests_;
    Answer awaited_;  // of the request under way
    std::map<std::string, Driven> driven_;
    AllGoing going_;
    std::string peer_, token_;  // of those that hold robots on their ways
};

}  // namespace ispace::ros
