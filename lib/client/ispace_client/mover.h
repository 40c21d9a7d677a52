// SPDX-License-Identifier: GPL-3.0-or-later
// Motions that robots and people share: speeds, ways and paths, each with its end. Metres, degrees
// counter-clockwise, simulated seconds.
//
//     Robot robot("127.0.0.1:7001", "r1");
//     const Motion motion = robot.forward(1.5);  // returns as soon as it runs
//     if (!robot.wait(motion).done) robot.stop();
#ifndef ISPACE_CLIENT_MOVER_H
#define ISPACE_CLIENT_MOVER_H

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// A point on the floor, metres.
struct Point {
    double x = 0, y = 0;
    Point() = default;
    Point(double east, double north) : x(east), y(north) {}
};

/// State of a robot or person: its true pose in the room.
struct Status {
    double time = 0;      ///< simulated seconds
    Pose pose;            ///< m, degrees
    double speed = 0;     ///< m/s, negative backward
    double rotspeed = 0;  ///< degrees/s, counter-clockwise
    double accel = 0;     ///< m/s²
    double rotaccel = 0;  ///< degrees/s²
    bool stall = false;   ///< it has run into a body, and stands until its next motion
    std::string storey;   ///< of a building; in a lift that whose floor is nearest; "" in a room
    std::string passage;  ///< the lift or the flight of stairs in which it is; "": on the storey
    Fields fields;        ///< all fields of the answer
};

/// Speeds of a robot or person on a floor without friction.
struct Limits {
    double speed = 0;          ///< m/s of forward() and backward()
    double rotspeed = 0;       ///< degrees/s of left() and right()
    double max_speed = 0;      ///< m/s, forward and backward
    double max_rotspeed = 0;   ///< degrees/s, either way
    double max_sidespeed = 0;  ///< m/s, to either side; 0: not supported
    double accel = 0;          ///< m/s², speeding up and braking
    double rotaccel = 0;       ///< degrees/s²
};

/// A robot's odometry from its wheels, starting at (0, 0, 0); differs from Status::pose if the run
/// has noise.
struct Odometry {
    double time = 0;
    Pose pose;            ///< m, degrees
    double speed = 0;     ///< m/s
    double rotspeed = 0;  ///< degrees/s
};

/// A motion with an end, started by forward(), left(), path() and similar functions, which return
/// as soon as it runs.
struct Motion {
    int id = 0;
    double length = 0;  ///< of a path, m
};

/// How a motion ended.
struct End {
    int id = 0;
    bool done = false;   ///< it has reached its goal
    std::string reason;  ///< otherwise: stall, unreached, replaced, stopped or deleted
    double time = 0;     ///< simulated seconds
};

/// How to drive a path.
struct PathOptions {
    double speed = 0;   ///< m/s; 0: the mover's own speed
    double pause = 0;   ///< s at each point
    bool loop = false;  ///< repeats from the last point to the first
};

/// How to go to a point.
struct GoOptions {
    double speed = 0;                                           ///< m/s; 0: the mover's own speed
    double heading = std::numeric_limits<double>::quiet_NaN();  ///< to turn to there, degrees
    std::string storey = std::string();  ///< of the point, in a building; "": that of the mover
};

/// A robot or person driven by this client. Only one client can drive it; others are refused (409).
/// When the object is destroyed, or its program dies, the robot brakes and is released. A new
/// motion replaces the current one, which then ends as replaced.
///
/// Motions throw Refused: 416 for a value out of range or a person that sits or lies, 409 in a lift
/// or on stairs, 404 once the mover has been removed from the world.
class Mover {
  public:
    Mover(const Mover&) = delete;
    Mover& operator=(const Mover&) = delete;

    const std::string& id() const { return id_; }
    /// The server's description at the start: model, radius …
    const Fields& info() const { return info_; }
    /// \throws ProtocolError if the server is too old to report it
    Limits limits() const {
        Limits limits;
        limits.speed = info_.number("speed");
        limits.rotspeed = info_.number("rotspeed");
        limits.max_speed = info_.number("max_speed");
        limits.max_rotspeed = info_.number("max_rotspeed");
        limits.max_sidespeed = info_.number("max_sidespeed");
        limits.accel = info_.number("accel");
        limits.rotaccel = info_.number("rotaccel");
        return limits;
    }

    /// Drives this distance at the model's own speed.
    /// \param metres not negative
    Motion forward(double metres) { return begin("FORWARD " + textOf(metres)); }
    Motion backward(double metres) { return begin("BACKWARD " + textOf(metres)); }
    /// Turns on the spot, counter-clockwise.
    /// \param degrees not negative
    Motion left(double degrees) { return begin("LEFT " + textOf(degrees)); }
    /// Turns on the spot, clockwise.
    Motion right(double degrees) { return begin("RIGHT " + textOf(degrees)); }
    /// Follows straight lines from the current position.
    Motion path(const std::vector<Point>& points, const PathOptions& options = PathOptions()) {
        std::string request = "PATH ";
        for (std::size_t i = 0; i < points.size(); ++i)
            request += (i > 0 ? ";" : "") + textOf(points[i].x) + "," + textOf(points[i].y);
        if (options.speed > 0) request += " speed=" + textOf(options.speed);
        if (options.pause > 0) request += " pause=" + textOf(options.pause);
        if (options.loop) request += " loop=yes";
        return begin(request);
    }
    /// Goes round walls, furniture and robots that stand to a point of the room, or of the storey
    /// on which it is. \throws Refused (409) without a way
    Motion goTo(const Point& point, const GoOptions& options = GoOptions()) {
        std::string request = "GOTO ";
        if (!options.storey.empty()) request += options.storey + "/";
        request += textOf(point.x) + "," + textOf(point.y);
        if (!std::isnan(options.heading)) request += "," + textOf(options.heading);
        if (options.speed > 0) request += " speed=" + textOf(options.speed);
        return begin(request);
    }
    /// Goes by the fastest way to a point of a storey, in the run of a building.
    /// \param speed m/s; 0: its own
    Motion goTo(const std::string& storey, const Point& point, double speed = 0) {
        GoOptions options;
        options.speed = speed;
        options.storey = storey;
        return goTo(point, options);
    }
    /// Takes a lift to a storey, in the run of a building.
    Motion ride(const std::string& lift, const std::string& storey) {
        return begin("RIDE " + lift + " " + storey);
    }
    /// Sets a constant speed, m/s, negative backward; keeps the rotation.
    void speed(double metres_per_second) { ask("SPEED " + textOf(metres_per_second)); }
    /// Sets a constant rotation, degrees/s, counter-clockwise; keeps the speed.
    void rotspeed(double degrees_per_second) { ask("ROTSPEED " + textOf(degrees_per_second)); }
    /// Sets a constant speed to the left, m/s: of people, and of robots with an omnidirectional
    /// drive.
    void sidespeed(double metres_per_second) { ask("SIDESPEED " + textOf(metres_per_second)); }
    /// Brakes.
    void stop() { ask("STOP"); }

    Status status() {
        const Fields fields = ask("STATUS").fields;
        Status status;
        status.time = fields.number("t");
        status.pose = poseOf(fields);
        status.speed = fields.number("speed");
        status.rotspeed = fields.number("rotspeed");
        status.accel = fields.number("accel");
        status.rotaccel = fields.number("rotaccel");
        status.stall = fields.flag("stall");
        status.storey = fields.text("storey", "");
        status.passage = fields.text("in", "");
        status.fields = fields;
        return status;
    }

    /// Waits for the end of a motion of this client; stores other ends until they are requested.
    /// \param timeout seconds of wall time \throws Timeout
    End wait(const Motion& motion, double timeout = std::numeric_limits<double>::infinity()) {
        const Deadline deadline(timeout);
        for (;;) {
            const auto found = ends_.find(motion.id);
            if (found != ends_.end()) {
                const End end = found->second;
                ends_.erase(found);
                return end;
            }
            const int left = deadline.left();
            Message message;
            const double seconds = left < 0 ? timeout : left / 1000.0;
            if (!connection_.nextEnd(message, seconds))
                throw Timeout(id_ + " is still moving (motion " + std::to_string(motion.id) + ")");
            keepEnd(message);
        }
    }
    /// True if the server has reported the end of a motion; wait() then returns at once.
    bool ended(const Motion& motion) {
        Message message;
        while (connection_.nextEnd(message, 0)) keepEnd(message);
        return ends_.count(motion.id) > 0;
    }

    /// For requests without a function in this class.
    Connection& connection() { return connection_; }

  protected:
    Mover(const std::string& role, const Address& address, const std::string& id,
          const Options& options)
        : connection_(address, options), id_(id) {
        info_ = ask(role + " " + id).fields;
    }
    ~Mover() = default;

    Message ask(const std::string& request) { return connection_.ask(request); }
    static Pose poseOf(const Fields& fields) {
        Pose pose;
        pose.x = fields.number("x");
        pose.y = fields.number("y");
        pose.heading = fields.number("heading");
        return pose;
    }

  private:
    Motion begin(const std::string& request) {
        const Fields fields = ask(request).fields;
        Motion motion;
        motion.id = static_cast<int>(fields.integer("id"));
        if (fields.has("length")) motion.length = fields.number("length");
        return motion;
    }

    void keepEnd(const Message& message) {
        End end;
        end.id = static_cast<int>(message.fields.integer("id"));
        end.done = message.word(0) == "DONE";
        end.reason = message.fields.text("reason", "");
        end.time = message.fields.number("t");
        ends_[end.id] = end;
        // Bounded: most ends are never requested.
        if (ends_.size() > 10000) ends_.erase(ends_.begin());
    }

    Connection connection_;
    std::string id_;
    Fields info_;
    std::map<int, End> ends_;
};

/// A person, driven as a robot is (role PERSON).
class Person : public Mover {
  public:
    Person(const Address& address, const std::string& id, const Options& options = Options())
        : Mover("PERSON", address, id, options) {}
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_MOVER_H
