// SPDX-License-Identifier: GPL-3.0-or-later
// Requests go through sessions of the protocol: one of the role WORLD, and one of the role ROBOT
// for each robot on its way to a goal, so that holds, tokens and limits are those of every client.
// Speeds (cmd_vel) hold a robot until they cease.
#include "extensions/ros/ros_orders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>

#include "base/number.h"
#include "env/point_location.h"
#include "extensions/ros/ros_source.h"
#include "record/schema.h"
#include "sim/odometry.h"

namespace ispace::ros {

namespace {

constexpr std::size_t kMaxRequests = 16;
constexpr const char* kRecorded = "this run is a replay: robots go as recorded";

}  // namespace

std::span<const RosService> rosServices() {
    static constexpr std::array<RosService, 3> kServices{
        {{"/reset", "RESET"}, {"/pause", "PAUSE"}, {"/resume", "RESUME"}}};
    return kServices;
}

RosOrders::RosOrders(ServerState& state, std::function<void(const std::string&)> tell,
                     std::string peer)
    : state_(&state), tell_(std::move(tell)), session_(state, peer), peer_(std::move(peer)) {}

RosOrders::~RosOrders() {
    for (const auto& [robot, driven] : driven_) release(robot, driven.hold);
}

ServerState& RosOrders::stateOf(std::size_t room) { return *state_->rooms().states[room]; }

ServerState& RosOrders::stateOf(const std::string& robot) { return *state_->find(robot).state; }

void RosOrders::release(const std::string& robot, std::int64_t hold) {
    ServerState& state = stateOf(robot);
    state.sync();
    if (state.holds(robot, hold)) state_->rooms().worlds->abandonTrip(robot);
    state.release(robot, hold);
}

unsigned RosOrders::present(std::string_view token) {
    constexpr unsigned kWrong = 401, kTooMany = 429;
    // A token has no blanks: others are as wrong as any, and count as one.
    const bool is_word = token.find_first_of(" \t\r\n") == std::string_view::npos;
    session_.request("TOKEN " + (is_word && !token.empty() ? std::string(token) : "\x7f"));
    const std::string answer = session_.take();
    if (answer.starts_with("OK")) {
        token_ = token;
        return 0;
    }
    return answer.starts_with("ERR 429") ? kTooMany : kWrong;
}

bool RosOrders::mayRequest() const { return requests_.size() < kMaxRequests; }

void RosOrders::stepped() {
    session_.stepped();
    watch();
    watchGoals();
    answerRequests();
}

void RosOrders::proceed() {
    session_.proceed();
    answerRequests();
}

void RosOrders::finish() {
    session_.finish();
    takeAnswer();
    requests_.clear();
    going_.clear();
}

void RosOrders::request(std::string line, Answer answer) {
    requests_.emplace_back(std::move(line), std::move(answer));
    answerRequests();
}

void RosOrders::answerRequests() {
    takeAnswer();
    while (!requests_.empty() && !awaited_ && !session_.waiting()) {
        auto [line, answer] = std::move(requests_.front());
        requests_.pop_front();
        awaited_ = std::move(answer);
        if (!session_.hasRole()) {
            session_.request("WORLD");
            if (session_.hasRole()) static_cast<void>(session_.take());
        }
        // Without the role, its refusal is the answer.
        if (session_.hasRole()) session_.request(line);
        takeAnswer();
    }
}

/// Hands the answer of the request under way to its asker.
void RosOrders::takeAnswer() {
    std::string text = session_.take();
    if (text.empty() || !awaited_) return;
    if (text.ends_with('\n')) text.pop_back();
    const bool is_done = text.starts_with("OK ");
    constexpr std::string_view kError = "ERR 404 ";
    std::exchange(awaited_, nullptr)(
        is_done, std::string_view(text).substr(is_done ? 3 : std::min(kError.size(), text.size())));
}

void RosOrders::obey(const RosChannel& channel, std::string_view message) {
    if (channel.source != nullptr) return request(channel, message);
    if (channel.state) return set(*channel.state, stateValue(channel.type, message));
    const RosOrder order = channel.row->decode(channel.type, message);
    state_->echoes().put(channel.echoKey(), message);
    if (const auto* tracks = std::get_if<std::vector<RosTrack>>(&order))
        return take(*tracks, stateOf(channel.room));
    const std::string robot = robotOf(channel);
    if (state_->simulation().isReplay()) return tell_(kRecorded);
    if (const auto* twist = std::get_if<RosTwist>(&order)) return drive(robot, *twist);
    if (const auto* goal = std::get_if<RosGoal>(&order)) {
        go(robot, *goal);
        return;
    }
    place(robot, std::get<RosPose>(order));
}

/// Takes what a tracker tells of a room; times are those of the headers.
void RosOrders::take(const std::vector<RosTrack>& tracks, ServerState& state) {
    constexpr double kNanosecond = 1e-9, kFarthest = 1e6;
    Simulation& simulation = state.simulation();
    const SimTime now = simulation.world().time();
    for (const RosTrack& track : tracks) {
        std::string name = track.name;
        for (char& letter : name)
            if (!isWord({&letter, 1})) letter = '_';
        const auto [x, y] = track.place;
        if (!(std::abs(x) < kFarthest) || !(std::abs(y) < kFarthest))
            return tell_("the place of track " + name + " must be numbers");
        const double time = static_cast<double>(track.time) * kNanosecond;
        if (!simulation.tracks().report({.told = now,
                                         .time = track.time == 0 ? seconds(now) : time,
                                         .track = name,
                                         .kind = track.kind,
                                         .place = track.place}))
            return tell_("too many tracks are told");
    }
}

/// Makes the request that a message to a source asks for.
void RosOrders::request(const RosChannel& channel, std::string_view message) {
    const std::string line = channel.source->request(
        {channel.topic, channel.type, channel.about, channel.rate, true}, message);
    if (line.empty()) return;
    if (state_->simulation().isReplay())
        return tell_("this run is a replay: things are as recorded");
    constexpr std::size_t kMaxLine = 512;
    if (line.size() > kMaxLine || line.find_first_of(std::string_view("\r\n\0", 3)) != line.npos)
        return tell_("the message to " + channel.topic + " names no thing");
    if (!mayRequest()) return tell_("too many commands at once");
    request(line, [this](bool is_done, std::string_view text) {
        if (!is_done) tell_(std::string(text));
    });
}

/// Sets a state of a thing, as the request ACT does.
void RosOrders::set(const RosState& state, const std::string& value) {
    constexpr std::size_t kMaxValue = 256;
    const std::string name = state.name + ' ' + state.key;
    if (state_->simulation().isReplay())
        return tell_("this run is a replay: things are as recorded");
    if (value.empty() || value.size() > kMaxValue ||
        value.find_first_of(std::string_view(" \t\r\n\0", 5)) != std::string::npos)
        return tell_("this is no value of " + name);
    if (!mayRequest()) return tell_("too many commands at once");
    request("ACT " + name + '=' + value, [this](bool is_done, std::string_view text) {
        if (!is_done) tell_(std::string(text));
    });
}

void RosOrders::drive(const std::string& robot, const RosTwist& twist) {
    ServerState& state = stateOf(robot);
    World& world = state.simulation().world();
    if (!std::isfinite(twist.forward + twist.left + twist.turn.radians()))
        return tell_("the speeds of " + robot + " must be numbers");
    if (const auto going = going_.find(robot); going != going_.end())
        endGoal(going, RosGoalEnd::Failed, robot + " has speeds instead");
    state.sync();
    const auto index = world.robotNamed(robot);
    Driven& driven = driven_[robot];
    if (driven.hold == 0 || !state.holds(robot, driven.hold)) {
        const auto hold = state.hold(robot);
        if (!hold || !index) {
            driven_.erase(robot);
            return tell_("robot " + robot + " is held by another client");
        }
        driven.hold = *hold;
    }
    driven.last = world.time();
    if (const std::string busy = state_->rooms().worlds->endTrip(robot, Outcome::Replaced);
        !busy.empty())
        return tell_(robot + ": " + busy);
    const RobotModel& model = world.robots()[*index].model;
    const auto give = [&](Verb verb, double value, double most) {
        const Command command{.verb = verb, .value = std::clamp(value, -most, most)};
        if (world.refusal(*index, command).empty()) world.command(*index, command);
    };
    give(Verb::Speed, twist.forward, model.max_speed);
    give(Verb::Rotspeed, twist.turn.degrees(), model.max_rotspeed.degrees());
    if (model.drive == Drive::Omni) give(Verb::Sidespeed, twist.left, model.max_sidespeed);
}

/// Finds the storey with the frame that the pose names or, in the frame map, the one with its floor
/// nearest to the pose's height; of several there, that which has the point indoors.
std::optional<RosOrders::Target> RosOrders::targetOf(const std::string& robot,
                                                     const RosPose& pose) {
    const Point2 at = pose.pose.position;
    const double heading = pose.pose.heading.degrees();
    if (!std::isfinite(at.x + at.y + heading + pose.height)) {
        tell_("the pose of " + robot + " must be numbers");
        return {};
    }
    const Worlds& worlds = *state_->rooms().worlds;
    const auto rooms = worlds.rooms();
    const bool is_in_map = pose.frame.empty() || pose.frame == kRosWorld;
    struct Found {
        std::string room;
        Pose2 pose;
        double off = 0;  // of the floor
        bool is_indoor = false;
    };
    std::optional<Found> best;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        const RoomFrame frame = worlds.frameOf(i);
        if (!frame.is_storey || (!is_in_map && rosName(rooms[i].id) != pose.frame)) continue;
        Found found{.room = rooms[i].id, .pose = pose.pose};
        if (is_in_map) {
            const Pose2 place{frame.pose.position.onFloor(), frame.pose.heading};
            found.pose = relativePose(place, pose.pose);
            found.off = std::fabs(frame.pose.position.z - pose.height);
        }
        const Environment& environment = rooms[i].simulation->world().scene().environment;
        found.is_indoor = environment.indoorIndex().locate(found.pose.position) == Side::Inside;
        const bool is_better = !best || found.off < best->off ||
                               (found.off == best->off && found.is_indoor && !best->is_indoor);
        if (is_better) best = std::move(found);
    }
    if (!best) {
        tell_("the pose of " + robot + " is wanted in the frame map" +
              (rooms.front().id.empty() ? "" : " or in that of a storey"));
        return {};
    }
    const Point2 to = best->pose.position;
    return Target{prefixOf(best->room) + formatDouble(to.x) + ',' + formatDouble(to.y),
                  best->pose.heading.degrees()};
}

/// Puts a robot to its place and then, if it may be there, to its heading.
void RosOrders::place(const std::string& robot, const RosPose& pose) {
    const auto target = targetOf(robot, pose);
    if (!target) return;
    if (!mayRequest()) return tell_("too many poses at once");
    const auto tell = [this](bool is_done, std::string_view text) {
        if (!is_done) tell_(std::string(text));
    };
    request("SET " + robot + ".at=" + target->at,
            [this, tell, line = "SET " + robot + ".heading=" + formatDouble(target->heading)](
                bool is_done, std::string_view text) {
                tell(is_done, text);
                // The next request, before those that wait.
                if (is_done) requests_.emplace_front(line, tell);
            });
}

/// Sends a robot to a goal, in place of an earlier one.
bool RosOrders::go(const std::string& robot, const RosGoal& goal) {
    const auto target = targetOf(robot, goal.pose);
    if (!target) return false;
    if (const auto driven = driven_.find(robot); driven != driven_.end()) {
        release(robot, driven->second.hold);
        driven_.erase(driven);
    }
    Going& going = going_[robot];
    std::unique_ptr<Session>& session = going.session;
    const bool is_new = session == nullptr;
    if (is_new) session = std::make_unique<Session>(*state_, peer_);
    if (session->waiting()) {
        tell_("too many goals at once");
        return false;
    }
    const bool has_role = !is_new || ((token_.empty() || ask(robot, *session, "TOKEN " + token_)) &&
                                      ask(robot, *session, "ROBOT " + robot));
    const std::string heading = goal.has_heading ? ',' + formatDouble(target->heading) : "";
    const bool goes = has_role && ask(robot, *session, "GOTO " + target->at + heading);
    // A refused goal does not end the way to an earlier one.
    if (!goes && is_new) going_.erase(robot);
    if (goes && going.ended)
        std::exchange(going.ended, nullptr)(RosGoalEnd::Failed, robot + " has a later goal");
    return goes;
}

std::string RosOrders::robotOf(const RosChannel& channel) {
    return stateOf(channel.room).simulation().world().robots()[channel.subject].id;
}

std::string RosOrders::pursue(const RosChannel& channel, std::string_view message,
                              GoalEnded ended) {
    const RosGoal goal{poseOf(message)};
    if (state_->simulation().isReplay()) return kRecorded;
    const std::string robot = robotOf(channel);
    // The reasons answer the request.
    std::string why;
    struct Heard {
        std::function<void(const std::string&)>& tell;
        std::function<void(const std::string&)> before;
        ~Heard() { tell = std::move(before); }
    };
    bool goes = false;
    {
        const Heard heard{tell_, std::exchange(tell_, [&why](const std::string& text) {
                              if (why.empty()) why = text;
                          })};
        goes = go(robot, goal);
    }
    if (goes) going_.at(robot).ended = std::move(ended);
    return goes || !why.empty() ? why : "the goal is refused";
}

std::string RosOrders::cancel(const std::string& robot) {
    const auto going = going_.find(robot);
    if (going == going_.end()) return robot + " goes to no goal";
    Session& session = *going->second.session;
    session.request("STOP");
    const std::string answer = session.take();
    if (answer.starts_with("ERR ")) return answer.substr(0, answer.find('\n'));
    endGoal(going, RosGoalEnd::Canceled, "");
    return "";
}

std::optional<RosProgress> RosOrders::progress(const std::string& robot) const {
    if (!going_.contains(robot)) return {};
    const auto worlds = state_->worlds();
    for (std::size_t room = 0; room < worlds.size(); ++room) {
        const World& world = *worlds[room].world;
        const auto mover = world.robotNamed(robot);
        if (!mover) continue;
        const RobotStatus status = world.status(*mover);
        RosProgress out{room, status.pose, 0, std::hypot(status.speed, status.sidespeed)};
        for (Point2 at = status.pose.position; const Point2& next : world.wayAhead(*mover)) {
            out.distance += distance(at, next);
            at = next;
        }
        return out;
    }
    return {};
}

/// Frees a robot. \returns the next one
RosOrders::AllGoing::iterator RosOrders::endGoal(AllGoing::iterator going, RosGoalEnd end,
                                                 const std::string& why) {
    const GoalEnded ended = std::move(going->second.ended);
    const auto next = going_.erase(going);
    if (ended) ended(end, why);
    return next;
}

/// Makes a request of the client that holds a robot. \returns false, and tells why, if it fails
bool RosOrders::ask(const std::string& robot, Session& session, const std::string& line) {
    session.request(line);
    const std::string answer = session.take();
    constexpr std::string_view kError = "ERR 404 ";
    if (!answer.starts_with("ERR ")) return true;
    const std::size_t end = std::min(answer.find('\n'), answer.size());
    const std::size_t begin = std::min(kError.size(), end);
    tell_("goal of " + robot + ": " + answer.substr(begin, end - begin));
    return false;
}

/// Frees robots that are at their goals, or cannot go on.
void RosOrders::watchGoals() {
    for (auto robot = going_.begin(); robot != going_.end();) {
        Session& session = *robot->second.session;
        session.stepped();
        bool has_ended = session.closing(), has_come = false;
        std::string why;
        std::istringstream lines(session.take());
        for (std::string line; std::getline(lines, line);) {
            const bool has_failed =
                line.starts_with("FAIL ") && line.find(" reason=replaced") == std::string::npos;
            if (has_failed) why = "robot " + robot->first + " did not come to its goal: " + line;
            has_come = has_come || line.starts_with("DONE ");
            has_ended = has_ended || has_failed || has_come;
        }
        // The end of a goal of pursue() is its answer.
        if (!why.empty() && !robot->second.ended) tell_(why);
        robot = has_ended ? endGoal(robot, has_come ? RosGoalEnd::Reached : RosGoalEnd::Failed, why)
                          : std::next(robot);
    }
}

/// Stops robots that get no more orders.
void RosOrders::watch() {
    if (driven_.empty()) return;
    const SimTime now = state_->simulation().world().time();
    for (auto robot = driven_.begin(); robot != driven_.end();) {
        const SimTime since = now - robot->second.last;
        if (since >= SimTime(0) && since < kRosSilence) {
            ++robot;
            continue;
        }
        release(robot->first, robot->second.hold);
        robot = driven_.erase(robot);
    }
}

}  // namespace ispace::ros
