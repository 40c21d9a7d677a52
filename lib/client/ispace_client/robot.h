// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef ISPACE_CLIENT_ROBOT_H
#define ISPACE_CLIENT_ROBOT_H

#include <string>
#include <vector>

#include <ispace_client/mover.h>
#include <ispace_client/reading.h>

namespace ispace {
namespace client {

/// A robot (role ROBOT).
class Robot : public Mover {
  public:
    Robot(const Address& address, const std::string& id, const Options& options = Options())
        : Mover("ROBOT", address, id, options) {}

    /// The newest scan of a laser that rides on it.
    Scan scan(const std::string& laser) { return reading<Scan>(laser); }
    /// The newest reading of a sensor that rides on it; T is Picture, Depths … or Reading of any
    /// kind.
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
    /// Ranges of its ring of sonars, m; infinity: no echo.
    std::vector<double> sonar() { return ask("SONAR").fields.numbers("r"); }
    /// Which of its bumpers are pressed.
    std::vector<bool> bumpers() {
        std::vector<bool> hit;
        for (const double value : ask("BUMPER").fields.numbers("hit")) hit.push_back(value != 0);
        return hit;
    }
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_ROBOT_H
