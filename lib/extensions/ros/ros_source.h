// SPDX-License-Identifier: GPL-3.0-or-later
// Topics that other parts of a run add.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/ros/ros_topics.h"
#include "sense/formats/ros_types.h"
#include "sim/worlds.h"

namespace ispace::ros {

/// The worlds of a run between two steps.
struct RosRun {
    std::span<const RosRoom> rooms;
    const Worlds& worlds;

    [[nodiscard]] std::uint64_t now() const { return rosTimeOf(rooms.front().world().time()); }
};

/// A topic of a source.
struct RosSourceTopic {
    std::string topic;  ///< "/lift_states"
    RosType type = RosType::String;
    std::string about;  ///< id of a thing; each of several that share a topic has its messages
    double rate = 0;    ///< messages in a simulated second; 0: one for each change
    bool is_input = false;
};

/// Further topics of a run, beside those of rows, sensors and states: of lifts, or of the protocol
/// of a fleet. A source belongs to one feed, and to all its clients.
class RosSource {
  public:
    RosSource() = default;
    virtual ~RosSource() = default;
    RosSource(const RosSource&) = delete;
    RosSource& operator=(const RosSource&) = delete;

    /// Returns its topics in the worlds as they are now.
    [[nodiscard]] virtual std::vector<RosSourceTopic> topics(const RosRun& run) = 0;
    /// Writes the message of a topic; "" if there is none. Called once for each period.
    virtual std::string message(const RosSourceTopic& topic, const RosRun& run) = 0;
    /// Reads a message to a topic. \returns the request of the role WORLD that carries it out, ""
    /// without \throws FormatError
    virtual std::string request(const RosSourceTopic& topic, std::string_view message) = 0;
};

/// Returns the states of lifts: /L/storey, which a message to /L/storey/set changes by a call, and
/// /L/open.
std::shared_ptr<RosSource> liftTopics();

}  // namespace ispace::ros
