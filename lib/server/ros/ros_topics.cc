// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/ros/ros_topics.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <set>
#include <utility>

#include "scene/robot.h"
#include "sim/sensor_reading.h"

namespace ispace {

namespace {

constexpr const char* kOptical = "_optical";
/// Sonars are at this share of the body's height, see sonarRanges().
constexpr double kSonarHeight = 0.75;

/// Adds a number to a name that is taken.
std::string uniqueName(std::set<std::string>& taken, const std::string& name) {
    std::string unique = name;
    for (int i = 2; !taken.insert(unique).second; ++i) unique = name + "_" + std::to_string(i);
    return unique;
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
}

std::string RosFrames::sonar(std::size_t robot, std::size_t which) const {
    return movers[robot] + "_sonar_" + std::to_string(which);
}

std::uint64_t rosTimeOf(SimTime time) {
    constexpr SimTime kMost = std::chrono::seconds(2147483647);
    return static_cast<std::uint64_t>(std::clamp(time, SimTime(0), kMost).count());
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
                         std::string_view frame) {
    const ReadingKind& kind = readingKind(sensor.model);
    SimTime time = reading.time;
    if (kind.delay != nullptr)
        time += SimTime(std::llround(kind.delay(sensor, 0) * 1e9));  // of the first beam
    const std::string optical = std::string(frame) + kOptical;
    if (topic.frame == RosFrame::World) frame = kRosWorld;
    if (topic.frame == RosFrame::Optical) frame = optical;
    return topic.message({rosTimeOf(time), frame}, viewOf(sensor, reading));
}

namespace {

std::string clockOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    return clockMessage(rosTimeOf(moment.world().time()));
}

/// Movers, odometry frames, and swept lasers, which move on their mounts.
std::string movingFrames(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    const World& world = moment.world();
    const RosFrames& frames = moment.frames;
    const RosHeader now = moment.header();
    std::vector<RosTransform> out;
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        const Pose2 pose = world.status(i).pose;
        if (i >= world.robots().size()) {
            addMoverFrame(out, now.nanoseconds, frames.movers[i], pose);
            continue;
        }
        addRobotFrames(out, now.nanoseconds, frames.odometries[i], frames.movers[i], pose,
                       world.odometry(i).pose);
    }
    for (std::size_t i = 0; i < world.sensors().size(); ++i)
        if (isSwept(world.sensors()[i]))
            out.push_back({now, frames.sensors[i], world.reading(i).pose});
    return transformsMessage(out);
}

/// Sensors on their carriers or in the room, optical frames, and sonars.
std::string fixedFrames(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    const World& world = moment.world();
    const RosFrames& frames = moment.frames;
    const RosHeader in_world = moment.header();
    const auto on = [&](std::size_t mover) {
        return RosHeader{in_world.nanoseconds, frames.movers[mover]};
    };
    std::deque<std::string> names;  // of which the transforms have views
    std::vector<RosTransform> out;
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
            out.push_back({in_world, frames.sensors[i], sensor.pose});
        }
        if (!hasOptical(sensor)) continue;
        names.push_back(frames.sensors[i] + kOptical);
        out.push_back({{in_world.nanoseconds, frames.sensors[i]}, names.back(), Pose3(), true});
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
    return transformsMessage(out);
}

std::string mapOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    return moment.map ? mapMessage(moment.header(), *moment.map) : "";
}

std::string roomOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    return moment.has_room ? roomMessage(moment.header(), kRosRoom) : "";
}

std::string peopleOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    const World& world = moment.world();
    std::vector<RosPerson> people;
    for (std::size_t i = world.robots().size(); i < world.movers().size(); ++i) {
        const Mover& mover = world.movers()[i];
        people.push_back({mover.id, world.status(i).pose, mover.model.radius, mover.model.height});
    }
    return peopleMessage(moment.header(), people);
}

std::string diagnosticsOf(const RosMoment& moment, std::size_t /*robot*/, std::size_t /*part*/) {
    const Simulation& simulation = moment.simulation;
    const World& world = moment.world();
    const bool is_late = simulation.lost() > SimTime(0);
    std::vector<RosDiagnostic> all{
        {.name = "simrun: clock",
         .message = is_late               ? "the world could not keep up with the clock"
                    : simulation.paused() ? "paused"
                                          : "running",
         .is_warning = is_late,
         .values = {{"steps", std::to_string(world.steps())},
                    {"lost seconds", formatMilliseconds(simulation.lost())},
                    {"late steps", std::to_string(simulation.lateness().late)}}}};
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const bool is_stalled = world.isStalled(i);
        all.push_back({.name = "simrun: robot " + world.robots()[i].id,
                       .message = is_stalled ? "ran into a body" : "free",
                       .is_warning = is_stalled});
    }
    return diagnosticsMessage({moment.header().nanoseconds, ""}, all);
}

std::string odometryOf(const RosMoment& moment, std::size_t robot, std::size_t /*part*/) {
    const Odometry odometry = moment.world().odometry(robot);
    return odometryMessage({moment.header().nanoseconds, moment.frames.odometries[robot]},
                           moment.frames.movers[robot], odometry.pose,
                           {odometry.speed, odometry.sidespeed, odometry.rotspeed});
}

std::string sonarOf(const RosMoment& moment, std::size_t robot, std::size_t part) {
    return rangeMessage({moment.header().nanoseconds, moment.frames.sonar(robot, part)},
                        moment.world().robots()[robot].model.sonar, moment.sonars(robot)[part]);
}

std::string bumperOf(const RosMoment& moment, std::size_t robot, std::size_t part) {
    return boolMessage(moment.bumpers(robot)[part]);
}

RosOrder speedsOf(RosType type, std::string_view message) { return twistOf(type, message); }
RosOrder placeOf(RosType /*type*/, std::string_view message) { return poseOf(message); }

using Of = RosRow::Of;
constexpr RosQuality kLatched{.depth = 1, .is_latched = true}, kNewest{.depth = 1},
    kTransforms{.depth = 100}, kDefault{};

// NOLINTBEGIN(readability-magic-numbers): the table is where they are named
constexpr RosRow kRows[] = {
    {"clock", RosType::Clock, Of::World, 50, kNewest, clockOf},
    {"tf", RosType::TFMessage, Of::World, 50, kTransforms, movingFrames},
    {"tf_static", RosType::TFMessage, Of::World, 0, kLatched, fixedFrames},
    {"map", RosType::OccupancyGrid, Of::World, 0, kLatched, mapOf},
    {"room", RosType::MarkerArray, Of::World, 0, kLatched, roomOf},
    {"people", RosType::MarkerArray, Of::World, 10, kDefault, peopleOf},
    {"diagnostics", RosType::DiagnosticArray, Of::World, 1, kDefault, diagnosticsOf},
    {"odom", RosType::Odometry, Of::Robot, 50, kDefault, odometryOf},
    {"sonar", RosType::Range, Of::Sonar, 10, kSensorData, sonarOf},
    {"bumper", RosType::Bool, Of::Bumper, 10, kSensorData, bumperOf},
    {"cmd_vel", RosType::Twist, Of::Robot, 0, kNewest, nullptr, speedsOf},
    {"cmd_vel", RosType::TwistStamped, Of::Robot, 0, kNewest, nullptr, speedsOf},
    {"initialpose", RosType::PoseWithCovarianceStamped, Of::Robot, 0, kNewest, nullptr, placeOf}};
// NOLINTEND(readability-magic-numbers)

/// Adds the channels of a row about one robot.
void addOf(const RosRow& row, const std::string& name, const RobotModel& model, std::size_t robot,
           std::vector<RosChannel>& out) {
    RosChannel channel{.topic = "/" + name + "/" + std::string(row.name),
                       .type = row.type,
                       .rate = row.rate,
                       .quality = row.quality,
                       .subject = robot,
                       .row = &row};
    if (row.subject == Of::Robot) return out.push_back(std::move(channel));
    const std::size_t parts =
        row.subject == Of::Sonar ? model.sonar.places.size() : model.bumpers.size();
    const std::string topic = channel.topic;
    for (channel.part = 0; channel.part < parts; ++channel.part) {
        channel.topic = topic + "_" + std::to_string(channel.part);
        out.push_back(channel);
    }
}

}  // namespace

std::span<const RosRow> rosRows() { return kRows; }

std::vector<RosChannel> rosChannels(const World& world, const RosFrames& frames) {
    std::vector<RosChannel> out;
    for (const RosRow& row : kRows) {
        const std::size_t robots = row.subject == Of::World ? 0 : world.robots().size();
        if (row.subject == Of::World)
            out.push_back({.topic = "/" + std::string(row.name),
                           .type = row.type,
                           .rate = row.rate,
                           .quality = row.quality,
                           .row = &row});
        for (std::size_t i = 0; i < robots; ++i)
            addOf(row, frames.movers[i], world.robots()[i].model, i, out);
        // Programs for one robot know no name of it.
        if (row.decode != nullptr && robots == 1)
            out.push_back({.topic = "/" + std::string(row.name), .type = row.type, .row = &row});
    }
    for (std::size_t i = 0; i < world.sensors().size(); ++i) {
        const Sensor& sensor = world.sensors()[i];
        for (const RosTopic* topic : rosTopicsOf(sensor))
            out.push_back({.topic = "/" + frames.sensors[i] + "/" + std::string(topic->name),
                           .type = topic->type,
                           .rate = periodRate(sensor),
                           .subject = i,
                           .sensor = topic});
    }
    return out;
}

}  // namespace ispace
