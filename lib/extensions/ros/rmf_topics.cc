// SPDX-License-Identifier: GPL-3.0-or-later
// Open-RMF's topics of lifts, doors and fleets (rmf_internal_msgs: rmf_lift_msgs, rmf_door_msgs,
// rmf_fleet_msgs), so that its supervisors and adapters run against the simulated building.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/number.h"
#include "extensions/ros/ros_source.h"
#include "scene/room_state.h"
#include "sense/formats/cdr.h"
#include "server/server.h"
#include "server/server_state.h"

namespace ispace::ros {

namespace {

constexpr std::string_view kLiftStates = "/lift_states", kLiftRequests = "/lift_requests",
                           kDoorStates = "/door_states", kDoorRequests = "/door_requests",
                           kFleetStates = "/fleet_states";
/// Messages in a simulated second about each lift, each door and the fleet: adapters of fleets ask
/// for two of robots, and for one of lifts and doors.
constexpr double kLiftRate = 5, kDoorRate = 2, kFleetRate = 2;
constexpr const char* kFleet = "ispace";
/// The level of a run without storeys, as the demonstrations of Open-RMF call their first.
constexpr const char* kOnlyLevel = "L1";

enum LiftDoor : std::uint8_t { kDoorClosed = 0, kDoorMoving = 1, kDoorOpen = 2 };
enum LiftMotion : std::uint8_t { kStopped = 0, kUp = 1, kDown = 2 };
enum LiftMode : std::uint8_t { kHuman = 1, kAgv = 2 };
enum SessionRequest : std::uint8_t { kEndSession = 0, kAgvMode = 1 };
enum DoorMode : std::uint32_t { kModeClosed = 0, kModeMoving = 1, kModeOpen = 2 };
enum RobotMode : std::uint32_t { kIdle = 0, kMoving = 2 };

void putTime(CdrWriter& out, std::uint64_t nanoseconds) {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    out.put(static_cast<std::int32_t>(nanoseconds / kSecond));
    out.put(static_cast<std::uint32_t>(nanoseconds % kSecond));
}

void skipTime(CdrReader& in) {
    in.number<std::int32_t>();
    in.number<std::uint32_t>();
}

/// Words of requests have no blanks.
bool isOneWord(std::string_view text) {
    return !text.empty() &&
           text.find_first_of(std::string_view(" \t\r\n\0", 5)) == std::string_view::npos;
}

/// Topics lift_states, lift_requests, door_states, door_requests, fleet_states.
///
/// A lift serves the session that asked for it first until that ends its session; in AGV mode its
/// doors stay open meanwhile. The name of a level is the id of its storey, L1 in the run of a room;
/// coordinates are those of the frame map.
class RmfTopics final : public RosSource {
  public:
    std::vector<RosSourceTopic> topics(const RosRun& run) override {
        std::vector<RosSourceTopic> out;
        const auto add = [&out](std::string_view topic, RosType type, const std::string& about,
                                double rate) {
            out.push_back({std::string(topic), type, about, rate, rate == 0});
        };
        look(run);
        for (const auto& [lift, floors] : floors_)
            add(kLiftStates, RosType::LiftState, lift, kLiftRate);
        if (!floors_.empty()) add(kLiftRequests, RosType::LiftRequest, "", 0);
        for (const auto& [door, value] : doors_)
            add(kDoorStates, RosType::DoorState, door, kDoorRate);
        if (!doors_.empty()) add(kDoorRequests, RosType::DoorRequest, "", 0);
        add(kFleetStates, RosType::FleetState, "", kFleetRate);
        return out;
    }

    std::string message(const RosSourceTopic& topic, const RosRun& run) override {
        if (topic.type == RosType::LiftState) return liftState(topic.about, run);
        if (topic.type == RosType::DoorState) return doorState(topic.about, run);
        return fleetState(run);
    }

    std::string request(const RosSourceTopic& topic, std::string_view message) override {
        CdrReader in(message);
        return topic.type == RosType::LiftRequest ? liftRequest(in) : doorRequest(in);
    }

  private:
    struct Session {
        std::string name = {};  ///< "" without one
        bool is_agv = false;
    };

    /// Finds lifts and doors again in a changed world.
    void look(const RosRun& run) {
        std::int64_t changes = 0;
        for (const RosRoom& room : run.rooms) changes += room.world().changes();
        if (std::exchange(changes_, changes) == changes) return;
        doors_.clear();
        floors_.clear();
        for (const RosRoom& room : run.rooms) {
            const Scene& scene = room.world().scene();
            std::size_t i = 0;  // of the record: states are in their order
            for (const RoomState& state : roomStates(scene)) {
                while (scene.ids[i] != state.id) ++i;
                if (state.key == "open" && scene.records[i].keyword() == "door")
                    doors_[nameAcross(room.id, state.id)] = state.value;
            }
        }
        for (const LiftState& lift : run.worlds.lifts()) floors_[lift.id];
        const auto rooms = run.worlds.rooms();
        for (std::size_t i = 0; i < rooms.size(); ++i)
            for (const PassageOutline& outline : run.worlds.passageOutlines(i))
                if (const auto lift = floors_.find(outline.id); lift != floors_.end())
                    lift->second[rooms[i].id] = run.worlds.frameOf(i).pose.position.z;
    }

    std::string liftState(const std::string& id, const RosRun& run) {
        for (const LiftState& lift : run.worlds.lifts())
            if (lift.id == id) return liftState(lift, run.now());
        return "";
    }

    std::string liftState(const LiftState& lift, std::uint64_t now) {
        constexpr double kLevel = 1e-6;
        const std::map<std::string, double>& floors = floors_[lift.id];
        const std::string& goal = lift.calls.empty() ? lift.storey : lift.calls.front();
        const auto height = [&](const std::string& floor) {
            const auto found = floors.find(floor);
            return found == floors.end() ? lift.height : found->second;
        };
        const bool is_riding = lift.door == 0 && (goal != lift.storey ||
                                                  std::abs(lift.height - height(goal)) > kLevel);
        const double way = height(goal) - lift.height;
        CdrWriter out;
        putTime(out, now);
        out.put(lift.id).count(floors.size());
        for (const auto& [floor, z] : floors) out.put(floor);
        out.put(lift.storey).put(goal);
        out.put<std::uint8_t>(lift.door == 0   ? kDoorClosed
                              : lift.door == 1 ? kDoorOpen
                                               : kDoorMoving);
        out.put<std::uint8_t>(!is_riding || way == 0 ? kStopped : way > 0 ? kUp : kDown);
        out.count(2).put<std::uint8_t>(kHuman).put<std::uint8_t>(kAgv);
        const Session& session = sessions_[lift.id];
        const bool is_human = !session.name.empty() && !session.is_agv;
        return out.put<std::uint8_t>(is_human ? kHuman : kAgv).put(session.name).take();
    }

    /// A session keeps its lift until it ends; calls of others are left. Supervisors repeat their
    /// requests: the first one in human mode after AGV mode lets the doors close, the next calls.
    std::string liftRequest(CdrReader& in) {
        const std::string lift(in.text());
        skipTime(in);
        const std::string session(in.text());
        const auto type = in.number<std::uint8_t>();
        const std::string floor(in.text());
        const bool is_known = floors_.contains(lift);
        if (!is_known && type == kEndSession) return "";
        // Unknown names are refused by the request.
        const std::string place =
            (isOneWord(lift) ? lift : "?") + ' ' + (isOneWord(floor) ? floor : "?");
        if (!is_known) return "CALL " + place;
        Session& holder = sessions_[lift];
        if (!holder.name.empty() && holder.name != session) return "";
        const bool was_agv = holder.is_agv;
        holder = type == kEndSession ? Session{} : Session{session, type == kAgvMode};
        if (holder.is_agv) return "HOLD " + place;
        if (was_agv) return "HOLD " + lift;
        return type == kEndSession ? "" : "CALL " + place;
    }

    std::string doorState(const std::string& id, const RosRun& run) {
        look(run);
        const auto door = doors_.find(id);
        if (door == doors_.end()) return "";
        CdrWriter out;
        putTime(out, run.now());
        return out.put(id)
            .put<std::uint32_t>(door->second == "1"   ? kModeOpen
                                : door->second == "0" ? kModeClosed
                                                      : kModeMoving)
            .take();
    }

    static std::string doorRequest(CdrReader& in) {
        skipTime(in);
        in.text();
        const std::string door(in.text());
        const auto mode = in.number<std::uint32_t>();
        if (mode != kModeOpen && mode != kModeClosed) return "";
        const bool opens = mode == kModeOpen;
        return "ACT " + (isOneWord(door) ? door : "?") + " open=" + (opens ? "1" : "0");
    }

    /// Returns the storey of a room: of a cabin, that of the nearest floor.
    static std::string levelOf(std::size_t room, const RosRun& run) {
        constexpr std::string_view kKey = "storey=";
        if (run.rooms[room].id.empty()) return kOnlyLevel;
        const std::string where = run.worlds.whereText(room);
        const std::size_t at = where.find(kKey);
        if (at == std::string::npos) return run.rooms[room].id;
        const std::size_t begin = at + kKey.size();
        return where.substr(begin, where.find(' ', begin) - begin);
    }

    std::string fleetState(const RosRun& run) {
        CdrWriter out;
        out.put(kFleet);
        std::size_t robots = 0;
        for (const RosRoom& room : run.rooms) robots += room.world().robots().size();
        out.count(robots);
        ++messages_;
        for (std::size_t i = 0; i < run.rooms.size(); ++i) {
            const World& world = run.rooms[i].world();
            if (world.robots().empty()) continue;
            const std::string level = levelOf(i, run);
            for (std::size_t robot = 0; robot < world.robots().size(); ++robot)
                putRobot(out, run.rooms[i], robot, level, run.now());
        }
        return out.take();
    }

    void putRobot(CdrWriter& out, const RosRoom& room, std::size_t robot, const std::string& level,
                  std::uint64_t now) const {
        constexpr float kFull = 100;
        const World& world = room.world();
        const RobotStatus status = world.status(robot);
        const auto way = world.wayAhead(robot);
        const bool is_moving = !way.empty() || status.speed != 0 || status.sidespeed != 0 ||
                               status.rotspeed.radians() != 0;
        out.put(world.robots()[robot].id).put(world.robots()[robot].model.model).put("");
        out.put(messages_);
        out.put<std::uint32_t>(is_moving ? kMoving : kIdle).put(std::uint64_t{0}).put("");
        out.put(kFull);
        const Pose2 frame{room.frame.pose.position.onFloor(), room.frame.pose.heading};
        const auto put = [&](const Pose2& pose, std::uint64_t index) {
            const Point2 in_map = frame * pose.position;
            putTime(out, now);
            out.put(static_cast<float>(in_map.x))
                .put(static_cast<float>(in_map.y))
                .put(static_cast<float>(wrapped(frame.heading + pose.heading).radians()));
            out.put(false).put(0.F).put(level).put(index);
        };
        put(status.pose, 0);
        out.count(way.size());
        std::uint64_t index = 0;
        Point2 before = status.pose.position;
        for (const Point2& next : way) {
            const Vec2 leg = next - before;
            put({next, directionOf(leg.x, leg.y)}, ++index);
            before = next;
        }
    }

    std::int64_t changes_ = -1;
    std::map<std::string, std::string> doors_;                     // values by name
    std::map<std::string, std::map<std::string, double>> floors_;  // heights by storey, of lifts
    std::map<std::string, Session> sessions_;                      // of lifts
    std::uint64_t messages_ = 0;
};

}  // namespace

std::shared_ptr<RosSource> rmfTopics() { return std::make_shared<RmfTopics>(); }

}  // namespace ispace::ros
