// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/ros: a running world as topics of ROS 2, for Foxglove and rosbridge. A new topic
// of the world is a row of rosRows(); the topics of a sensor are those of its ReadingKind, as in
// MCAP files. Uses server and below.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sense/formats/reading_fields.h"
#include "sense/formats/ros_messages.h"
#include "sim/simulation.h"
#include "sim/worlds.h"

namespace ispace::ros {

/// Quality of service of a topic: messages kept for a slow reader, the oldest dropped first. All
/// are reliable. A latched one also sends its last message to new readers, as do all others here.
struct RosQuality {
    std::size_t depth = 10;
    bool is_latched = false;
};
inline constexpr RosQuality kSensorData{.depth = 5};

/// The frames of a scene, by index of World::movers() and World::sensors(). Names are unique.
struct RosFrames {
    RosFrames() = default;
    explicit RosFrames(const World& world);

    std::string room = std::string(kRosWorld);    ///< of all that stands in the scene
    std::vector<std::string> movers, odometries;  ///< of robots alone: odometries
    std::vector<std::string> sensors;             ///< of mats and gates: ""
    /// Left and right wheel of each robot: "r1_left_wheel"; of omnidirectional ones "".
    std::vector<std::array<std::string, 2>> wheels;
    /// Returns the frame of one sonar: "r1_sonar_3".
    [[nodiscard]] std::string sonar(std::size_t robot, std::size_t which) const;
};

/// A world of the run, at a moment.
struct RosRoom {
    std::string id;  ///< "": the only one
    const Simulation* simulation = nullptr;
    RoomFrame frame = {{}, true};  ///< in the frame of all worlds
    RosFrames frames = {};

    [[nodiscard]] const World& world() const { return simulation->world(); }
    /// Returns the topic of a row about rooms: "/map", "/ground/map".
    [[nodiscard]] std::string topic(std::string_view name) const;
    /// Returns the URI of its mesh in /room: "package://ispace/room.glb", ".../ground.glb".
    [[nodiscard]] std::string mesh() const;
};
/// Sets the frames of the worlds of a run: of several, each room has one of its name, and ids are
/// those across the worlds. A mover keeps its frames wherever it goes.
void nameFrames(std::span<RosRoom> rooms);

/// Returns nanoseconds as ROS counts them, at most 2^31 seconds.
std::uint64_t rosTimeOf(SimTime time);

/// The topics of a sensor, in the order of its row.
std::vector<const RosTopic*> rosTopicsOf(const Sensor& sensor);
/// Writes the message of a topic; "" if this reading has none. \param frame of the sensor
/// \param room frame of its room
std::string rosMessageOf(const RosTopic& topic, const Sensor& sensor, const SensorReading& reading,
                         std::string_view frame, std::string_view room = kRosWorld);

/// The worlds between two steps. Sonars and bumpers are computed when needed.
struct RosMoment {
    std::span<const RosRoom> rooms;     ///< of the run
    const RosRoom& room;                ///< that of the channel
    const std::optional<RosGrid>& map;  ///< of the room; empty until it is computed
    bool has_mesh = false;              ///< there is a mesh of the room
    std::function<const std::vector<float>&(std::size_t robot)> sonars;
    std::function<const std::vector<bool>&(std::size_t robot)> bumpers;
    std::function<std::string(std::size_t robot)> robot_model;  ///< in URDF, "" without
    std::string_view lone = {};  ///< id of the robot whose topics have names without a prefix, too

    [[nodiscard]] const World& world() const { return room.world(); }
    [[nodiscard]] const RosFrames& frames() const { return room.frames; }
    [[nodiscard]] std::uint64_t now() const { return rosTimeOf(world().time()); }
    [[nodiscard]] RosHeader header() const { return {now(), frames().room}; }
};

/// A pose to which a robot goes by its own navigator.
struct RosGoal {
    RosPose pose;
    bool has_heading = true;  ///< else any will do
};

/// A message to a robot: its speeds, its pose in the world, or its goal; or tracks in a room.
using RosOrder = std::variant<RosTwist, RosPose, RosGoal, std::vector<RosTrack>>;

/// One row of the table of topics.
struct RosRow {
    std::string_view name;  ///< after the subject's name
    RosType type;
    enum class Of {
        World,  ///< /NAME, of all worlds
        Room,   ///< /NAME, of several worlds /ground/NAME
        Robot,  ///< /r1/NAME
        Sonar,  ///< /r1/NAME_0, ...
        Bumper
    } subject;
    double rate;  ///< messages in a simulated second; 0: one for each change of the world
    RosQuality quality;
    /// Writes the message about a robot (and one of its sonars or bumpers); "" if there is none
    /// yet. Null: the topic takes messages.
    std::string (*encode)(const RosMoment& moment, std::size_t robot, std::size_t part) = nullptr;
    /// Reads a message. \throws FormatError
    RosOrder (*decode)(RosType type, std::string_view message) = nullptr;
};
std::span<const RosRow> rosRows();

/// A state of a thing, or the commands that set it.
struct RosState {
    std::string id, key;
    std::string name;  ///< the id across the worlds of the run
    bool is_command = false;
};
/// Writes the value of a state as a Bool, a Float64 or a String; "" if it is none.
std::string stateMessage(RosType type, const std::string& value);
/// Reads a command: a value of the record language. \throws FormatError
std::string stateValue(RosType type, std::string_view message);

class RosSource;

/// A topic of a scene.
struct RosChannel {
    std::string topic;  ///< "/r1/odom"
    RosType type = RosType::Clock;
    double rate = 0;
    RosQuality quality = kSensorData;
    std::size_t room = 0;                ///< index of the world
    std::size_t subject = 0;             ///< index of the robot or the sensor in it
    std::size_t part = 0;                ///< of the sonar or bumper
    const RosRow* row = nullptr;         ///< null: a topic of a sensor or a state
    const RosTopic* sensor = nullptr;    ///< null: a topic of a row or a state
    std::optional<RosState> state = {};  ///< of neither a row nor a sensor
    bool is_alias = false;               ///< a robot's topic without its name
    RosSource* source = nullptr;         ///< null: a topic of one of these
    std::string about = {};              ///< of a source, see RosSourceTopic
    bool is_input = false;               ///< of a source

    /// Returns the key of the messages of clients in TopicEchoes.
    [[nodiscard]] std::string echoKey() const { return topic + ' ' + std::string(nameOf(type)); }
    [[nodiscard]] bool isInput() const {
        return source != nullptr ? is_input
               : state           ? state->is_command
                                 : row != nullptr && row->decode != nullptr;
    }
};
/// Returns all topics of the worlds: of rows, of sensors, of states. Inputs that accept two types
/// are two channels. Cabins of lifts and flights of stairs have neither map nor mesh.
/// \param known robot whose topics, and those of the first sensors on it, also have names without a
/// prefix, while it is there; "": the only one
std::vector<RosChannel> rosChannels(std::span<const RosRoom> rooms, const std::string& known = {});
/// Returns the id of that robot, "" for none.
std::string loneRobot(std::span<const RosRoom> rooms, const std::string& lone);

}  // namespace ispace::ros
