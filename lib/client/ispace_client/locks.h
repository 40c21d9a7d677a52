// SPDX-License-Identifier: GPL-3.0-or-later
// Doors that open to tags, and their locks.
#ifndef ISPACE_CLIENT_LOCKS_H
#define ISPACE_CLIENT_LOCKS_H

#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// The state of a door with a lock.
struct LockReading {
    std::string door;
    double time = 0;  ///< seconds
    bool is_open = false, is_locked = false;
    bool is_forced = false;  ///< its lock is broken
};

/// Doors of a room that open to tags, for card readers and keypads (role LOCK).
///
///     Locks locks("127.0.0.1:7001");
///     if (!locks.show("front", "42")) alarm();
class Locks {
  public:
    /// \param doors those to which it shows tags, a pattern of ids
    explicit Locks(const Address& address, const std::string& doors = "*",
                   const Options& options = Options())
        : connection_(address, options) {
        doors_ = split(connection_.ask("LOCK " + doors).fields.text("doors", ""), ',');
    }
    Locks(const Locks&) = delete;
    Locks& operator=(const Locks&) = delete;

    /// Returns the ids of the doors.
    const std::vector<std::string>& doors() const { return doors_; }

    /// Shows a tag to a door. Returns true if it opens, for five seconds.
    bool show(const std::string& door, const std::string& tag) {
        return connection_.ask("TRY " + door + ' ' + tag).fields.text("opens") == "1";
    }
    /// Returns the state of a door now.
    LockReading read(const std::string& door) {
        const Message message = connection_.ask("READ " + door);
        const Fields& fields = message.fields;
        LockReading reading;
        reading.door = fields.text("id");
        reading.time = fields.number("t");
        reading.is_open = fields.text("open") == "1";
        reading.is_locked = fields.text("locked") == "1";
        reading.is_forced = fields.text("forced") == "1";
        return reading;
    }

  private:
    Connection connection_;
    std::vector<std::string> doors_;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_LOCKS_H
