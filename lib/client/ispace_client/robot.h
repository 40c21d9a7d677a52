// SPDX-License-Identifier: GPL-3.0-or-later
// Robots: motions of a mover, and the sonars, bumpers, lasers and odometry on board.
//
//     Robot robot("127.0.0.1:7001", "r1");
//     robot.wait(robot.forward(1.5));
//     if (robot.status().stall) robot.wait(robot.left(90));
#ifndef ISPACE_CLIENT_ROBOT_H
#define ISPACE_CLIENT_ROBOT_H

#include <string>
#include <vector>

#include <ispace_client/mover.h>
#include <ispace_client/reading.h>

namespace ispace {
namespace client {

/// One of the sonars of a robot.
struct Sonar {
    Pose place;        ///< pose on the robot: m, degrees, in the robot's frame
    double range = 0;  ///< m; infinity: no echo
};

/// One of the bumpers of a robot.
struct Bumper {
    double from = 0, to = 0;  ///< bearings of its ends, degrees, counter-clockwise
    bool hit = false;
};

/// A robot (role ROBOT). Its constructor throws Refused: 404 for an unknown id, 409 while another
/// client drives it.
class Robot : public Mover {
  public:
    Robot(const Address& address, const std::string& id, const Options& options = Options())
        : Mover("ROBOT", address, id, options) {}

    /// Returns the newest scan of a laser on the robot.
    Scan scan(const std::string& laser) { return reading<Scan>(laser); }
    /// Returns the newest reading of a sensor on the robot; T is Picture, Depths … or Reading for
    /// any kind.
    template <class T>
    T reading(const std::string& sensor) {
        return T::from(ask("SCAN " + sensor));
    }

    Odometry odometry() {
        const Fields fields = ask("ODOMETRY").fields;
        Odometry odometry;
        odometry.time = fields.number("t");
        odometry.pose = poseOf(fields);
        odometry.speed = fields.number("speed");
        odometry.rotspeed = fields.number("rotspeed");
        return odometry;
    }
    /// Reads the sonars; empty for a robot without sonars.
    std::vector<Sonar> sonar() {
        const Fields fields = ask("SONAR").fields;
        std::vector<Sonar> ring;
        for (const std::string& place : split(fields.text("at"), ';')) {
            const std::vector<std::string> parts = split(place, ',');
            if (parts.size() != 3) throw ProtocolError("`" + place + "` is no place of a sonar");
            Sonar sonar;
            sonar.place.x = numberOf(parts[0]);
            sonar.place.y = numberOf(parts[1]);
            sonar.place.heading = numberOf(parts[2]);
            ring.push_back(sonar);
        }
        const std::vector<double> ranges = fields.numbers("r");
        if (ranges.size() != ring.size()) throw ProtocolError("sonars without ranges");
        for (std::size_t i = 0; i < ring.size(); ++i) ring[i].range = ranges[i];
        return ring;
    }
    /// Returns the state of each bumper: true if pressed.
    std::vector<bool> bumpers() {
        std::vector<bool> hit;
        for (const Bumper& bumper : rim()) hit.push_back(bumper.hit);
        return hit;
    }
    /// Returns the bumpers and their states; empty for a robot without bumpers.
    std::vector<Bumper> rim() {
        const Fields fields = ask("BUMPER").fields;
        std::vector<Bumper> rim;
        for (const std::string& place : split(fields.text("at"), ';')) {
            const std::vector<std::string> parts = split(place, ',');
            if (parts.size() != 2) throw ProtocolError("`" + place + "` is no place of a bumper");
            Bumper bumper;
            bumper.from = numberOf(parts[0]);
            bumper.to = numberOf(parts[1]);
            rim.push_back(bumper);
        }
        const std::vector<double> hit = fields.numbers("hit");
        if (hit.size() != rim.size()) throw ProtocolError("bumpers without places");
        for (std::size_t i = 0; i < rim.size(); ++i) rim[i].hit = hit[i] != 0;
        return rim;
    }
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_ROBOT_H
