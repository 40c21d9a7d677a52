// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server: what requests of several roles have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/pose.h"
#include "server/server_state.h"

namespace ispace {

/// The words of a request and what is between them. \pre they are neighbours, one at least
inline std::string_view textOf(std::span<const std::string_view> words) {
    const std::string_view last = words.back();
    return {words.front().data(),
            static_cast<std::size_t>(last.data() + last.size() - words.front().data())};
}

/// A whole number from 1 to a thousand million, or what is wrong with it.
struct Count {
    std::int64_t value = 0;
    int code = 0;  ///< of the error; 0: none
    std::string message;
};
/// `what` begins the message: "every", "the number of steps".
Count parseCount(std::string_view text, std::string_view what);

/// A measured value, with three decimals.
std::string measured(double value);
/// A heading within (-180, 180], still so when rounded.
std::string headingText(Angle heading);

/// "ERR 404 no robot `r9`\n"
std::string errorLine(int code, std::initializer_list<std::string_view> text);

/// Of a request that failed for want of memory, or because something cannot be written so.
std::string errorLineOf(const std::exception_ptr& failure);

/// "no robot `r9`" with what may have been meant, or what there is.
std::string unknownThing(std::string_view kind, std::string_view id,
                         const std::vector<std::string>& known, std::string_view where = "");

/// The server's end of one client's dialogue in the Simulator TCP Protocol, version 1, without a
/// transport: lines in, bytes out. See ispace-protocol(7) for the language.
class Session {
  public:
    explicit Session(ServerState& state);
    /// Frees the robot or person it holds.
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// "ISPACE 1\n"
    static std::string greeting();
    /// Answers one request (without its end of line); blank lines are ignored. A first line that is
    /// no request comes from a client of another protocol and ends the session.
    /// \pre !waiting() and !closing()
    void request(std::string_view line);
    /// Answers a request that exceeds the allowed length, and closes.
    void tooLong(std::size_t limit);
    /// Writes events and scans for this client, and the answer it waits for. Call it after each
    /// step or change of the world. Without room for them, events that were asked for wait, and
    /// some may be missed.
    void stepped(bool has_room = true);
    /// The same between steps, and answers a request that had to wait.
    void proceed();
    /// Stops what it holds: the client has been silent for too long.
    void silent();

    /// Ends what is under way, at the end of the run, and says so.
    void finish();

    /// True while a STEP, a SEEK, a change of the world or a picture is under way; later requests
    /// wait for its answer.
    [[nodiscard]] bool waiting() const {
        return steps_ != nullptr || seek_ || !held_.empty() || wanted_ || coming_;
    }
    [[nodiscard]] bool hasRole() const { return role_ != Role::None; }
    /// True if that is a change that waits for its turn.
    [[nodiscard]] bool waitsToChange() const { return may_go_on_ == &Session::mayChange; }
    /// True if it drives a robot or a person.
    [[nodiscard]] bool drives() const {
        return !is_gone_ && (role_ == Role::Robot || role_ == Role::Person);
    }
    /// False where roles need a token that the client has not given.
    [[nodiscard]] bool mayLook() const {
        const ServerLimits& limits = state_->limits();
        return has_token_ || !limits.token_first || limits.token.empty();
    }
    /// True after QUIT and errors that close the connection: nothing more is read.
    [[nodiscard]] bool closing() const { return closing_; }
    /// Takes what is to be sent, in order.
    std::string take() { return std::exchange(out_, {}); }
    /// Takes the newest scan of a stream, to be sent after everything else; null if there is none.
    std::shared_ptr<const std::string> takeScan();
    /// Bytes of that scan.
    [[nodiscard]] std::size_t scanBytes() const { return scan_ ? scan_->size() : 0; }

  private:
    enum class Role { None, Robot, Person, Laser, Sensor, World };
    using Words = std::span<const std::string_view>;  // a request, the verb first
    using Condition = bool (Session::*)() const;
    struct Request;
    static std::span<const Request> requests();

    [[nodiscard]] World& world() const { return state_->simulation().world(); }
    static std::string_view verbOf(Role role);
    [[nodiscard]] std::string roleText() const;
    [[nodiscard]] std::string unknownSensor(std::string_view kind, std::string_view id) const;
    void error(int code, std::initializer_list<std::string_view> text);
    void refuse(std::string_view verb, bool first);
    [[nodiscard]] bool mayUse(const Request& request);
    void sync();
    void lose();
    bool mayAskFor(std::string_view verb);
    void leave();
    void sendCompletions();
    void tellEvents();
    void answerStep();
    void answerSeek();
    void hold(Words words, Condition until);
    void goOn();
    [[nodiscard]] bool mayChange() const;
    [[nodiscard]] bool maySeek() const { return state_->isAtRest(); }
    [[nodiscard]] bool hasCome() const { return !coming_; }
    [[nodiscard]] bool sendsPendingScan(Words words);
    void sendReading(std::size_t sensor, const ReplyForm& form);
    void receiveAsked();

    void token(Words words);
    void acquireRobot(Words words);
    void takePerson(Words words);
    [[nodiscard]] bool seize(Role role, std::string_view id, std::size_t mover);
    void takeLaser(Words words);
    void takeSensor(Words words);
    void format(Words words);
    void streamSensor();
    void takeWorld(Words words);
    void help(Words words);
    void quit(Words words);
    void command(Words words);
    void status(Words words);
    void odometry(Words words);
    void scanOfRobot(Words words);
    void sonar(Words words);
    void bumper(Words words);
    void scan(Words words);
    void stream(Words words);
    void stopStream(Words words);
    void binary(Words words);
    void list(Words words);
    void time(Words words);
    void poses(Words words);
    void pause(Words words);
    void resume(Words words);
    void seek(Words words);
    void step(Words words);
    void shutdown(Words words);
    void change(Words words);
    void events(Words words);
    void mark(Words words);

    ServerState* state_;
    Role role_ = Role::None;
    // The robot, person or sensor: its id, and its index since so many changes of the world.
    std::string id_;
    std::string keyword_;  // of a sensor's record
    std::size_t subject_ = 0;
    std::int64_t changes_ = 0;
    std::int64_t hold_ = 0;  // of a robot or person, see ServerState::hold
    bool is_gone_ = false;   // the world has lost it
    std::string out_;
    std::vector<int> running_;  // commands whose end is still to be told
    // The stream: every how many scans (0: none), the last one considered, the one to be sent.
    std::int64_t every_ = 0, seq_ = 0;
    ReplyForm form_;
    bool is_stale_ = false;  // there is a newer one than that to be sent
    std::shared_ptr<const std::string> scan_;
    // What is being made: the answer of a reading or a change, and a reading of the stream.
    std::shared_ptr<const ServerState::Asked> wanted_, coming_;
    std::shared_ptr<const StepQueue::Ticket> steps_;  // of a STEP to be answered
    std::shared_ptr<const Seek> seek_;                // of a SEEK to be answered
    // A request that is answered once this is so.
    std::string held_;
    Condition may_go_on_ = nullptr;
    EventKinds events_;  // that are told
    std::int64_t next_event_ = 0;
    bool has_token_ = false;
    int wrong_tokens_ = 0;
    TokenBucket pauses_, spare_pauses_;
    bool first_ = true;  // nothing was asked yet
    bool closing_ = false;
};

}  // namespace ispace
