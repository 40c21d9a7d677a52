// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef SIM_ARIA_LINK_H
#define SIM_ARIA_LINK_H

#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <ispace_client/robot.h>
#include <ispace_client/world.h>
#include <sim_aria/math.h>

namespace sim_aria {

/// What a status packet tells, in ARIA's units.
struct Packet {
    ArPose pose;         ///< odometry since the connection, mm and degrees
    double vel = 0;      ///< whole mm/s
    double rot_vel = 0;  ///< degrees/s
    bool stalled = false;
    std::vector<int> sonar;  ///< mm, 5000 without an echo
};

/// One robot of simrun in ARIA's units. Functions throw ispace::client::Error.
class Link {
  public:
    /// The robots of the variable ISPACE_ROBOT ("r1,r2"), or else all of the world: the first that
    /// nobody else drives.
    Link(const std::string& server, double timeout) {
        ispace::client::Options options;
        options.timeout = timeout;
        const char* const wanted = std::getenv("ISPACE_ROBOT");
        const std::vector<std::string> ids =
            wanted ? ispace::client::split(wanted, ',')
                   : ispace::client::World(server, options).list()["robots"];
        for (const std::string& id : ids) {
            try {
                robot_.reset(new ispace::client::Robot(server, id, options));
                break;
            } catch (const ispace::client::Refused& refused) {
                if (refused.code() != kHeld) throw;
            }
        }
        if (!robot_) throw ispace::client::Error(server + " has no robot that is free");
        max_vel_ = 1000 * limitOf("SPEED");
        max_rot_vel_ = limitOf("ROTSPEED");
        start_ = robot_->odometry().pose;
        findSonars();
    }

    std::string id() const { return robot_->id(); }
    std::string model() const { return robot_->info().text("model", ""); }
    double radius() const { return 1000 * robot_->info().number("radius"); }
    double maxVel() const { return max_vel_; }
    double maxRotVel() const { return max_rot_vel_; }
    /// Where its sonars sit, mm and degrees in its own frame.
    const std::vector<ArPose>& sonars() const { return sonars_; }

    Packet read(bool sonar) {
        const ispace::client::Odometry odometry = robot_->odometry();
        Packet packet;
        const double c = ArMath::cos(-start_.heading), s = ArMath::sin(-start_.heading);
        const double x = 1000 * (odometry.pose.x - start_.x),
                     y = 1000 * (odometry.pose.y - start_.y);
        packet.pose.setPose(c * x - s * y, s * x + c * y, odometry.pose.heading - start_.heading);
        packet.vel = std::round(1000 * odometry.speed);
        packet.rot_vel = odometry.rotspeed;
        packet.stalled = robot_->status().stall;
        if (sonar && !sonars_.empty()) {
            for (const ispace::client::Sonar& sonar : robot_->sonar())
                packet.sonar.push_back(sonar.range < 5 ? ArMath::roundInt(1000 * sonar.range)
                                                       : 5000);
        }
        return packet;
    }

    /// mm/s
    void vel(double value) { robot_->speed(value / 1000); }
    /// degrees/s
    void rotVel(double value) { robot_->rotspeed(value); }
    void stop() { robot_->stop(); }
    /// Brakes, and frees it before this returns.
    void close() {
        robot_->stop();
        robot_->connection().quit();
    }

  private:
    static constexpr int kHeld = 409;

    /// What the server says when it refuses far too much: "r1 goes at most 1.6 m/s".
    double limitOf(const std::string& verb) {
        const std::string before = " at most ";
        try {
            robot_->connection().ask(verb + " 1000000000");
        } catch (const ispace::client::Refused& refused) {
            const std::string text = refused.what();
            const std::size_t found = text.find(before);
            if (found == std::string::npos) throw;
            const std::size_t begin = found + before.size();
            return ispace::client::numberOf(text.substr(begin, text.find(' ', begin) - begin));
        }
        throw ispace::client::ProtocolError(id() + " has no limit of " + verb);
    }

    void findSonars() {
        try {
            for (const ispace::client::Sonar& sonar : robot_->sonar())
                sonars_.push_back(
                    ArPose(1000 * sonar.place.x, 1000 * sonar.place.y, sonar.place.heading));
        } catch (const ispace::client::Refused&) {
            // It has none.
        }
    }

    std::unique_ptr<ispace::client::Robot> robot_;
    ispace::client::Pose start_;
    std::vector<ArPose> sonars_;
    double max_vel_ = 0, max_rot_vel_ = 0;
};

}  // namespace sim_aria

#endif  // SIM_ARIA_LINK_H
