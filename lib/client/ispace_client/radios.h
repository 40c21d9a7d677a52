// SPDX-License-Identifier: GPL-3.0-or-later
// Texts between radios of robots, people and rooms.
#ifndef ISPACE_CLIENT_RADIOS_H
#define ISPACE_CLIENT_RADIOS_H

#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// A text that a radio has received.
struct RadioMessage {
    std::string radio, sender;
    double time = 0;    ///< seconds
    double margin = 0;  ///< how much stronger than the weakest signal that is received, dB
    std::string text;
};

/// Radios of robots, people and rooms (role RADIO): texts reach those of their kind and channel
/// within the range.
///
///     Radios base("127.0.0.1:7001", "base");
///     base.send("base", "go to 3,4");
class Radios {
  public:
    /// \param radios those that it sends from and hears, a pattern of ids
    explicit Radios(const Address& address, const std::string& radios = "*",
                    const Options& options = Options())
        : connection_(address, options) {
        radios_ = split(connection_.ask("RADIO " + radios).fields.text("radios", ""), ',');
    }
    Radios(const Radios&) = delete;
    Radios& operator=(const Radios&) = delete;

    /// Returns the ids of the radios.
    const std::vector<std::string>& radios() const { return radios_; }
    /// Returns how many messages of its radios it has missed: nextMessage() was called too rarely,
    /// or too many came in a step.
    long missed() const { return missed_; }

    /// Sends a text from a radio, at most 1000 bytes without line breaks.
    void send(const std::string& radio, const std::string& text) {
        connection_.ask("SEND " + radio + ' ' + text);
    }
    /// Returns how many messages a radio has received since the run began.
    int heard(const std::string& radio) {
        return static_cast<int>(connection_.ask("READ " + radio).fields.number("heard"));
    }
    /// Waits for the next message that one of its radios receives. \returns false after `timeout`
    /// seconds of wall time
    bool nextMessage(RadioMessage& received, double timeout) {
        Message message;
        while (connection_.nextEvent(message, timeout)) {
            const Fields& fields = message.fields;
            if (message.word(1) == "missed") missed_ += static_cast<long>(fields.number("n"));
            if (message.word(1) != "message") continue;
            received.radio = fields.text("id");
            received.sender = fields.text("from");
            received.time = fields.number("t");
            received.margin = fields.number("margin");
            received.text = fields.text("text", "");
            return true;
        }
        return false;
    }

  private:
    Connection connection_;
    std::vector<std::string> radios_;
    long missed_ = 0;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_RADIOS_H
