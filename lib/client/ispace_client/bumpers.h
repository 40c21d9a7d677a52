// SPDX-License-Identifier: GPL-3.0-or-later
// Impacts of robots on bumpers that measure forces: newtons, metres a second.
#ifndef ISPACE_CLIENT_BUMPERS_H
#define ISPACE_CLIENT_BUMPERS_H

#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// A robot has run into something, or another mover into it.
struct Impact {
    std::string bumper, robot;
    std::string into;  ///< the thing, robot or person
    double time = 0;   ///< seconds
    double force = 0;  ///< N
    double speed = 0;  ///< across the surfaces that meet, m/s
};

/// Bumpers of robots that measure forces (role BUMPER).
///
///     Bumpers bumpers("127.0.0.1:7001");
///     for (Impact impact; bumpers.nextImpact(impact, 60);) log(impact.force);
class Bumpers {
  public:
    /// \param bumpers those that it hears of, a pattern of ids
    explicit Bumpers(const Address& address, const std::string& bumpers = "*",
                     const Options& options = Options())
        : connection_(address, options) {
        bumpers_ = split(connection_.ask("BUMPER " + bumpers).fields.text("bumpers", ""), ',');
    }
    Bumpers(const Bumpers&) = delete;
    Bumpers& operator=(const Bumpers&) = delete;

    /// Returns the ids of the bumpers.
    const std::vector<std::string>& bumpers() const { return bumpers_; }

    /// Returns the force of the contact of a bumper now, N; 0 without one.
    double force(const std::string& bumper) {
        return connection_.ask("READ " + bumper).fields.number("force");
    }
    /// Waits for the next impact. \returns false after `timeout` seconds of wall time
    bool nextImpact(Impact& impact, double timeout) {
        Message message;
        while (connection_.nextEvent(message, timeout)) {
            if (message.word(1) != "impact") continue;
            const Fields& fields = message.fields;
            impact.bumper = fields.text("id");
            impact.robot = fields.text("robot");
            impact.into = fields.text("into");
            impact.time = fields.number("t");
            impact.force = fields.number("force");
            impact.speed = fields.number("speed");
            return true;
        }
        return false;
    }

  private:
    Connection connection_;
    std::vector<std::string> bumpers_;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_BUMPERS_H
