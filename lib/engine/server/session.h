// SPDX-License-Identifier: GPL-3.0-or-later
// One client's session, and functions shared by the requests of all roles. Private to
// lib/engine/server.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
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
#include "server/client_role.h"
#include "server/server_state.h"

namespace ispace {

/// The text from the first word to the last. \pre the words are adjacent in one string, at least
/// one
inline std::string_view textOf(std::span<const std::string_view> words) {
    const std::string_view last = words.back();
    return {words.front().data(),
            static_cast<std::size_t>(last.data() + last.size() - words.front().data())};
}

/// An integer from 1 to 10^9, or the error in its text: 400 if it is no whole number, 416 if it is
/// out of range.
struct Count {
    std::int64_t value = 0;
    int code = 0;  ///< code of the error; 0: no error
    std::string message;
};
/// \param what subject of an error message: "every", "the number of steps"
Count parseCount(std::string_view text, std::string_view what);

/// Formats a measured value with three decimals, as formatFixed rounds.
std::string measured(double value);
/// Formats a heading in (-180, 180], which also holds after rounding.
std::string headingText(Angle heading);

/// "ERR 404 no robot `r9`\n"
std::string errorLine(int code, std::initializer_list<std::string_view> text);

/// Error line, code 409, of a request that ran out of memory or has no representation in the
/// format. \param failure a std::exception
std::string errorLineOf(const std::exception_ptr& failure);

/// Returns "no robot `r9`" with the most similar id, or the list of ids.
std::string unknownThing(std::string_view kind, std::string_view id,
                         const std::vector<std::string>& known, std::string_view where = "");

struct RoomRequest;

/// The server's side of one client's dialogue in the Simulator TCP Protocol, version 1, without
/// transport: it reads lines and writes bytes. ispace-protocol(7) describes the language.
///
/// Each request gets one line in answer, "OK …", "SCAN …" or "ERR CODE reason", maybe with bytes
/// behind it, in the order of requests; events and readings that are older than the answer come
/// before it. A request that cannot be answered now is kept, and those after it stay unread. Motion
/// commands send a further line when they end. Bad requests do not throw; std::bad_alloc of one
/// becomes ERR 409.
///
///     Session session(state);
///     session.request("ROBOT r1");
///     session.request("FORWARD 1.5");
///     send(session.take());
class Session {
  public:
    /// \param peer address of the client, without its port; "" if unknown
    explicit Session(ServerState& state, std::string peer = {});
    /// Releases the robot or person it holds.
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// "ISPACE 1\n"
    static std::string greeting();
    /// Answers one request, given without its end of line; skips blank lines. If the first line is
    /// not a request, the client speaks another protocol and the session ends.
    /// \pre !waiting() and !closing()
    void request(std::string_view line);
    /// Returns how many requests that follow a request ADD or SET at once can share its change of
    /// the world: pass them to join() before request(), as long as isAlike().
    [[nodiscard]] std::size_t mayJoin(std::string_view line) const;
    /// Returns true if both lines are requests ADD, or both SET.
    static bool isAlike(std::string_view line, std::string_view next);
    /// Adds a request to the next one. It is answered after it, by itself if they fail together.
    void join(std::string_view line) { backlog_.emplace_back(line); }
    /// Answers a request that exceeds the permitted length, and closes.
    void tooLong(std::size_t limit);
    /// Writes this client's events and scans, and the awaited answer. Call after each step or
    /// change of the world. Without room, subscribed events wait, and some may be lost.
    void stepped(bool has_room = true);
    /// Continues output between steps, and answers a request that had to wait.
    void proceed();
    /// Stops the held mover after the client has been silent for too long.
    void silent();

    /// Ends pending requests at the end of the run and informs the client.
    void finish();

    /// True while a STEP, a SEEK, a change of the world or a picture is under way; later requests
    /// wait for its answer.
    [[nodiscard]] bool waiting() const {
        return steps_ != nullptr || seek_ || !held_.empty() || !backlog_.empty() || wanted_ ||
               coming_;
    }
    [[nodiscard]] bool hasRole() const { return role_ != Role::None; }
    /// True if the pending request is a change of the world that awaits its turn.
    [[nodiscard]] bool waitsToChange() const { return may_go_on_ == &Session::mayChange; }
    /// True if the client drives a robot or a person.
    [[nodiscard]] bool drives() const {
        return !is_gone_ && (role_ == Role::Robot || role_ == Role::Person);
    }
    /// False if roles require a token that the client has not given.
    [[nodiscard]] bool mayLook() const {
        const ServerLimits& limits = state_->limits();
        return has_token_ || !limits.token_first || limits.token.empty();
    }
    /// False if changes of the world require a token that the client has not given.
    [[nodiscard]] bool hasToken() const { return has_token_ || state_->limits().token.empty(); }
    /// True after QUIT and after errors that close the connection: no more input is read.
    [[nodiscard]] bool closing() const { return closing_; }
    /// Returns and clears the output, in order.
    std::string take() { return std::exchange(out_, {}); }
    /// Returns and clears the newest scan of a stream, sent after all other output; null if none.
    std::shared_ptr<const std::string> takeScan();
    /// Bytes of that scan.
    [[nodiscard]] std::size_t scanBytes() const { return scan_ ? scan_->size() : 0; }

  private:
    enum class Role { None, Robot, Person, Laser, Sensor, World, Guest };  // of an extension
    using Words = std::span<const std::string_view>;                       // a request, verb first
    using Condition = bool (Session::*)() const;
    struct Request;
    static std::span<const Request> requests();

    [[nodiscard]] World& world() const { return state_->simulation().world(); }
    [[nodiscard]] const ServedRooms& rooms() const { return state_->rooms(); }
    [[nodiscard]] Worlds& worlds() const { return *rooms().worlds; }
    /// Goes to the world of a robot, person or sensor. \returns its id there
    std::string_view enter(std::string_view id);
    /// Calls visit(EventLog&) for that of each world.
    template <typename Visit>
    void forEachLog(Visit visit) {
        for (ServerState* const each : rooms().states) visit(each->simulation().events());
    }
    void followRoom();
    [[nodiscard]] bool isTrip(Words words) const;
    void startTrip(Words words);
    void answerTrip(std::string_view verb, const TripAnswer& answer);
    [[nodiscard]] std::vector<std::string> idsOfAll(Role role) const;
    [[nodiscard]] std::size_t room() const;
    [[nodiscard]] std::string whereText() const;
    [[nodiscard]] std::string_view verbOf(Role role) const;
    [[nodiscard]] std::string roleText() const;
    [[nodiscard]] std::string unknownSensor(std::string_view kind, std::string_view id) const;
    void error(int code, std::initializer_list<std::string_view> text);
    void refuse(std::string_view verb, bool first);
    [[nodiscard]] bool mayUse(const Request& request);
    void sync();
    void lose();
    bool mayAskFor(std::string_view verb);
    bool mayMove();
    void leave();
    void sendCompletions();
    void notifyEvents();
    void answerStep();
    void answerSeek();
    void hold(Words words, Condition until);
    void goOn();
    [[nodiscard]] bool mayChange() const;
    [[nodiscard]] std::vector<std::string> withJoined(const RoomRequest& first, Words words);
    void act(ServerState& state, const std::string& id, Words values);
    bool placeMover(Words words);
    bool changeBody(Words words);
    [[nodiscard]] bool maySeek() const { return state_->areAllAtRest(); }
    [[nodiscard]] bool hasCome() const { return !coming_; }
    [[nodiscard]] bool sendsPendingScan(Words words);
    void sendReading(std::size_t sensor, const ReplyForm& form);
    void receiveAsked();
    void receiveChange(const ServerState::PendingReply& change);
    void abandonRequests();

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
    void ride(Words words);
    void call(Words words);
    void lifts(Words words);
    void states(Words words);
    void records(Words words);
    void pause(Words words);
    void resume(Words words);
    void rate(Words words);
    void seek(Words words);
    void step(Words words);
    void shutdown(Words words);
    void change(Words words);
    void events(Words words);
    void mark(Words words);
    void track(Words words);

    /// A sensor that the role of an extension reads; without a state: unknown.
    struct GuestSensor {
        ServerState* state = nullptr;
        std::size_t index = 0;
    };
    /// A stream of such a role: its last period.
    struct GuestStream {
        std::string name;
        std::int64_t every = 1, seq = 0;
    };
    [[nodiscard]] RoleService* serviceOf(std::string_view verb) const;
    void answer(Words words, bool first);
    [[nodiscard]] bool isOfRole(const Request& request) const;
    void takeGuestRole(RoleService& service, Words words);
    bool guestRequest(Words words);
    [[nodiscard]] bool guestIsReady() const { return !guest_->waits(); }
    GuestSensor guestSensor(std::string_view name);
    void scanOfGuest(Words words);
    void streamOfGuest(Words words);
    void stopGuestStream(std::string_view name);
    void stopOfGuest(Words words);
    void stepGuest(bool has_room);
    [[nodiscard]] std::string byGuestClock(const std::string& text) const;

    ServerState* state_;
    Role role_ = Role::None;
    // The robot, person or sensor: its id, and its index, valid for this change count of the world.
    std::string id_;
    std::string keyword_;  // keyword of a sensor's record
    std::size_t subject_ = 0;
    std::int64_t changes_ = 0;
    std::int64_t hold_ = 0;  // of a robot or person, see ServerState::hold
    bool is_gone_ = false;   // the world has removed the mover
    std::string out_;
    std::vector<int> running_;  // motion commands with an end to report
    // The stream: its divisor (0: none), the last scan considered, the scan to be sent.
    std::int64_t every_ = 0, seq_ = 0;
    ReplyForm form_;
    bool is_stale_ = false;  // a newer scan than the one to be sent exists
    std::shared_ptr<const std::string> scan_;
    // Pending results: the answer of a reading or a change, and a reading of the stream.
    std::shared_ptr<const ServerState::PendingReply> wanted_, coming_;
    std::shared_ptr<const StepQueue::Ticket> steps_;  // of a pending STEP
    std::shared_ptr<const Seek> seek_;                // of a pending SEEK
    // A deferred request, answered once this condition holds.
    std::string held_;
    Condition may_go_on_ = nullptr;
    // Requests ADD or SET that follow the pending one, those of one change under way (if more than
    // one), and how many the next change may carry out.
    std::deque<std::string> backlog_;
    std::vector<std::string> joined_;
    std::size_t joins_ = 1;
    EventKinds events_;                      // subscribed events
    std::vector<std::int64_t> next_events_;  // in each world
    std::unique_ptr<ClientRole> guest_;      // of the role Guest
    std::string_view guest_verb_;
    std::vector<GuestStream> guest_streams_;
    std::string peer_;
    bool has_token_ = false;
    int wrong_tokens_ = 0;
    TokenBucket pauses_, spare_pauses_;
    bool first_ = true;  // no request received yet
    bool closing_ = false;
};

}  // namespace ispace
