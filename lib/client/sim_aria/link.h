// SPDX-License-Identifier: GPL-3.0-or-later
// Private to sim_aria: the dialogue of ArRobot with simrun. Turns metres and degrees a second into
// the whole numbers of a Pioneer's packets.
#ifndef SIM_ARIA_LINK_H
#define SIM_ARIA_LINK_H

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <ispace_client/robot.h>
#include <ispace_client/sensor.h>
#include <ispace_client/world.h>
#include <sim_aria/math.h>
#include <sim_aria/util.h>

namespace sim_aria {

/// Contents of a status packet, in ARIA's units.
struct Packet {
    double time = 0;     ///< simulated seconds
    ArPose pose;         ///< odometry since the connection, mm and degrees
    double vel = 0;      ///< whole mm/s
    double rot_vel = 0;  ///< degrees/s
    bool stalled = false;
    std::vector<int> sonar;  ///< mm, 5000 without an echo
    int bumpers = 0;         ///< bits of ArRobot::getStallValue
};

/// One robot of simrun in ARIA's units. Functions throw ispace::client::Error.
///
/// Rounding is a Pioneer's: positions and speeds in whole mm and mm/s, headings in 4096ths of a
/// turn, rates in tenths of a degree a second, sonars in whole mm up to 5000. Poses begin at 0, 0,
/// 0 with the connection, whatever the robot drove before.
class Link {
  public:
    /// Takes the first robot that no other client drives: of the variable ISPACE_ROBOT ("r1,r2"),
    /// or else of the whole world.
    Link(const std::string& server, double timeout) : server_(server) {
        ispace::client::Options& options = options_;
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
        limits_ = robot_->limits();
        start_ = robot_->odometry().pose;
        findSonars();
        findBumpers();
    }

    std::string id() const { return robot_->id(); }
    std::string model() const { return robot_->info().text("model", ""); }
    double radius() const { return 1000 * robot_->info().number("radius"); }
    double maxVel() const { return 1000 * limits_.max_speed; }
    double maxRotVel() const { return limits_.max_rotspeed; }
    double accel() const { return 1000 * limits_.accel; }
    double rotAccel() const { return limits_.rotaccel; }
    int frontBumpers() const { return front_bumpers_; }
    int rearBumpers() const { return rear_bumpers_; }
    /// Poses of the sonars, mm and degrees in the robot's frame.
    const std::vector<ArPose>& sonars() const { return sonars_; }

    Packet read(bool sonar) {
        const ispace::client::Odometry odometry = robot_->odometry();
        Packet packet;
        packet.time = odometry.time;
        const ispace::client::Pose at = sinceStart(odometry.pose);
        // A Pioneer counts whole millimetres, and 4096 parts of a turn.
        packet.pose.setPose(std::round(1000 * at.x), std::round(1000 * at.y),
                            std::round(at.heading * 4096 / 360) * 360 / 4096);
        packet.vel = std::round(1000 * odometry.speed);
        packet.rot_vel = std::round(10 * odometry.rotspeed) / 10;
        packet.stalled = robot_->status().stall;
        // Bumpers are released before a stall.
        if (packet.stalled && !bits_.empty()) packet.bumpers = bumpersHit();
        if (sonar && !sonars_.empty()) {
            for (const ispace::client::Sonar& sonar : robot_->sonar())
                packet.sonar.push_back(sonar.range < 5 ? ArMath::roundInt(1000 * sonar.range)
                                                       : 5000);
        }
        return packet;
    }

    /// Ids of the lasers on the robot.
    std::vector<std::string> lasers() {
        std::vector<std::string> ids;
        const std::vector<std::string> all =
            ispace::client::World(server_, options_).list()["lasers"];
        for (const std::string& id : all) {
            try {
                scan(id);
                ids.push_back(id);
            } catch (const ispace::client::Refused&) {
                // in the room, or on another robot
            }
        }
        return ids;
    }
    /// Newest scan of a laser on the robot, m and degrees.
    ispace::client::Scan scan(const std::string& laser) { return robot_->scan(laser); }
    /// Figures of a laser, see the role LASER.
    ispace::client::Fields laser(const std::string& id) {
        return ispace::client::LaserSensor(server_, id, options_).info();
    }

    /// Pose of a laser on the robot, mm and degrees.
    ArPose mount(const std::string& id) {
        const ispace::client::Fields figures = laser(id);
        if (!figures.has("mount")) return ArPose();
        const std::vector<double> at = figures.numbers("mount");
        if (at.size() != 6) throw ispace::client::ProtocolError("a mount of other than 6 numbers");
        return ArPose(1000 * at[0], 1000 * at[1], at[3]);
    }

    /// True pose in the room, whole mm and degrees.
    ArPose truePose() {
        const ispace::client::Pose at = robot_->status().pose;
        return ArPose(std::round(1000 * at.x), std::round(1000 * at.y), std::round(at.heading));
    }
    /// Moves the robot there: it stands, and odometry does not change. Throws Refused where it
    /// would overlap a body.
    void place(const ArPose& to) {
        ispace::client::World world(server_, options_);
        const ispace::client::Pose before = sinceStart(robot_->odometry().pose);
        const std::string x = ispace::client::textOf(to.getX() / 1000),
                          y = ispace::client::textOf(to.getY() / 1000);
        world.set(id(), "at", x + "," + y);
        startSince(before);
        world.set(id(), "heading", ispace::client::textOf(to.getTh()));
        startSince(before);
    }

    /// mm/s
    void vel(double value) { robot_->speed(value / 1000); }
    /// degrees/s
    void rotVel(double value) { robot_->rotspeed(value); }
    void stop() { robot_->stop(); }
    /// Brakes, and releases the robot before it returns.
    void close() {
        robot_->stop();
        robot_->connection().quit();
    }

  private:
    static constexpr int kHeld = 409;

    /// An odometry relative to that at the connection.
    ispace::client::Pose sinceStart(const ispace::client::Pose& now) const {
        const double c = ArMath::cos(-start_.heading), s = ArMath::sin(-start_.heading);
        const double x = now.x - start_.x, y = now.y - start_.y;
        ispace::client::Pose pose;
        pose.x = c * x - s * y;
        pose.y = s * x + c * y;
        pose.heading = ArMath::fixAngle(now.heading - start_.heading);
        return pose;
    }

    /// The server's odometry has begun anew, and this is the one to report.
    void startSince(const ispace::client::Pose& reported) {
        start_ = robot_->odometry().pose;
        start_.heading -= reported.heading;
        const double c = ArMath::cos(start_.heading), s = ArMath::sin(start_.heading);
        start_.x -= c * reported.x - s * reported.y;
        start_.y -= s * reported.x + c * reported.y;
    }

    void findSonars() {
        try {
            for (const ispace::client::Sonar& sonar : robot_->sonar())
                sonars_.push_back(
                    ArPose(1000 * sonar.place.x, 1000 * sonar.place.y, sonar.place.heading));
        } catch (const ispace::client::Refused&) {
            // no sonars
        }
    }

    /// Numbers the bumpers as a Pioneer does, clockwise: front ones in bits 9 to 15, rear ones in 1
    /// to 7.
    void findBumpers() {
        std::vector<ispace::client::Bumper> rim;
        try {
            rim = robot_->rim();
        } catch (const ispace::client::Refused&) {
            // no bumpers
        }
        std::vector<std::pair<double, std::size_t>> front, rear;
        for (std::size_t i = 0; i < rim.size(); ++i) {
            const double middle = ArMath::fixAngle((rim[i].from + rim[i].to) / 2);
            if (std::fabs(middle) <= 90)
                front.emplace_back(-middle, i);
            else
                rear.emplace_back(middle < 0 ? -(middle + 360) : -middle, i);
        }
        bits_.assign(rim.size(), 0);
        front_bumpers_ = number(front, ArUtil::BIT9);
        rear_bumpers_ = number(rear, ArUtil::BIT1);
    }
    /// \param side less the middle of each bumper, and its index
    int number(std::vector<std::pair<double, std::size_t>>& side, int bit) {
        constexpr std::size_t kMaxBumpers = 7;
        std::sort(side.begin(), side.end());
        if (side.size() > kMaxBumpers) side.resize(kMaxBumpers);
        for (const auto& bumper : side) {
            bits_[bumper.second] = bit;
            bit *= 2;
        }
        return static_cast<int>(side.size());
    }
    int bumpersHit() {
        const std::vector<bool> hit = robot_->bumpers();
        int bits = 0;
        for (std::size_t i = 0; i < hit.size() && i < bits_.size(); ++i)
            if (hit[i]) bits |= bits_[i];
        return bits;
    }

    std::string server_;
    ispace::client::Options options_;
    std::unique_ptr<ispace::client::Robot> robot_;
    ispace::client::Pose start_;
    std::vector<ArPose> sonars_;
    std::vector<int> bits_;  // bit of each bumper
    int front_bumpers_ = 0, rear_bumpers_ = 0;
    ispace::client::Limits limits_;
};

}  // namespace sim_aria

#endif  // SIM_ARIA_LINK_H
