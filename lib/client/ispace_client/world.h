// SPDX-License-Identifier: GPL-3.0-or-later
// The world of a run: its clock, its events, and changes of its records.
#ifndef ISPACE_CLIENT_WORLD_H
#define ISPACE_CLIENT_WORLD_H

#include <limits>
#include <map>
#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// An event in the world.
struct Event {
    /// collision, stall, unreached, enter, leave, mat, gate, seen, lost, state, activity, mark,
    /// change; missed: number (n=) of events dropped because the client did not read them
    std::string kind;
    double time = 0;  ///< simulated seconds
    Fields fields;    ///< id=, into=, zone= and further fields of its kind
};

/// A lift of a building.
struct Lift {
    std::string id;
    std::string storey;  ///< at which it stands, or from which it rides
    double height = 0;   ///< of its floor, m
    double door = 0;     ///< open share of its width
    std::vector<std::string> riders;
    std::vector<std::string> calls;  ///< storeys, in the order in which it serves them
};

/// The simulated world and its clock (role WORLD). Any number of clients may have the role; each
/// may change the world, if the server permits. A change is done when its function returns, as a
/// whole or, with Refused, not at all: 409 if it is impossible, 403 in runs that take none.
///
///     World world("127.0.0.1:7001");
///     world.pause();
///     world.set("desk1", "at", "2,3");
///     world.step(200);  // 1 s of a world with dt = 0.005
class World {
  public:
    explicit World(const Address& address, const Options& options = Options())
        : connection_(address, options) {
        info_ = ask("WORLD").fields;
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    double dt() const { return info_.number("dt"); }           ///< length of a step, s
    std::string clock() const { return info_.text("clock"); }  ///< real, fast or step
    /// Simulated seconds per second of wall time; 1 unless the clock is real.
    double rate() const { return info_.has("rate") ? info_.number("rate") : 1; }

    /// Returns ids by the categories of LIST: robots, lasers, people, sensors …
    std::map<std::string, std::vector<std::string>> list() {
        std::map<std::string, std::vector<std::string>> ids;
        const Message answer = ask("LIST");
        for (const auto& pair : answer.fields.pairs()) ids[pair.first] = split(pair.second, ',');
        return ids;
    }
    /// Simulated seconds since the run began.
    double time() { return ask("TIME").fields.number("t"); }
    long steps() { return ask("TIME").fields.integer("steps"); }
    /// End of a replay, simulated seconds; infinity if unknown, and for other runs.
    double end() {
        const Fields fields = ask("TIME").fields;
        return fields.has("end") ? fields.number("end") : std::numeric_limits<double>::infinity();
    }
    /// Poses of robots and people, m and degrees.
    std::map<std::string, Pose> poses() {
        std::map<std::string, Pose> poses;
        const Fields fields = ask("POSES").fields;
        std::vector<std::string> items = split(fields.text("poses"), ';');
        for (const std::string& item : split(fields.text("people", ""), ';')) items.push_back(item);
        for (const std::string& item : items) {
            const std::vector<std::string> parts = split(item, ',');
            if (parts.size() != 4) throw ProtocolError("`" + item + "` is no pose");
            Pose& pose = poses[parts[0]];
            pose.x = numberOf(parts[1]);
            pose.y = numberOf(parts[2]);
            pose.heading = numberOf(parts[3]);
        }
        return poses;
    }

    /// Returns the lifts of a building.
    std::vector<Lift> lifts() {
        std::vector<Lift> lifts;
        for (const std::string& item : split(ask("LIFTS").fields.text("lifts"), ';')) {
            const std::vector<std::string> parts = split(item, ',');
            if (parts.size() != 6) throw ProtocolError("`" + item + "` is no lift");
            Lift lift;
            lift.id = parts[0];
            lift.storey = parts[1];
            lift.height = numberOf(parts[2]);
            lift.door = numberOf(parts[3]);
            lift.riders = split(parts[4], '+');
            lift.calls = split(parts[5], '+');
            lifts.push_back(lift);
        }
        return lifts;
    }
    /// Calls a lift to a storey.
    void call(const std::string& lift, const std::string& storey) {
        ask("CALL " + lift + " " + storey);
    }
    /// Sends a lift to a storey before all calls, and keeps its doors open there; "" ends that.
    void hold(const std::string& lift, const std::string& storey = "") {
        ask("HOLD " + lift + " " + storey);
    }

    /// Stops the clock, for all clients.
    void pause() { ask("PAUSE"); }
    void resume() { ask("RESUME"); }
    /// Of the clock `real`: so many simulated seconds pass in a second from now on.
    void setRate(double rate) { ask("RATE " + textOf(rate)); }
    /// Advances a world that is paused or has the clock `step`, and waits until it has.
    /// \param timeout seconds of wall time
    /// \return steps taken: fewer if another client pauses or the run ends
    long step(long steps = 1, double timeout = std::numeric_limits<double>::infinity()) {
        return connection_.ask("STEP " + std::to_string(steps), timeout).fields.integer("n");
    }
    /// Moves a replay to its last step at or before this simulated time.
    /// \param timeout seconds of wall time: a seek back reads the record again
    /// \return the time of that step
    double seek(double seconds, double timeout = std::numeric_limits<double>::infinity()) {
        return connection_.ask("SEEK " + textOf(seconds), timeout).fields.number("t");
    }
    /// Ends the run.
    void shutdown() { ask("SHUTDOWN"); }

    /// Returns robots and people to their initial poses; time continues.
    void reset() { change("RESET"); }
    /// Changes a key of a record: set("r1", "speed", "0.3").
    void set(const std::string& id, const std::string& key, const std::string& value) {
        change("SET " + id + "." + key + "=" + value);
    }
    /// Sets the state of a lamp, a door or a switch: act("l1", "on", "1").
    void act(const std::string& id, const std::string& key, const std::string& value) {
        change("ACT " + id + " " + key + "=" + value);
    }
    /// Returns the states of sensors and actuators by "ID.KEY", or those of one of them.
    std::map<std::string, std::string> states(const std::string& id = "") {
        std::map<std::string, std::string> states;
        const Fields fields = ask(id.empty() ? "STATE" : "STATE " + id).fields;
        for (const auto& pair : fields.pairs()) states.insert(pair);
        states.erase("t");
        return states;
    }
    /// Returns the records of the world, as in a file: those of the room, then robots, people and
    /// sensors. \param room a storey, a lift or stairs of a building
    std::vector<std::string> records(const std::string& room = "") {
        const std::string text = ask("RECORDS" + (room.empty() ? "" : " " + room)).data;
        std::vector<std::string> lines;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = text.find('\n', begin);
            lines.push_back(text.substr(begin, end - begin));
            begin = end == std::string::npos ? text.size() : end + 1;
        }
        return lines;
    }
    /// Adds a record, as in an environment or layout: add("cube id=b at=1,1 size=1,1,1").
    /// \return its id
    std::string add(const std::string& record) { return change("ADD " + record).text("id"); }
    void remove(const std::string& id) { change("DELETE " + id); }
    /// Loads another room. The server opens the files, which must lie in the folder that clients
    /// may read; `layout` may be empty. Clients keep robots, people and sensors whose ids the new
    /// room has; calls about others are refused.
    void load(const std::string& environment, const std::string& layout = "") {
        const std::string files = environment + (layout.empty() ? "" : " " + layout);
        warning_ = connection_.ask("LOAD " + files, kLoadTimeout).fields.text("warning", "");
    }
    /// The server's warning about the last change, e.g. a robot outside the room; "" without one.
    const std::string& warning() const { return warning_; }
    /// Writes a line into the records and to all clients that follow events.
    void mark(const std::string& text) { ask("MARK " + text); }

    /// Tells where a tracker sees a person or robot, for the page, the record and topics.
    /// \param name of the track \param kind "person", "robot" or ""
    /// \param time of the position, simulated seconds; not a number: now
    /// \param storey of a building
    void track(const std::string& name, double x, double y, const std::string& kind = "",
               double time = std::numeric_limits<double>::quiet_NaN(),
               const std::string& storey = "") {
        ask("TRACK " + name + " " + (storey.empty() ? "" : storey + "/") + textOf(x) + "," +
            textOf(y) + (time == time ? " t=" + textOf(time) : "") +
            (kind.empty() ? "" : " kind=" + kind));
    }

    /// Subscribes to events of these kinds, or of all kinds.
    void events(const std::vector<std::string>& kinds = std::vector<std::string>()) {
        std::string request = "EVENTS";
        for (std::size_t i = 0; i < kinds.size(); ++i) request += (i > 0 ? "," : " ") + kinds[i];
        ask(request);
    }
    void eventsOff() { ask("EVENTS off"); }
    /// Waits for the next event.
    /// \param timeout seconds of wall time
    /// \return false on timeout
    bool nextEvent(Event& event, double timeout = std::numeric_limits<double>::infinity()) {
        Message message;
        if (!connection_.nextEvent(message, timeout)) return false;
        event.kind = message.word(1);
        event.time = message.fields.number("t");
        event.fields = message.fields;
        return true;
    }

    /// For requests without a function in this class.
    Connection& connection() { return connection_; }

  private:
    static constexpr double kLoadTimeout = 600;  // time to load a building

    Message ask(const std::string& request) { return connection_.ask(request); }

    Fields change(const std::string& request) {
        const Fields fields = ask(request).fields;
        warning_ = fields.text("warning", "");
        return fields;
    }

    Connection connection_;
    Fields info_;
    std::string warning_;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_WORLD_H
