// SPDX-License-Identifier: GPL-3.0-or-later
// The table of topics, and the frames of a run (REP 103: x forward, y left, z up; REP 105: map,
// odom, base_link). /tf has the transforms that change, /tf_static the others. A robot alone also
// has the names that programs for one robot expect.
#include "extensions/ros/ros_topics.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/number.h"
#include "scene/bodies.h"
#include "scene/placement_schemas.h"
#include "scene/robot.h"
#include "scene/room_state.h"
#include "sense/formats/cdr.h"
#include "server/server_state.h"
#include "sim/sensor_reading.h"

namespace ispace::ros {

namespace {

constexpr const char* kOptical = "_optical";
/// Sonars are at this share of the body's height, see sonarRanges().
constexpr double kSonarHeight = 0.75;
/// Of a full battery, as robots tell ARIA.
constexpr float kBatteryVolts = 12.5F;

/// Adds a number to a name that is taken.
std::string uniqueName(std::set<std::string>& taken, const std::string& name) {
    std::string unique = name;
    for (int i = 2; !taken.insert(unique).second; ++i) unique = name + "_" + std::to_string(i);
    return unique;
}

std::array<std::string, 2> wheelNames(std::set<std::string>& taken, const std::string& robot,
                                      const RobotModel& model) {
    if (model.drive != Drive::Differential) return {};
    return {uniqueName(taken, robot + "_left_wheel"), uniqueName(taken, robot + "_right_wheel")};
}

bool hasOptical(const Sensor& sensor) {
    const auto topics = rosTopicsOf(sensor);
    return std::any_of(topics.begin(), topics.end(),
                       [](const RosTopic* one) { return one->frame == RosFrame::Optical; });
}

}  // namespace

RosFrames::RosFrames(const World& world) {
    std::set<std::string> taken{std::string(kRosWorld)};
    const std::size_t robots = world.robots().size();
    for (const Mover& mover : world.movers())
        movers.push_back(uniqueName(taken, rosName(mover.id)));
    for (std::size_t i = 0; i < robots; ++i)
        odometries.push_back(uniqueName(taken, movers[i] + "_odom"));
    for (const Sensor& sensor : world.sensors()) {
        const bool is_shown = !rosTopicsOf(sensor).empty();
        sensors.push_back(is_shown ? uniqueName(taken, rosName(sensor.id)) : "");
    }
    for (std::size_t i = 0; i < robots; ++i)
        wheels.push_back(wheelNames(taken, movers[i], world.robots()[i].model));
}

std::string RosRoom::topic(std::string_view name) const {
    return (id.empty() ? "/" : '/' + frames.room + '/') + std::string(name);
}

std::string RosRoom::mesh() const {
    return "package://ispace/" + (id.empty() ? std::string("room") : frames.room) + ".glb";
}

void nameFrames(std::span<RosRoom> rooms) {
    if (rooms.size() == 1 && rooms.front().id.empty()) {
        rooms.front().frames = RosFrames(rooms.front().world());
        return;
    }
    std::set<std::string> taken{std::string(kRosWorld)};
    // By id, in whichever room a thing is now. Odometry frames are named after all movers.
    std::map<std::string, std::string> movers, odometries, sensors;
    std::map<std::string, std::array<std::string, 2>> wheels;
    for (RosRoom& room : rooms) {
        room.frames = {};
        room.frames.room = uniqueName(taken, rosName(room.id));
        for (const Mover& mover : room.world().movers()) movers[mover.id];
        for (const PlacedRobot& robot : room.world().robots()) odometries[robot.id];
        for (const Sensor& sensor : room.world().sensors())
            if (!rosTopicsOf(sensor).empty()) sensors[nameAcross(room.id, sensor.id)];
    }
    for (auto& [id, name] : movers) name = uniqueName(taken, rosName(id));
    for (auto& [id, name] : odometries) name = uniqueName(taken, movers[id] + "_odom");
    for (auto& [id, name] : sensors) name = uniqueName(taken, rosName(id));
    std::map<std::string, const RobotModel*> models;
    for (const RosRoom& room : rooms)
        for (const PlacedRobot& robot : room.world().robots()) models[robot.id] = &robot.model;
    for (const auto& [id, model] : models) wheels[id] = wheelNames(taken, movers[id], *model);
    for (RosRoom& room : rooms) {
        for (const Mover& mover : room.world().movers())
            room.frames.movers.push_back(movers[mover.id]);
        for (const PlacedRobot& robot : room.world().robots()) {
            room.frames.odometries.push_back(odometries[robot.id]);
            room.frames.wheels.push_back(wheels[robot.id]);
        }
        for (const Sensor& sensor : room.world().sensors()) {
            const auto named = sensors.find(nameAcross(room.id, sensor.id));
            room.frames.sensors.push_back(named == sensors.end() ? "" : named->second);
        }
    }
}

std::string RosFrames::sonar(std::size_t robot, std::size_t which) const {
    return movers[robot] + "_sonar_" + std::to_string(which);
}

std::uint64_t rosTimeOf(SimTime time) {
    constexpr SimTime kMaxRosTime = std::chrono::seconds(2147483647);
    return static_cast<std::uint64_t>(std::clamp(time, SimTime(0), kMaxRosTime).count());
}

std::vector<const RosTopic*> rosTopicsOf(const Sensor& sensor) {
    std::vector<const RosTopic*> topics;
    for (const RosTopic& topic : readingKind(sensor.model).topics) {
        const bool is_sent = topic.is_sent == nullptr || topic.is_sent(sensor);
        // A running world has single scans instead of sweeps.
        if (is_sent && topic.message != nullptr) topics.push_back(&topic);
    }
    return topics;
}

std::string rosMessageOf(const RosTopic& topic, const Sensor& sensor, const SensorReading& reading,
                         std::string_view frame, std::string_view room) {
    const ReadingKind& kind = readingKind(sensor.model);
    SimTime time = reading.time;
    if (kind.delay != nullptr)
        time += SimTime(std::llround(kind.delay(sensor, 0) * 1e9));  // of the first beam
    const std::string optical = std::string(frame) + kOptical;
    if (topic.frame == RosFrame::World) frame = room;
    if (topic.frame == RosFrame::Optical) frame = optical;
    return topic.message({rosTimeOf(time), frame}, viewOf(sensor, reading));
}

namespace {

std::string clockOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    return clockMessage(moment.now());
}

constexpr std::array<double, 2> kSides{1, -1};  // left, right

/// Adds the wheels of a robot, as far as they have rolled.
void addWheels(const RosRoom& room, std::size_t robot, std::uint64_t now,
               std::vector<RosTransform>& out) {
    const World& world = room.world();
    const Wheels wheels = wheelsOf(world.robots()[robot].model);
    for (std::size_t i = 0; i < kSides.size(); ++i) {
        const std::string& frame = room.frames.wheels[robot][i];
        if (frame.empty()) continue;
        const Angle rolled = world.wheelTravel(robot).of(wheels, kSides[i]);
        // A positive tilt looks up: the wheel rolls down ahead.
        out.push_back({{now, room.frames.movers[robot]},
                       frame,
                       {{0, kSides[i] * wheels.track / 2, wheels.radius}, {}, -rolled, {}}});
    }
}

/// Adds movers, odometry frames, wheels, and swept lasers, which move on their mounts.
void addMoving(const RosRoom& room, std::uint64_t now, std::vector<RosTransform>& out) {
    const World& world = room.world();
    const RosFrames& frames = room.frames;
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        const Pose2 pose = world.status(i).pose;
        if (i >= world.robots().size())
            addMoverFrame(out, now, frames.movers[i], pose);
        else
            addRobotFrames(out, now, frames.odometries[i], frames.movers[i], pose,
                           world.odometry(i).pose);
        if (i < world.robots().size()) addWheels(room, i, now, out);
    }
    for (RosTransform& one : out)
        if (one.header.frame == kRosWorld) one.header.frame = frames.room;
    for (std::size_t i = 0; i < world.sensors().size(); ++i)
        if (isSwept(world.sensors()[i]))
            out.push_back({{now, frames.room}, frames.sensors[i], world.reading(i).pose});
}

/// Adds the frames of rooms among several: storeys, or all that may move.
void addRooms(const RosMoment& moment, bool are_storeys, std::vector<RosTransform>& out) {
    for (const RosRoom& room : moment.rooms)
        if (!room.id.empty() && room.frame.is_storey == are_storeys)
            out.push_back({{moment.now(), kRosWorld}, room.frames.room, room.frame.pose});
}

std::string movingFrames(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    std::vector<RosTransform> out;
    for (const RosRoom& room : moment.rooms) addMoving(room, moment.now(), out);
    addRooms(moment, false, out);
    return transformsMessage(out);
}

/// Adds sensors on their carriers or in the room, optical frames, and sonars. \param names of
/// which the transforms have views
void addFixed(const RosRoom& room, std::uint64_t now, std::deque<std::string>& names,
              std::vector<RosTransform>& out) {
    const World& world = room.world();
    const RosFrames& frames = room.frames;
    const auto on = [&](std::size_t mover) { return RosHeader{now, frames.movers[mover]}; };
    for (std::size_t i = 0; i < world.sensors().size(); ++i) {
        const Sensor& sensor = world.sensors()[i];
        if (frames.sensors[i].empty()) continue;
        if (sensor.mount && !isSwept(sensor)) {
            out.push_back(
                {on(sensor.mount->robot), frames.sensors[i], sensor.mount->robot_from_sensor});
        } else if (sensor.person && !isSwept(sensor)) {
            const std::size_t mover = world.robots().size() + *sensor.person;
            out.push_back({on(mover), frames.sensors[i],
                           poseOn(world.people()[*sensor.person].pose, sensor.pose)});
        } else if (!isSwept(sensor)) {
            out.push_back({{now, frames.room}, frames.sensors[i], sensor.pose});
        }
        if (!hasOptical(sensor)) continue;
        names.push_back(frames.sensors[i] + kOptical);
        out.push_back({{now, frames.sensors[i]}, names.back(), Pose3(), true});
    }
    for (std::size_t robot = 0; robot < world.robots().size(); ++robot) {
        const RobotModel& model = world.robots()[robot].model;
        for (std::size_t i = 0; i < model.sonar.places.size(); ++i) {
            const Pose2& place = model.sonar.places[i];
            names.push_back(frames.sonar(robot, i));
            out.push_back({on(robot),
                           names.back(),
                           {{place.position.x, place.position.y, kSonarHeight * model.height},
                            place.heading,
                            {},
                            {}}});
        }
    }
}

/// Adds the frames that programs of one robot expect, but for those that something else has.
void addLoneFrames(const RosMoment& moment, std::vector<RosTransform>& out) {
    const auto add = [&](std::string_view parent, std::string_view child) {
        const auto has_it = [&](const RosRoom& room) {
            const auto& [of_room, movers, odometries, sensors, wheels] = room.frames;
            return of_room == child || std::ranges::find(movers, child) != movers.end() ||
                   std::ranges::find(sensors, child) != sensors.end();
        };
        if (std::ranges::any_of(moment.rooms, has_it)) return;
        out.push_back({{moment.now(), parent}, child, {}});
    };
    for (const RosRoom& room : moment.rooms) {
        const auto robot = room.world().robotNamed(moment.lone);
        if (!robot) continue;
        add(room.frames.odometries[*robot], "odom");
        add(room.frames.movers[*robot], "base_footprint");
        add(room.frames.movers[*robot], "base_link");
    }
}

std::string fixedFrames(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    std::deque<std::string> names;
    std::vector<RosTransform> out;
    for (const RosRoom& room : moment.rooms) addFixed(room, moment.now(), names, out);
    addLoneFrames(moment, out);
    addRooms(moment, true, out);
    return transformsMessage(out);
}

std::string mapOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    return moment.map ? mapMessage(moment.header(), *moment.map) : "";
}

std::string roomOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    return moment.has_mesh ? roomMessage(moment.header(), moment.room.mesh()) : "";
}

/// Returns the box that holds a body, without a thing that it carries.
RosPerson::Box boxOf(const PersonFigure& figure) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Point3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
    for (std::size_t i = 0; i + figure.load_parts < figure.fixed.size(); ++i) {
        const BodyPart& part = figure.fixed[i];
        const double x = std::max(part.radius, part.half_length);
        const double y = std::max(part.radius, part.half_width);
        low = {std::min(low.x, part.center.x - x), std::min(low.y, part.center.y - y),
               std::min(low.z, part.bottom)};
        high = {std::max(high.x, part.center.x + x), std::max(high.y, part.center.y + y),
                std::max(high.z, part.top)};
    }
    const Vec3 size = high - low;
    return {low + 0.5 * size, size};
}

std::string peopleOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    const World& world = moment.world();
    std::vector<RosPerson> people;
    for (std::size_t i = world.robots().size(); i < world.movers().size(); ++i) {
        const Mover& mover = world.movers()[i];
        people.push_back({mover.id, world.status(i).pose, mover.model.radius, mover.model.height});
        const auto& figure = world.people()[i - world.robots().size()].figure;
        if (figure != nullptr && !figure->rest.empty()) people.back().box = boxOf(*figure);
    }
    return peopleMessage(moment.header(), people);
}

std::string robotsOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    const World& world = moment.world();
    std::vector<RosPerson> robots;
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const Mover& mover = world.movers()[i];
        robots.push_back({mover.id, world.status(i).pose, mover.model.radius, mover.model.height});
    }
    return robotsMessage(moment.header(), robots);
}

std::string diagnosticsOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    const Simulation& simulation = *moment.room.simulation;
    const bool is_late = simulation.lost() > SimTime(0);
    std::vector<RosDiagnostic> all{
        {.name = "simrun: clock",
         .message = is_late               ? "the world could not keep up with the clock"
                    : simulation.paused() ? "paused"
                                          : "running",
         .is_warning = is_late,
         .values = {{"steps", std::to_string(moment.world().steps())},
                    {"lost seconds", formatMilliseconds(simulation.lost())},
                    {"late steps", std::to_string(simulation.lateness().late)}}}};
    for (const RosRoom& room : moment.rooms)
        for (std::size_t i = 0; i < room.world().robots().size(); ++i) {
            const bool is_stalled = room.world().isStalled(i);
            all.push_back({.name = "simrun: robot " + room.world().robots()[i].id,
                           .message = is_stalled ? "ran into a body" : "free",
                           .is_warning = is_stalled});
        }
    return diagnosticsMessage({moment.now(), ""}, all);
}

std::string odometryOf(const RosMoment& moment, std::size_t robot, std::size_t /*part*/) {
    const Odometry odometry = moment.world().odometry(robot);
    return odometryMessage({moment.now(), moment.frames().odometries[robot]},
                           moment.frames().movers[robot], {odometry.pose, odometry.covariance},
                           {odometry.speed, odometry.sidespeed, odometry.rotspeed}, odometry.alphas,
                           std::max(kOdometryPeriod, seconds(moment.world().stepLength())));
}

std::string sonarOf(const RosMoment& moment, std::size_t robot, std::size_t part) {
    return rangeMessage({moment.now(), moment.frames().sonar(robot, part)},
                        moment.world().robots()[robot].model.sonar, moment.sonars(robot)[part]);
}

std::string bumperOf(const RosMoment& moment, std::size_t robot, std::size_t part) {
    return boolMessage(moment.bumpers(robot)[part]);
}

std::string batteryOf(const RosMoment& moment, std::size_t robot, std::size_t /*part*/) {
    return batteryMessage({moment.now(), moment.frames().movers[robot]}, kBatteryVolts);
}

/// Writes the angles of a robot's wheels and of the things on it that turn, such as heads.
std::string jointsOf(const RosMoment& moment, std::size_t robot, std::size_t /*part*/) {
    const World& world = moment.world();
    const Scene& scene = world.scene();
    const std::string& id = world.robots()[robot].id;
    std::vector<RosJoint> joints;
    const Wheels wheels = wheelsOf(world.robots()[robot].model);
    const RobotStatus status = world.status(robot);
    for (std::size_t i = 0; i < kSides.size(); ++i) {
        const std::string& frame = moment.frames().wheels[robot][i];
        if (frame.empty()) continue;
        const WheelTravel rate{status.speed, status.rotspeed};
        joints.push_back({frame + "_joint", world.wheelTravel(robot).of(wheels, kSides[i]),
                          rate.of(wheels, kSides[i])});
    }
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        if (carrierOf(record) != id) continue;
        for (const std::string& key : stateKeysOf(record.keyword())) {
            const KeySpec* const spec = record.schema().find(key);
            if (spec == nullptr || spec->unit != Unit::Angle || spec->type != KeyType::Number)
                continue;
            joints.push_back(
                {rosName(nameAcross(moment.room.id, scene.ids[i])) + '_' + key, record.angle(key)});
        }
    }
    return jointsMessage({moment.now(), moment.frames().movers[robot]}, joints);
}

std::string modelOf(const RosMoment& moment, std::size_t robot, std::size_t /*part*/) {
    const std::string model = moment.robot_model(robot);
    return model.empty() ? "" : textMessage(model);
}

RosOrder speedsOf(RosType type, std::string_view message) { return twistOf(type, message); }
RosOrder placeOf(RosType /*type*/, std::string_view message) { return poseOf(message); }
RosOrder goalOf(RosType /*type*/, std::string_view message) { return RosGoal{poseOf(message)}; }
RosOrder clickedOf(RosType /*type*/, std::string_view message) {
    return RosGoal{.pose = pointOf(message), .has_heading = false};
}
RosOrder toldOf(RosType /*type*/, std::string_view message) { return tracksOf(message); }

using Of = RosRow::Of;
constexpr RosQuality kLatched{.depth = 1, .is_latched = true}, kNewest{.depth = 1},
    kTransforms{.depth = 100}, kDefault{};

// NOLINTBEGIN(readability-magic-numbers): the table is where they are named
constexpr RosRow kRows[] = {
    {"clock", RosType::Clock, Of::World, 50, kNewest, clockOf},
    {"tf", RosType::TFMessage, Of::World, 50, kTransforms, movingFrames},
    {"tf_static", RosType::TFMessage, Of::World, 0, kLatched, fixedFrames},
    {"map", RosType::OccupancyGrid, Of::Room, 0, kLatched, mapOf},
    {"room", RosType::MarkerArray, Of::Room, 0, kLatched, roomOf},
    {"people", RosType::MarkerArray, Of::Room, 10, kDefault, peopleOf},
    {"tracks", RosType::MarkerArray, Of::Room, 0, kDefault, nullptr, toldOf},
    {"diagnostics", RosType::DiagnosticArray, Of::World, 1, kDefault, diagnosticsOf},
    {"odom", RosType::Odometry, Of::Robot, 50, kDefault, odometryOf},
    {"sonar", RosType::Range, Of::Sonar, 10, kSensorData, sonarOf},
    {"bumper", RosType::Bool, Of::Bumper, 10, kSensorData, bumperOf},
    {"cmd_vel", RosType::Twist, Of::Robot, 0, kNewest, nullptr, speedsOf},
    {"cmd_vel", RosType::TwistStamped, Of::Robot, 0, kNewest, nullptr, speedsOf},
    {"initialpose", RosType::PoseWithCovarianceStamped, Of::Robot, 0, kNewest, nullptr, placeOf},
    {"goal_pose", RosType::PoseStamped, Of::Robot, 0, kNewest, nullptr, goalOf},
    {"move_base_simple/goal", RosType::PoseStamped, Of::Robot, 0, kNewest, nullptr, goalOf},
    {"robots", RosType::MarkerArray, Of::Room, 10, kDefault, robotsOf},
    {"battery_state", RosType::BatteryState, Of::Robot, 1, kDefault, batteryOf},
    {"joint_states", RosType::JointState, Of::Robot, 20, kDefault, jointsOf},
    {"robot_description", RosType::String, Of::Robot, 0, kLatched, modelOf},
    {"clicked_point", RosType::PointStamped, Of::Robot, 0, kNewest, nullptr, clickedOf}};
// NOLINTEND(readability-magic-numbers)

/// Adds the channels of a row about one robot.
void addOf(const RosRow& row, const RosRoom& room, std::size_t index, std::size_t robot,
           std::vector<RosChannel>& out) {
    RosChannel channel{.topic = "/" + room.frames.movers[robot] + "/" + std::string(row.name),
                       .type = row.type,
                       .rate = row.rate,
                       .quality = row.quality,
                       .room = index,
                       .subject = robot,
                       .row = &row};
    if (row.subject == Of::Robot) return out.push_back(std::move(channel));
    const RobotModel& model = room.world().robots()[robot].model;
    const std::size_t parts =
        row.subject == Of::Sonar ? model.sonar.places.size() : model.bumpers.size();
    const std::string topic = channel.topic;
    for (channel.part = 0; channel.part < parts; ++channel.part) {
        channel.topic = topic + "_" + std::to_string(channel.part);
        out.push_back(channel);
    }
}

/// Adds the channels of a row, of all rooms.
void addOf(const RosRow& row, std::span<const RosRoom> rooms, const std::string& lone,
           std::vector<RosChannel>& out) {
    if (row.subject == Of::World)
        out.push_back({.topic = "/" + std::string(row.name),
                       .type = row.type,
                       .rate = row.rate,
                       .quality = row.quality,
                       .row = &row});
    for (std::size_t k = 0; k < rooms.size(); ++k) {
        const RosRoom& room = rooms[k];
        // A latched row is about the room itself.
        if (row.subject == Of::Room && (room.frame.is_storey || !row.quality.is_latched))
            out.push_back({.topic = room.topic(row.name),
                           .type = row.type,
                           .rate = row.rate,
                           .quality = row.quality,
                           .room = k,
                           .row = &row});
        if (row.subject == Of::World || row.subject == Of::Room) continue;
        for (std::size_t i = 0; i < room.world().robots().size(); ++i) addOf(row, room, k, i, out);
    }
    // Programs for one robot know no name of it.
    if (row.subject != Of::Robot || lone.empty()) return;
    for (std::size_t k = 0; k < rooms.size(); ++k)
        for (std::size_t i = 0; i < rooms[k].world().robots().size(); ++i)
            if (rooms[k].world().robots()[i].id == lone)
                out.push_back({.topic = "/" + std::string(row.name),
                               .type = row.type,
                               .rate = row.rate,
                               .quality = row.decode != nullptr ? kSensorData : row.quality,
                               .room = k,
                               .subject = i,
                               .row = &row,
                               .is_alias = true});
}

/// Adds the topics of the sensors on a robot without their names, of several the first.
void addLone(std::span<const RosRoom> rooms, const std::string& lone,
             std::vector<RosChannel>& out) {
    std::vector<RosChannel> aliases;
    std::set<std::string> seen;
    for (const RosChannel& channel : out) {
        if (channel.sensor == nullptr) continue;
        const World& world = rooms[channel.room].world();
        const Sensor& sensor = world.sensors()[channel.subject];
        if (!sensor.mount || world.robots()[sensor.mount->robot].id != lone) continue;
        if (!seen.insert("/" + std::string(channel.sensor->name)).second) continue;
        aliases.push_back(channel);
        aliases.back().topic = "/" + std::string(channel.sensor->name);
        aliases.back().is_alias = true;
    }
    out.insert(out.end(), aliases.begin(), aliases.end());
}

}  // namespace

std::span<const RosRow> rosRows() { return kRows; }

std::string stateMessage(RosType type, const std::string& value) {
    if (type == RosType::Bool) return boolMessage(value == "1");
    if (type == RosType::String) return textMessage(value);
    const auto number = parseDouble(value);
    return number ? numberMessage(*number) : "";
}

std::string stateValue(RosType type, std::string_view message) {
    CdrReader in(message);
    if (type == RosType::Bool) return in.number<std::uint8_t>() != 0 ? "1" : "0";
    if (type == RosType::Float64) return formatDouble(in.number<double>());
    return std::string(in.text());
}

namespace {

RosType typeOf(const KeySpec* spec) {
    if (spec == nullptr || spec->type == KeyType::Number) return RosType::Float64;
    return spec->type == KeyType::Flag ? RosType::Bool : RosType::String;
}

/// Adds the states of a room and their commands. \param taken names of topics
void addStates(const RosRoom& room, std::size_t index, std::set<std::string>& taken,
               std::vector<RosChannel>& out) {
    const Scene& scene = room.world().scene();
    std::size_t i = 0;  // of the record: states are in their order
    for (RoomState& state : roomStates(scene)) {
        while (scene.ids[i] != state.id) ++i;
        const std::vector<std::string> keys = stateKeysOf(scene.records[i].keyword());
        const bool is_set = std::find(keys.begin(), keys.end(), state.key) != keys.end();
        const KeySpec* const spec = is_set ? scene.records[i].schema().find(state.key) : nullptr;
        const std::string name = nameAcross(room.id, state.id);
        RosChannel channel{.topic = uniqueName(taken, "/" + rosName(name) + "/" + state.key),
                           .type = typeOf(spec),
                           .quality = kLatched,
                           .room = index,
                           .state = RosState{std::move(state.id), std::move(state.key), name}};
        out.push_back(channel);
        if (!is_set) continue;
        channel.topic = uniqueName(taken, channel.topic + "/set");
        channel.quality = kNewest;
        channel.state->is_command = true;
        out.push_back(std::move(channel));
    }
}

}  // namespace

std::string loneRobot(std::span<const RosRoom> rooms, const std::string& lone) {
    std::size_t count = 0;
    std::string only;
    for (const RosRoom& room : rooms)
        for (const PlacedRobot& robot : room.world().robots()) {
            if (robot.id == lone) return lone;
            only = robot.id;
            ++count;
        }
    return count == 1 ? only : "";
}

std::vector<RosChannel> rosChannels(std::span<const RosRoom> rooms, const std::string& known) {
    const std::string lone = known.empty() ? loneRobot(rooms, known) : known;
    std::vector<RosChannel> out;
    for (const RosRow& row : kRows) addOf(row, rooms, lone, out);
    for (std::size_t k = 0; k < rooms.size(); ++k) {
        const World& world = rooms[k].world();
        for (std::size_t i = 0; i < world.sensors().size(); ++i) {
            const Sensor& sensor = world.sensors()[i];
            for (const RosTopic* topic : rosTopicsOf(sensor))
                out.push_back(
                    {.topic = "/" + rooms[k].frames.sensors[i] + "/" + std::string(topic->name),
                     .type = topic->type,
                     .rate = periodRate(sensor),
                     .room = k,
                     .subject = i,
                     .sensor = topic});
        }
    }
    if (!lone.empty()) addLone(rooms, lone, out);
    std::set<std::string> taken;
    for (const RosChannel& channel : out) taken.insert(channel.topic);
    for (std::size_t k = 0; k < rooms.size(); ++k) addStates(rooms[k], k, taken, out);
    return out;
}

}  // namespace ispace::ros
