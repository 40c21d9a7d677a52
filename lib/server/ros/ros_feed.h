// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server.
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
#include <vector>

#include "server/ros/ros_topics.h"
#include "server/server_state.h"
#include "sim/sensor_reading.h"

namespace ispace {

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

/// The topics of a running world and their newest messages. Only messages of wanted topics are
/// computed: at the rate of their row, and at each reading of a sensor.
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
    /// Returns true if all clients together have as many subscriptions as they may.
    [[nodiscard]] bool isFull() const;

    [[nodiscard]] const RosFrames& frames() const { return *frames_; }
    /// Computes the mesh of the room in the background. `deliver` gets "" on failure.
    void fetchRoom(std::function<void(std::shared_ptr<const std::string> mesh)> deliver);

  private:
    void update(Entry& entry);
    void publish(Entry& entry, std::int64_t period, std::string message);
    void drawMap();
    void takeFrames();
    void takeFrame(std::size_t sensor);
    [[nodiscard]] RosMoment moment();

    ServerState* state_;
    RosScenery scenery_;
    std::optional<RosFrames> frames_;
    Entries entries_;
    std::map<std::string, std::vector<std::uint32_t>, std::less<>> numbers_;  // by topic
    std::set<std::uint32_t> wanted_;                                          // topics
    std::size_t clients_ = 0, subscriptions_ = 0;
    std::uint32_t next_number_ = 1;
    std::int64_t version_ = 0, messages_ = 0;
    std::int64_t changes_ = -1;  // change count of the world that entries_ describe
    std::optional<RosGrid> map_;
    bool is_drawing_ = false;  // the map
    bool is_taking_ = false;   // a frame
    std::size_t turn_ = 0;     // sensor whose frame is next
    // Of the robots at `sonar_steps_`, computed when needed.
    std::vector<std::vector<float>> sonars_;
    std::vector<std::vector<bool>> bumpers_;
    std::int64_t sonar_steps_ = -1;
    std::shared_ptr<const std::string> room_;  // mesh of the world `room_changes_`
    std::int64_t room_changes_ = -1;
    // Guards deliveries of background jobs that outlive the feed.
    std::shared_ptr<RosFeed*> self_ = std::make_shared<RosFeed*>(this);
};

}  // namespace ispace
