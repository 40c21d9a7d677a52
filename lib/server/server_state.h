// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server: what the sessions of a server share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/background_worker.h"
#include "server/server.h"
#include "server/session_sensors.h"
#include "sim/simulation.h"
#include "sim/world.h"
#include "sim/world_editor.h"

namespace ispace {

/// Ids of robots or sensors, in order.
template <typename Things>
std::vector<std::string> idsOf(const Things& things) {
    std::vector<std::string> ids;
    ids.reserve(things.size());
    for (const auto& thing : things) ids.push_back(thing.id);
    return ids;
}

/// Ids of the lasers among the sensors, in order.
inline std::vector<std::string> laserIdsOf(const World& world) {
    std::vector<std::string> ids;
    for (const RunSensor& sensor : world.sensors())
        if (sensor.model<Laser>() != nullptr) ids.push_back(sensor.id);
    return ids;
}

inline std::string joined(const std::vector<std::string>& words, std::string_view separator) {
    std::string out;
    for (const std::string& word : words) {
        if (!out.empty()) out += separator;
        out += word;
    }
    return out;
}

/// What is left of something that may be asked for only so often.
class TokenBucket {
  public:
    /// Full. \pre rate > 0, burst >= 1
    explicit TokenBucket(const RateLimit& limits) : limits_(limits), left_(limits.burst) {}
    /// Empty at that time.
    TokenBucket(const RateLimit& limits, WallTime now) : limits_(limits), filled_(now) {}
    /// True if one can be taken now.
    bool has(WallTime now);
    /// \pre has(now)
    void take() { left_ -= 1; }

  private:
    RateLimit limits_;
    double left_ = 0;
    WallTime filled_{};  // when left_ was right
};

/// The steps that clients ask of a paused world, taken in the order of asking.
class StepQueue {
  public:
    /// Progress of one STEP.
    struct Ticket {
        std::int64_t count = 0, left = 0;
        bool over = false;  ///< to be answered: all are taken, or no more will be
    };

    explicit StepQueue(Simulation& simulation);
    /// \pre the simulation is paused, count > 0
    std::shared_ptr<const Ticket> ask(std::int64_t count);
    /// Counts the steps taken since the last call.
    void settle();
    /// Drops the steps not yet taken, at PAUSE, RESUME or the end.
    void cut();
    /// Drops the steps of one ticket; null is allowed.
    void drop(const std::shared_ptr<const Ticket>& ticket);

  private:
    void end();

    Simulation* simulation_;
    std::int64_t seen_;  // steps of the world at the last call
    std::deque<std::shared_ptr<Ticket>> tickets_;
};

/// When clients' changes of the world may begin: they take half of the time at most.
class ChangeBudget {
  public:
    [[nodiscard]] bool mayBegin(WallTime now) const { return now >= next_; }
    /// One is over.
    void spend(WallTime began, WallTime ended) { next_ = ended + (ended - began); }
    /// The next one may begin then.
    [[nodiscard]] WallTime next() const { return next_; }

  private:
    WallTime next_{};
};

/// A replay on its way to another time.
struct Seek {
    SimTime to{};
    bool is_over = false;
    std::string failure;  ///< why the world stops on the way; "": it is there
};

/// What all sessions share: which robots are held, and the text of the newest scans, made once for
/// all readers.
class ServerState {
  public:
    explicit ServerState(Simulation& simulation, const ServerLimits& limits = {});
    [[nodiscard]] Simulation& simulation() { return *simulation_; }
    [[nodiscard]] const ServerLimits& limits() const { return limits_; }

    /// A number for the hold of this robot or person; nothing if another client has it.
    std::optional<std::int64_t> hold(std::string_view id);
    /// False if the world has lost it since, even if there is another one of that name now.
    [[nodiscard]] bool holds(std::string_view id, std::int64_t hold) const;
    /// Frees it, and stops it.
    void release(std::string_view id, std::int64_t hold);

    /// Follows changes of the world. Call it after each.
    void sync();
    /// Clients may change the world.
    [[nodiscard]] bool mayChange() const { return limits_.changes && editor_; }
    /// \pre mayChange()
    [[nodiscard]] WorldEditor& editor() { return *editor_; }
    [[nodiscard]] ChangeBudget& changes() { return changes_; }
    /// False while changes leave the world time to go on, or one is under way.
    [[nodiscard]] bool mayChangeNow(WallTime now) const {
        return !is_changing_ && !seek_ && changes_.mayBegin(now);
    }
    /// When that will be so; nothing: when a change is over.
    [[nodiscard]] std::optional<WallTime> nextChange() const {
        return is_changing_ || seek_ ? std::nullopt : std::optional(changes_.next());
    }
    /// Changes the world: at once, or if makeAside() was called with what takes long in another
    /// thread, where nobody waits for it but pictures. `end` is then called by collect(), with what
    /// was thrown, or null, and may throw that again. \pre mayChangeNow()
    void change(WorldChange change, std::function<void(const std::exception_ptr& failure)> end);
    /// Takes a replay to another time, a part now and the others in collect().
    /// \pre isAtRest(), Simulation::maySeek()
    std::shared_ptr<const Seek> seek(SimTime to);
    /// True if collect() has something to do at once.
    [[nodiscard]] bool isOnTheWay() const { return seek_ && !is_changing_; }
    /// Prepares what the next step of a replay needs, in another thread if makeAside() was called.
    void prepareStep() {
        if (isAtRest()) prepare({});
    }
    /// True if there may be news for clients since the last call: a change, a mark.
    [[nodiscard]] bool hasUpdates();

    [[nodiscard]] StepQueue& steps() { return steps_; }
    /// Of all clients together.
    [[nodiscard]] TokenBucket& pauses() { return pauses_; }
    [[nodiscard]] TokenBucket& wrongTokens() { return wrong_tokens_; }

    /// The newest reading of a sensor as scanText writes it, of a heavy one taken now if need be;
    /// all readers share one string. \throws FormatError as scanText does
    std::shared_ptr<const std::string> scan(std::size_t sensor, const ReplyForm& form);
    /// A text that was asked for.
    struct Asked {
        std::shared_ptr<const std::string> bytes;  ///< null until it is made
        bool is_error = false;                     ///< it is a line of ERR
    };
    /// The same as scan(). Of a heavy sensor, it is made in another thread if makeAside() was
    /// called: as the sensor sees the world now. Refused if too much is waiting to be made.
    std::shared_ptr<const Asked> ask(std::size_t sensor, const ReplyForm& form);
    /// Takes a frame for a record, likewise; those who ask() for the same one share it.
    void takeFrame(FrameJob job);
    /// Does something, in another thread if makeAside() was called; collect() then delivers it.
    void runInBackground(BackgroundWorker::Job job);
    /// Lets another thread make what takes long. It calls `wake` when something is ready for
    /// collect(). \param stopped true once nobody waits for that any more
    void makeAside(const std::function<void()>& wake, std::function<bool()> stopped) {
        workshop_.emplace(wake);
        builders_.emplace(wake);
        stopped_ = std::move(stopped);
    }
    void endAside() {
        workshop_.reset();
        builders_.reset();
    }
    /// True if nothing is being made of the world as it is: no picture, no change, no way to
    /// another time.
    [[nodiscard]] bool isAtRest() const { return !isMaking() && !is_changing_ && !seek_; }
    /// The world must not go on: it takes the same steps however long something takes.
    [[nodiscard]] bool holdsWorld() const;
    /// Completes what was asked for and is ready, between steps. \returns false if nothing is
    bool collect();
    /// Waits for readings that were asked for, and completes those that are ready. \returns false,
    /// and does nothing, once nobody waits any more
    bool await();
    /// True if another thread is at something, or will be.
    [[nodiscard]] bool isBusy() const { return isMaking() || (builders_ && builders_->open() > 0); }
    /// Bytes of outdated scans that connections still have to send.
    [[nodiscard]] std::size_t staleBytes() const { return *alive_ - kept_; }

  private:
    struct Text {
        ReplyForm form;
        std::int64_t seq = -1;
        std::shared_ptr<const std::string> bytes;
    };
    /// A text that is being made.
    struct Making {
        std::size_t sensor;
        std::int64_t changes;  // of the world
        std::int64_t seq;
        std::optional<ReplyForm> form;  // nothing: a frame for the record
        std::shared_ptr<Asked> asked;
        std::shared_ptr<SensorReading> reading;  // once the first job of this sensor is done
        double pixels = 0;
    };
    [[nodiscard]] bool isMaking() const { return workshop_ && workshop_->open() > 0; }
    [[nodiscard]] std::shared_ptr<const std::string> counted(std::string text) const;
    [[nodiscard]] Text& textOf(std::size_t sensor, const ReplyForm& form);
    void keep(Text& text, std::int64_t seq, std::shared_ptr<const std::string> bytes);
    [[nodiscard]] std::shared_ptr<const Asked> refusal(std::size_t sensor) const;
    std::function<SensorReading()> beginMaking(Making& making);
    void make(const Making& making, std::function<SensorReading()> take, FrameJob frame = {});
    bool prepare(std::optional<SimTime> to);
    bool goOnSeeking();
    void build(BackgroundWorker::Job job);
    void endLater(std::shared_ptr<const void> old);
    void adopt(WorldChange change, std::exception_ptr failure, WallTime began,
               const std::function<void(const std::exception_ptr& failure)>& end);

    Simulation* simulation_;
    ServerLimits limits_;
    StepQueue steps_;
    std::map<std::string, std::int64_t, std::less<>> held_;
    std::int64_t holds_ = 0;  // so far
    std::optional<WorldEditor> editor_;
    ChangeBudget changes_;
    std::int64_t seen_changes_ = 0;                   // of the world
    std::int64_t told_changes_ = 0, told_event_ = 0;  // at the last hasUpdates()
    TokenBucket pauses_, wrong_tokens_;
    std::vector<std::vector<Text>> texts_;  // of each sensor, in every form that was asked for
    std::size_t kept_ = 0;                  // bytes in texts_
    // Bytes of all texts that somebody has; it outlives them.
    std::shared_ptr<std::size_t> alive_ = std::make_shared<std::size_t>(0);
    std::vector<Making> makings_;
    bool is_changing_ = false;
    std::shared_ptr<Seek> seek_;  // null: there is none
    std::function<bool()> stopped_;
    // The last, as their jobs are about the others: of pictures, and of changes of the world.
    std::optional<BackgroundWorker> workshop_, builders_;
};

}  // namespace ispace
