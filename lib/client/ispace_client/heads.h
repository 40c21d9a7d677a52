// SPDX-License-Identifier: GPL-3.0-or-later
// Pan-tilt heads under cameras and lasers: degrees, to the left and upwards.
#ifndef ISPACE_CLIENT_HEADS_H
#define ISPACE_CLIENT_HEADS_H

#include <set>
#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// The angles of a head.
struct HeadReading {
    std::string head;
    double time = 0;           ///< seconds
    double pan = 0, tilt = 0;  ///< degrees, to the left and upwards
    bool is_moving = false;
};

/// Heads that pan and tilt the cameras and lasers on them (role HEAD).
///
///     Heads heads("127.0.0.1:7001");
///     heads.turn("neck", 45, -10);
///     heads.wait("neck", 60);
class Heads {
  public:
    /// \param heads those that it turns, a pattern of ids
    explicit Heads(const Address& address, const std::string& heads = "*",
                   const Options& options = Options())
        : connection_(address, options) {
        heads_ = split(connection_.ask("HEAD " + heads).fields.text("heads", ""), ',');
    }
    Heads(const Heads&) = delete;
    Heads& operator=(const Heads&) = delete;

    /// Returns the ids of the heads.
    const std::vector<std::string>& heads() const { return heads_; }

    /// Turns a head to these angles, degrees, at its speed. Returns the seconds that it takes.
    double turn(const std::string& head, double pan, double tilt) {
        const Message answer =
            connection_.ask("TURN " + head + ' ' + textOf(pan) + ' ' + textOf(tilt));
        // Events before the answer are of earlier turns.
        Message event;
        while (connection_.storedEvent(event)) note(event);
        turned_.erase(head);
        return answer.fields.number("for");
    }
    /// Stops a head where it is.
    void halt(const std::string& head) { connection_.ask("HALT " + head); }
    /// Returns the angles of a head now.
    HeadReading read(const std::string& head) {
        const Message message = connection_.ask("READ " + head);
        const Fields& fields = message.fields;
        HeadReading reading;
        reading.head = fields.text("id");
        reading.time = fields.number("t");
        reading.pan = fields.number("pan");
        reading.tilt = fields.number("tilt");
        reading.is_moving = fields.text("moving") == "1";
        return reading;
    }
    /// Waits until the last turn of a head has ended. \returns false after `timeout` seconds of
    /// wall time
    bool wait(const std::string& head, double timeout) {
        Message event;
        while (turned_.erase(head) == 0) {
            if (!connection_.nextEvent(event, timeout)) return false;
            note(event);
        }
        return true;
    }

  private:
    void note(const Message& event) {
        if (event.word(1) == "turned") turned_.insert(event.fields.text("id"));
    }

    std::set<std::string> turned_;  // heads whose last turn has ended, before wait()
    Connection connection_;
    std::vector<std::string> heads_;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_HEADS_H
