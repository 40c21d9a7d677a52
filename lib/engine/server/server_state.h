// SPDX-License-Identifier: GPL-3.0-or-later
// State shared by the sessions of a server. For lib/engine/server and its bridges.
//
// Background work. A heavy reading (ask(), takeFrame()) is computed from a copy of the world's
// state at that time, in the picture thread; a change of the world, or the next part of a replay,
// is prepared in the change thread and adopted between two steps. Both end in collect(), in the
// server's thread. Without startBackground() all of it happens at once, which tests use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/room_state.h"
#include "server/background_worker.h"
#include "server/role_answer.h"
#include "server/server.h"
#include "server/session_sensors.h"
#include "sim/simulation.h"
#include "sim/sole_world.h"
#include "sim/world.h"
#include "sim/world_editor.h"
#include "sim/worlds.h"

namespace ispace {

/// Ids of robots or sensors, in order.
template <typename Things>
std::vector<std::string> idsOf(const Things& things) {
    std::vector<std::string> ids;
    ids.reserve(things.size());
    for (const auto& thing : things) ids.push_back(thing.id);
    return ids;
}

/// Ids of the lasers, in order.
inline std::vector<std::string> laserIdsOf(const World& world) {
    std::vector<std::string> ids;
    for (const Sensor& sensor : world.sensors())
        if (sensor.tryAs<Laser>() != nullptr) ids.push_back(sensor.id);
    return ids;
}

/// Returns the name of a thing across the worlds of a run: "ground/d1". \param room "" in the only
/// one
std::string nameAcross(const std::string& room, const std::string& id);
/// Returns the beginning of the names of things in a room: "ground/". \param room "": the only one,
/// whose names have none
std::string prefixOf(const std::string& room);

/// Enforces a RateLimit: a counter that refills with time, up to `burst`.
class TokenBucket {
  public:
    /// Starts full. \pre rate > 0, burst >= 1
    explicit TokenBucket(const RateLimit& limits) : limits_(limits), left_(limits.burst) {}
    /// Starts empty at `now`.
    TokenBucket(const RateLimit& limits, WallTime now) : limits_(limits), filled_(now) {}
    /// True if the bucket holds a token at `now`.
    bool has(WallTime now);
    /// \pre has(now)
    void take() { left_ -= 1; }

  private:
    RateLimit limits_;
    double left_ = 0;
    WallTime filled_{};  // time at which left_ was computed
};

/// Wrong tokens, counted for each address of clients and in sum over addresses that have never
/// shown the right one. Beyond a limit further wrong ones are answered 429; the right one always
/// passes. Memory is bounded: of more than 1024 addresses the one used longest ago is forgotten,
/// those that had the right token last.
class WrongTokens {
  public:
    explicit WrongTokens(const RateLimit& limits) : limits_(limits), strangers_(limits) {}
    /// Counts a wrong token. \returns false if there were too many before it
    bool count(const std::string& address, WallTime now);
    /// Notes that a client at this address has the token.
    void trust(const std::string& address, WallTime now);

  private:
    struct Address {
        TokenBucket bucket;
        bool is_trusted = false;
        std::int64_t last = 0;  // order of use
    };
    Address& at(const std::string& address, WallTime now);

    RateLimit limits_;
    TokenBucket strangers_;
    std::map<std::string, Address> addresses_;
    std::int64_t uses_ = 0;
};

/// Steps of a paused world requested by clients, taken in order of request: each step counts for
/// the first ticket that still wants one.
class StepQueue {
  public:
    /// Progress of one STEP.
    struct Ticket {
        std::int64_t count = 0, left = 0;
        bool over = false;  ///< ready to answer: all steps taken, or the rest dropped
    };

    explicit StepQueue(Simulation& simulation);
    /// \pre the simulation is paused, count > 0
    std::shared_ptr<const Ticket> ask(std::int64_t count);
    /// Counts the steps taken since the last call.
    void settle();
    /// Drops the remaining steps, at PAUSE, RESUME or the end of the run.
    void cut();
    /// Drops the remaining steps of one ticket; null is allowed.
    void drop(const std::shared_ptr<const Ticket>& ticket);

  private:
    void end();

    Simulation* simulation_;
    std::int64_t seen_;  // steps of the world at the last call
    std::deque<std::shared_ptr<Ticket>> tickets_;
};

/// The newest messages of clients to topics of ROS, which other clients may read.
class TopicEchoes {
  public:
    struct Echo {
        std::shared_ptr<const std::string> message;
        std::int64_t number = 0;  ///< counted from 1
    };
    /// \param key of the topic and its type
    void put(const std::string& key, std::string_view message) {
        Echo& echo = echoes_[key];
        if (!echo.message) ++topics_;
        echo = {std::make_shared<const std::string>(message), ++messages_};
    }
    /// Returns null if there is none yet.
    [[nodiscard]] const Echo* newest(const std::string& key) const {
        const auto found = echoes_.find(key);
        return found == echoes_.end() ? nullptr : &found->second;
    }
    /// Returns the number of topics that have messages.
    [[nodiscard]] std::int64_t topics() const { return topics_; }

  private:
    std::map<std::string, Echo> echoes_;
    std::int64_t topics_ = 0, messages_ = 0;
};

/// Limits clients' changes of the world to half of the time: after one that took d, the next may
/// begin d after its end.
class ChangeBudget {
  public:
    [[nodiscard]] bool mayBegin(WallTime now) const { return now >= next_; }
    /// Records a finished change.
    void spend(WallTime began, WallTime ended) { next_ = ended + (ended - began); }
    /// Earliest start of the next change.
    [[nodiscard]] WallTime next() const { return next_; }

  private:
    WallTime next_{};
};

/// A replay moving to another time.
struct Seek {
    SimTime to{};
    bool is_over = false;
    std::string failure;  ///< the error that stopped the seek; "": no error
};

class RoleService;
class ServerState;

/// The worlds of a run, one or more, and the state of each, in the order of their rooms.
struct ServedRooms {
    Worlds* worlds = nullptr;
    std::vector<ServerState*> states;
};

/// State shared by all sessions of a world: holds on robots, and the text of the newest scans,
/// formatted once for all readers.
///
/// A hold has a number that is never given again, so a session cannot release or drive a mover that
/// has been removed, added under the same id and taken by another client. Not thread-safe: one
/// thread calls all members.
class ServerState {
  public:
    explicit ServerState(Simulation& simulation, const ServerLimits& limits = {});
    ServerState(const ServerState&) = delete;
    ServerState& operator=(const ServerState&) = delete;
    [[nodiscard]] Simulation& simulation() { return *simulation_; }
    [[nodiscard]] const ServerLimits& limits() const { return limits_; }
    /// Returns the rooms of the run: this one alone until joinRooms().
    [[nodiscard]] const ServedRooms& rooms() const { return *rooms_; }
    /// \pre `rooms` outlives this object
    void joinRooms(const ServedRooms& rooms) { rooms_ = &rooms; }

    /// Returns the roles of extensions. \pre they outlive the sessions
    [[nodiscard]] std::span<RoleService* const> roleServices() const { return role_services_; }
    void addRoleService(RoleService& service) { role_services_.push_back(&service); }

    /// A world of the run.
    struct ServedWorld {
        std::string id;  ///< "": the only one
        const World* world = nullptr;
    };
    /// Returns all worlds of the run, also through the state of one of them.
    [[nodiscard]] std::vector<ServedWorld> worlds() const;
    /// A robot, person or sensor, by its id in the world of a state.
    struct ServedEntity {
        ServerState* state = nullptr;
        std::string_view id;
        bool is_known = true;
    };
    /// Finds the world of a thing by its name across the worlds, such as "ground/r1". The only
    /// room has all names; among several a thing that is in none stays here, unknown.
    [[nodiscard]] ServedEntity find(std::string_view name);
    /// Returns the states of all worlds, with the names of things across them, then of lifts.
    [[nodiscard]] std::vector<RoomState> statesOfAll() const;

    /// Reserves a robot or person. \returns the number of this hold; empty if another client has it
    std::optional<std::int64_t> hold(std::string_view id);
    /// False if the world has removed it since, even if its name was given to a new mover.
    [[nodiscard]] bool holds(std::string_view id, std::int64_t hold) const;
    /// Stops the mover and releases it.
    void release(std::string_view id, std::int64_t hold);

    /// Takes over the hold on a mover that has come from the world of another state.
    void takeOver(ServerState& other, const std::string& id);

    /// Updates the state after a change of the world. Call after each change.
    void sync();
    /// True if clients may change the world.
    [[nodiscard]] bool mayChange() const { return limits_.changes && editor_; }
    /// \pre mayChange()
    [[nodiscard]] WorldEditor& editor() { return *editor_; }
    [[nodiscard]] ChangeBudget& changes() { return changes_; }
    /// False while a change is under way, or must wait to leave the world time to run.
    [[nodiscard]] bool mayChangeNow(WallTime now) const {
        return !is_changing_ && !seek_ && changes_.mayBegin(now);
    }
    /// Earliest time of the next change; empty while a change is under way.
    [[nodiscard]] std::optional<WallTime> nextChange() const {
        return is_changing_ || seek_ ? std::nullopt : std::optional(changes_.next());
    }
    /// Changes the world: at once, or after startBackground() with the slow part in a background
    /// thread, during which only pictures wait. collect() then calls `end` with the exception that
    /// was thrown, or null; `end` may rethrow it. \pre mayChangeNow()
    void change(WorldChange change, std::function<void(const std::exception_ptr& failure)> end);
    /// Moves a replay to another time, one part now and the rest in collect().
    /// \pre areAllAtRest(), Simulation::maySeek()
    std::shared_ptr<const Seek> seek(SimTime to);
    /// True if collect() can continue a seek at once.
    [[nodiscard]] bool isOnTheWay() const { return seek_ && !is_changing_; }
    /// Prepares the next step of a replay, in a background thread after startBackground().
    void prepareStep() {
        if (areAllAtRest()) prepare({});
    }
    /// True if clients may have updates since the last call: a change or a mark.
    [[nodiscard]] bool hasUpdates();

    /// Steps that clients have asked for, in the order of their requests.
    [[nodiscard]] StepQueue& steps() { return steps_; }
    /// The common limit on pauses.
    [[nodiscard]] TokenBucket& pauses() { return pauses_; }
    [[nodiscard]] WrongTokens& wrongTokens() { return wrong_tokens_; }

    /// Returns the newest reading of a sensor as scanText writes it; computes a missing reading of
    /// a heavy sensor. All readers share one string. \throws FormatError as scanText does
    std::shared_ptr<const std::string> scan(std::size_t sensor, const ReplyForm& form);
    /// A requested text.
    struct PendingReply {
        std::shared_ptr<const std::string> bytes;  ///< null until it is computed
        bool is_error = false;                     ///< `bytes` is an ERR line
    };
    /// Asynchronous scan(): after startBackground(), a heavy sensor is computed in a background
    /// thread from the current world; equal requests of one period share one reply. Rejected by
    /// code 409 if others are pending, and their pixels with its own exceed kMaxWaitingPixels
    /// (sim/run_limits.h).
    std::shared_ptr<const PendingReply> ask(std::size_t sensor, const ReplyForm& form);
    /// Computes a frame for a record in the same way; requests by ask() for that frame share it.
    void takeFrame(FrameJob job);
    /// Runs a job, in a background thread after startBackground(); collect() then delivers it.
    void runInBackground(BackgroundWorker::Job job);
    /// Enables background threads for slow jobs. They call `wake` when a result is ready for
    /// collect(). \param stopped returns true once results are no longer awaited
    void startBackground(const std::function<void()>& wake, std::function<bool()> stopped) {
        capture_worker_.emplace(wake);
        change_worker_.emplace(wake);
        stopped_ = std::move(stopped);
    }
    /// Waits for the jobs at work; those that have not begun are dropped.
    void stopBackground() {
        capture_worker_.reset();
        change_worker_.reset();
    }
    /// True if no picture, change or seek of the current world is under way.
    [[nodiscard]] bool isAtRest() const { return !isMaking() && !is_changing_ && !seek_; }
    /// Likewise in all worlds of the run.
    [[nodiscard]] bool areAllAtRest() const;
    /// True if clients may expect steps to wait for them: not with the clock Real.
    [[nodiscard]] bool mayHold() const;
    /// Makes the changes of the script that are due, in order; not while another is under way. One
    /// that fails becomes a mark among the events.
    void changeAsScripted();
    /// True if the world must not step: the sequence of steps may not depend on computing time.
    [[nodiscard]] bool holdsWorld() const;
    /// Completes finished requests, between steps. \returns false if there were none
    bool collect();
    /// Waits for requested readings and completes the finished ones. \returns false, without
    /// completing any, once they are no longer awaited
    bool await();
    /// True while pictures, maps and meshes are computed.
    [[nodiscard]] bool isMaking() const { return capture_worker_ && capture_worker_->open() > 0; }
    /// Likewise of any world of the run.
    [[nodiscard]] bool isAnyMaking() const;
    /// True if a background thread has a job running or queued.
    [[nodiscard]] bool isBusy() const {
        return isMaking() || (change_worker_ && change_worker_->open() > 0);
    }
    /// What slow readers of this world's data have lost.
    [[nodiscard]] ReaderLosses& losses() { return losses_; }
    [[nodiscard]] TopicEchoes& echoes() { return echoes_; }
    /// Bytes of outdated scans that connections still have to send.
    [[nodiscard]] std::size_t staleBytes() const { return *alive_ - kept_; }

  private:
    struct Text {
        ReplyForm form;
        std::int64_t seq = -1;
        std::shared_ptr<const std::string> bytes;
    };
    /// A text being computed.
    struct Making {
        std::size_t sensor;
        std::int64_t changes;  // change count of the world
        std::int64_t seq;
        std::optional<ReplyForm> form;  // empty: a frame for the record
        std::shared_ptr<PendingReply> asked;
        std::shared_ptr<SensorReading> reading;  // set once the first job of this sensor is done
        double pixels = 0;
    };
    [[nodiscard]] std::shared_ptr<const std::string> counted(std::string text) const;
    [[nodiscard]] Text& textOf(std::size_t sensor, const ReplyForm& form);
    void keep(Text& text, std::int64_t seq, std::shared_ptr<const std::string> bytes);
    [[nodiscard]] std::shared_ptr<const PendingReply> refusal(std::size_t sensor) const;
    std::function<SensorReading()> startReading(Making& making);
    void make(const Making& making, std::function<SensorReading()> take, FrameJob frame = {});
    bool prepare(std::optional<SimTime> to);
    bool goOnSeeking();
    void build(BackgroundWorker::Job job);
    void endLater(std::shared_ptr<const void> old);
    void adopt(WorldChange change, std::exception_ptr failure, WallTime began,
               const std::function<void(const std::exception_ptr& failure)>& end);

    Simulation* simulation_;
    SoleWorld sole_;
    ServedRooms alone_{&sole_, {this}};
    const ServedRooms* rooms_ = &alone_;
    std::vector<RoleService*> role_services_;
    ServerLimits limits_;
    StepQueue steps_;
    std::map<std::string, std::int64_t, std::less<>> held_;
    std::int64_t holds_ = 0;  // number of holds given so far
    std::optional<WorldEditor> editor_;
    ChangeBudget changes_;
    std::int64_t seen_changes_ = 0;                   // change count of the world
    std::int64_t told_changes_ = 0, told_event_ = 0;  // at the last hasUpdates()
    TokenBucket pauses_;
    WrongTokens wrong_tokens_;
    std::vector<std::vector<Text>> texts_;  // of each sensor, one for each requested form
    std::size_t kept_ = 0;                  // bytes in texts_
    // Bytes of all texts still referenced; shared, since texts may outlive the state.
    std::shared_ptr<std::size_t> alive_ = std::make_shared<std::size_t>(0);
    std::vector<Making> pending_;
    bool is_changing_ = false;
    std::shared_ptr<const PendingReply> scripted_;  // the change of the script under way
    std::shared_ptr<Seek> seek_;                    // null: no seek under way
    std::function<bool()> stopped_;
    // Declared last, since their jobs use the other members: pictures, and changes of the world.
    std::optional<BackgroundWorker> capture_worker_, change_worker_;
    TopicEchoes echoes_;
    ReaderLosses losses_;
};

}  // namespace ispace
