// SPDX-License-Identifier: GPL-3.0-or-later
// Drives a robot of a running simrun to a goal among people, by one of some planners, as baselines
// for others:
//
//     simrun scenes/frontal.env --clock step --listen 127.0.0.1:7001 --record run &
//     social_planner orca 127.0.0.1:7001 robot 4,0
//
// goal: along the way round the walls, as if there were no people; dwa: dynamic window, by the
// laser alone; orca: optimal reciprocal collision avoidance, which also knows places and velocities
// of people in view. All three take the way from GOTO and aim at its points ahead. simrun: the
// motion of GOTO itself, which knows all places, as a reference. In a building the goal is
// STOREY/X,Y; a fifth word is the lift, LIFT=X,Y, with a place before its door.
//
// The laser of the robot has the id `eye`. The program leads a clock `step`, and keeps up with a
// clock `real`. Exit status: 0 at the goal, 1 error, 2 usage, 3 if the run ended before.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <ispace_client.h>

#include "plane.h"
#include "planners.h"

namespace {

using namespace social;
namespace client = ispace::client;

constexpr double kArrived = 0.3;    // metres from the goal
constexpr double kAhead = 1;        // metres of way to the aim
constexpr double kReplan = 2;       // seconds
constexpr double kBack = 1;         // seconds, after a collision
constexpr double kBackSpeed = 0.3;  // m/s
constexpr double kSight = 6;        // metres
constexpr double kPerson = 0.255;   // radius of a person of 1.7 m

using Planner = Drive (*)(const View&, const Body&);

double radians(double degrees) { return degrees * kPi / 180; }

/// "ground/1.5,2" or "1.5,2".
struct Place {
    std::string storey;
    client::Point at;
};
bool readPlace(std::string word, Place& place) {
    const std::size_t slash = word.find('/');
    if (slash != std::string::npos) {
        place.storey = word.substr(0, slash);
        word = word.substr(slash + 1);
    }
    char* end = nullptr;
    place.at.x = std::strtod(word.c_str(), &end);
    if (*end != ',') return false;
    const char* const rest = end + 1;
    place.at.y = std::strtod(rest, &end);
    return end != rest && *end == '\0';
}

/// Points of a way, and the progress along it.
class Way {
  public:
    void begin(Vec from, const std::vector<Vec>& points) {
        points_.assign(1, from);
        points_.insert(points_.end(), points.begin(), points.end());
    }
    /// Returns the point some metres ahead of the place on the way that is nearest to `from`.
    Vec ahead(Vec from, double metres, double& left) const {
        std::size_t leg = 0;
        double share = 0, least = -1;
        for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
            const Vec along = points_[i + 1] - points_[i];
            const double square = dot(along, along);
            const double t = square > 0 ? dot(from - points_[i], along) / square : 0;
            const double within = std::max(0.0, std::min(1.0, t));
            const double apart = length(points_[i] + within * along - from);
            if (least < 0 || rounded(apart) < rounded(least)) {
                least = apart;
                leg = i;
                share = within;
            }
        }
        Vec at = points_[leg] + share * (points_[leg + 1] - points_[leg]), aim = at;
        left = 0;
        for (std::size_t i = leg + 1; i < points_.size(); ++i) {
            const double piece = length(points_[i] - at);
            if (left < metres)
                aim = left + piece <= metres || piece == 0
                          ? points_[i]
                          : at + ((metres - left) / piece) * (points_[i] - at);
            left += piece;
            at = points_[i];
        }
        return aim;
    }

  private:
    std::vector<Vec> points_;
};

class Trip {
  public:
    Trip(const std::string& server, const std::string& robot, Planner planner)
        : world_(server), robot_(server, robot), planner_(planner) {
        const client::Limits limits = robot_.limits();
        body_.radius = robot_.info().number("radius");
        body_.speed = limits.speed;
        body_.turn = radians(limits.rotspeed);
        body_.accel = limits.accel;
        body_.turn_accel = radians(limits.rotaccel);
        const std::size_t slash = robot.find('/');
        eye_ = (slash == std::string::npos ? "" : robot.substr(0, slash + 1)) + "eye";
        steps_ = std::max(1L, std::lround(kInterval / world_.dt()));
    }

    /// Drives to a point of the robot's room.
    void driveTo(const client::Point& goal) {
        Way way;
        double planned = -kReplan, backs_until = 0;
        for (;;) {
            const client::Status status = robot_.status();
            View view;
            view.place = Vec(status.pose.x, status.pose.y);
            view.heading = radians(status.pose.heading);
            view.speed = status.speed;
            view.turn = radians(status.rotspeed);
            if (length(Vec(goal.x, goal.y) - view.place) < kArrived) break;
            if (status.time - planned >= kReplan - 1e-6) {
                way.begin(view.place, wayTo(goal));
                planned = status.time;
            }
            look(status, view);
            // The way keeps 5 cm from walls: a shorter look ahead keeps to it at corners.
            for (const double metres : {kAhead, 0.7, 0.4, 0.2}) {
                view.aim = way.ahead(view.place, metres, view.left);
                if (isFree(view)) break;
            }
            if (length(view.aim - view.place) < 1e-3) view.aim = Vec(goal.x, goal.y);
            // It backs off from what it has run into.
            if (status.stall && planner_ != goalOnly) backs_until = status.time + kBack;
            Drive drive = planner_(view, body_);
            if (status.time < backs_until) {
                drive.speed = -kBackSpeed;
                drive.turn = 0;
            }
            robot_.speed(std::round(drive.speed * 1000) / 1000);
            robot_.rotspeed(std::round(drive.turn * 180 / kPi * 100) / 100);
            wait();
        }
        robot_.stop();
    }

    /// Leaves the whole way to the simulator.
    void goTo(const Place& goal) {
        for (;;) {
            client::GoOptions options;
            options.storey = goal.storey;
            const client::Motion motion = robot_.goTo(goal.at, options);
            if (until(motion).done) break;
        }
    }

    /// Goes to another storey by a lift.
    void ride(const std::string& lift, const std::string& storey) {
        while (robot_.status().storey != storey || !robot_.status().passage.empty()) {
            const client::Motion motion = robot_.ride(lift, storey);
            until(motion);
        }
    }
    std::string storey() { return robot_.status().storey; }

  private:
    /// Asks the server for the way round the walls; the motion itself is replaced at once.
    std::vector<Vec> wayTo(const client::Point& goal) {
        const client::Fields fields =
            robot_.connection()
                .ask("GOTO " + client::textOf(goal.x) + "," + client::textOf(goal.y))
                .fields;
        std::vector<Vec> points;
        for (const std::string& item : client::split(fields.text("way", ""), ';')) {
            const std::vector<std::string> parts = client::split(item, ',');
            if (parts.size() == 2)
                points.push_back(Vec(client::numberOf(parts[0]), client::numberOf(parts[1])));
        }
        if (points.empty()) points.push_back(Vec(goal.x, goal.y));
        return points;
    }

    /// Returns true if what the laser sees, but for people, leaves the straight way to the aim.
    bool isFree(const View& view) const {
        const Vec way = view.aim - view.place;
        const double square = dot(way, way);
        for (const Vec point : view.points) {
            const Vec offset = point - view.place;
            const double t = square > 0 ? dot(offset, way) / square : 0;
            const double apart = length(std::max(0.0, std::min(1.0, t)) * way - offset);
            if (apart < std::min(body_.radius + 0.03, length(offset) - 0.005) &&
                !isOnPerson(view, point))
                return false;
        }
        return true;
    }

    /// Reads the laser, and the people that no wall hides.
    void look(const client::Status& status, View& view) {
        const client::Scan scan = robot_.scan(eye_);
        for (std::size_t k = 0; k < scan.ranges.size(); ++k)
            if (std::isfinite(scan.ranges[k]))
                view.points.push_back(view.place +
                                      static_cast<double>(scan.ranges[k]) *
                                          direction(view.heading + radians(scan.angle(k))));
        const client::Fields fields = world_.connection().ask("POSES").fields;
        const std::vector<std::string> rooms = client::split(fields.text("rooms", ""), ',');
        std::size_t at = client::split(fields.text("poses"), ';').size();
        std::map<std::string, Vec> seen;
        for (const std::string& item : client::split(fields.text("people", ""), ';')) {
            const bool is_here = rooms.empty() || rooms.at(at) == status.storey;
            ++at;
            const std::vector<std::string> parts = client::split(item, ',');
            if (parts.size() != 4 || !is_here) continue;
            const Vec place(client::numberOf(parts[1]), client::numberOf(parts[2]));
            const Vec offset = place - view.place;
            const double apart = length(offset);
            const double bearing = wrapped(angleOf(offset) - view.heading) * 180 / kPi;
            const std::size_t beam = static_cast<std::size_t>(
                std::max(0.0, std::min(std::round((bearing - scan.angle_min) / scan.step),
                                       static_cast<double>(scan.ranges.size()) - 1)));
            if (apart > kSight || static_cast<double>(scan.ranges[beam]) < apart - 2 * kPerson)
                continue;
            seen[parts[0]] = place;
            Neighbour one;
            one.place = place;
            one.radius = kPerson;
            const auto before = people_.find(parts[0]);
            if (before != people_.end() && status.time > seen_at_)
                one.velocity = (1 / (status.time - seen_at_)) * (place - before->second);
            view.people.push_back(one);
        }
        people_ = seen;
        seen_at_ = status.time;
    }

    /// Waits for the end of a motion.
    client::End until(const client::Motion& motion) {
        do {
            wait();
            // Its answer follows all that the server has said about earlier steps.
            robot_.status();
        } while (!robot_.ended(motion));
        return robot_.wait(motion);
    }
    void wait() {
        if (world_.clock() == "step") {
            if (world_.step(steps_) < steps_) throw client::ConnectionError("the run has ended");
        } else {
            std::this_thread::sleep_for(
                std::chrono::duration<double>(kInterval / std::max(1e-6, world_.rate())));
        }
    }

    client::World world_;
    client::Robot robot_;
    Planner planner_;
    Body body_;
    std::string eye_;
    long steps_ = 1;
    std::map<std::string, Vec> people_;
    double seen_at_ = 0;
};

int usage() {
    std::fputs(
        "usage: social_planner goal|dwa|orca|simrun HOST:PORT ROBOT [STOREY/]X,Y [LIFT=X,Y]\n",
        stderr);
    return 2;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5 || argc > 6) return usage();
    const std::map<std::string, Planner> planners = {
        {"goal", goalOnly}, {"dwa", dynamicWindow}, {"orca", reciprocal}, {"simrun", nullptr}};
    const auto planner = planners.find(argv[1]);
    Place goal, landing;
    std::string lift = argc > 5 ? argv[5] : "";
    const std::size_t equals = lift.find('=');
    if (planner == planners.end() || !readPlace(argv[4], goal)) return usage();
    if (argc > 5 && (equals == std::string::npos || !readPlace(lift.substr(equals + 1), landing)))
        return usage();
    try {
        Trip trip(argv[2], argv[3], planner->second);
        if (planner->second == nullptr) {
            trip.goTo(goal);
            return 0;
        }
        if (!goal.storey.empty() && trip.storey() != goal.storey) {
            if (lift.empty()) return usage();
            trip.driveTo(landing.at);
            trip.ride(lift.substr(0, equals), goal.storey);
        }
        trip.driveTo(goal.at);
    } catch (const client::ConnectionError&) {
        return 3;  // simrun reached the time of --until
    } catch (const std::exception& error) {
        std::fprintf(stderr, "social_planner: %s\n", error.what());
        return 1;
    }
    return 0;
}
