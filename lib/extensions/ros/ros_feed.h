// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of topics, encoded once for all clients, in the world's thread or, of pictures and maps,
// in a background one.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/ros/ros_scenery.h"
#include "extensions/ros/ros_source.h"
#include "extensions/ros/ros_topics.h"
#include "server/server_state.h"
#include "sim/sensor_reading.h"

namespace ispace::ros {

/// A message of a topic, encoded once for all clients.
class RosMessage {
  public:
    RosMessage(RosType type, std::int64_t number, std::uint64_t time, std::string cdr)
        : number_(number),
          time_(time),
          type_(type),
          cdr_(std::make_shared<const std::string>(std::move(cdr))) {}

    [[nodiscard]] std::int64_t number() const { return number_; }  ///< counts those of the feed
    [[nodiscard]] std::uint64_t time() const { return time_; }     ///< nanoseconds
    [[nodiscard]] const std::shared_ptr<const std::string>& cdr() const { return cdr_; }
    /// Return it as rosJson() and rosCbor() do; computed once.
    [[nodiscard]] std::shared_ptr<const std::string> json() const;
    [[nodiscard]] std::shared_ptr<const std::string> cbor() const;

  private:
    std::int64_t number_;
    std::uint64_t time_;
    RosType type_;
    std::shared_ptr<const std::string> cdr_;
    mutable std::shared_ptr<const std::string> json_, cbor_;
};

/// The topics of a running world, or of all worlds of a run, and their newest messages. Only
/// messages of wanted topics are computed: at the rate of their row, and at each reading of a
/// sensor.
///
/// Pictures and depth frames are taken in the background, one at a time, in turn.
class RosFeed {
  public:
    RosFeed(ServerState& state, RosScenery scenery);
    RosFeed(const RosFeed&) = delete;
    RosFeed& operator=(const RosFeed&) = delete;

    /// Call after each step or change of the world.
    void stepped();
    /// Adapts the topics to a changed world. Call before the world is used by their channels.
    void sync();

    /// The topics by number. A topic keeps its number until a change of the world removes it.
    struct Entry {
        RosChannel channel;
        std::shared_ptr<const RosMessage> newest;  ///< null: none yet
        std::size_t wanted = 0;                    ///< number of subscriptions
        std::int64_t period = -1;                  ///< of the newest message
        std::optional<Periods> periods = {};       ///< of a row with a rate
    };
    using Entries = std::map<std::uint32_t, Entry>;
    [[nodiscard]] const Entries& entries() const { return entries_; }
    /// Returns the numbers of the topics of this name: input topics may have several types.
    [[nodiscard]] std::span<const std::uint32_t> numbersOf(std::string_view topic) const;
    /// A client comes, which needs the topics of the world as it is now, and goes.
    void enter();
    void leave() { --clients_; }
    /// Changes when topics come or go.
    [[nodiscard]] std::int64_t version() const { return version_; }
    /// Subscribes to a topic, and cancels a subscription; unknown numbers are ignored.
    void want(std::uint32_t number);
    void unwant(std::uint32_t number);
    /// Returns the input topics of which there are messages of clients to read.
    [[nodiscard]] std::vector<std::uint32_t> echoed() const;
    /// Returns true if all clients together have as many subscriptions as they may.
    [[nodiscard]] bool isFull() const;

    /// False for the run of a building, in which clients do not place robots.
    [[nodiscard]] ServerState& state() const { return *state_; }
    /// Returns the URIs of meshes of rooms.
    [[nodiscard]] std::vector<std::string> meshes() const;
    /// Computes the mesh of a room in the background. `deliver` gets "" on failure.
    /// \param which index in meshes()
    void fetchRoom(std::size_t which,
                   std::function<void(std::shared_ptr<const std::string> mesh)> deliver);

  private:
    /// The state of a world of the run, and derived data of it.
    struct Room {
        ServerState* state = nullptr;
        std::int64_t changes = -1;  // change count of the world that the channels describe
        std::optional<RosGrid> map = {};
        bool is_drawing = false;  // the map
        // Of the robots at `sonar_steps`, computed when needed.
        std::vector<std::vector<float>> sonars = {};
        std::vector<std::vector<bool>> bumpers = {};
        std::int64_t sonar_steps = -1;
        std::shared_ptr<const std::string> mesh = {};  // of the world `mesh_changes`
        std::int64_t mesh_changes = -1;
        // Values of states by id and key, of the world `state_changes`.
        std::map<std::pair<std::string, std::string>, std::string> states = {};
        std::int64_t state_changes = -1;
    };
    /// A sensor by room and index.
    using SensorOfRoom = std::pair<std::size_t, std::size_t>;

    void update(Entry& entry);
    void updateState(Entry& entry);
    void updateSource(Entry& entry);
    void updateEcho(Entry& entry);
    [[nodiscard]] RosRun run() const;
    void addSources(std::vector<RosChannel>& out);
    void publish(Entry& entry, std::int64_t period, std::string message);
    [[nodiscard]] bool hasChanged();
    void number(Entries& entries, bool& is_changed);
    void place();
    void drawMap(std::size_t index);
    void takeFrames();
    void takeFrame(SensorOfRoom which);
    [[nodiscard]] RosMoment moment(std::size_t index);

    ServerState* state_;
    RosScenery scenery_;
    std::vector<std::shared_ptr<RosSource>> sources_;
    std::vector<RosRoom> worlds_;  // of the run
    std::vector<Room> rooms_;      // in the same order
    std::string lone_;             // robot whose topics have names without a prefix, too
    Entries entries_;
    std::map<std::string, std::vector<std::uint32_t>, std::less<>> numbers_;  // by topic
    std::set<std::uint32_t> wanted_;                                          // topics
    std::size_t clients_ = 0, subscriptions_ = 0;
    std::uint32_t next_number_ = 1;
    std::int64_t version_ = 0, messages_ = 0;
    std::int64_t echoed_ = 0;  // topics that have echoes
    bool is_taking_ = false;   // a frame
    SensorOfRoom turn_{};      // whose frame is next
    // Guards deliveries of background jobs that outlive the feed.
    std::shared_ptr<RosFeed*> self_ = std::make_shared<RosFeed*>(this);
};

}  // namespace ispace::ros
