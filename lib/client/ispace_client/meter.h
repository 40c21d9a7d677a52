// SPDX-License-Identifier: GPL-3.0-or-later
// Plugs that switch and meter appliances: watts and kilowatt-hours.
#ifndef ISPACE_CLIENT_METER_H
#define ISPACE_CLIENT_METER_H

#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// A reading of a plug.
struct MeterReading {
    std::string plug;
    double time = 0;  ///< seconds
    bool is_on = false;
    double power = 0;   ///< watts
    double energy = 0;  ///< kWh since the start of the run
};

/// Plugs of a room that meter appliances (role METER).
///
///     Meter meter("127.0.0.1:7001");
///     meter.watch();
///     for (MeterReading reading; meter.nextReading(reading, 60);) plot(reading.power);
class Meter {
  public:
    /// \param plugs those that it reads, a pattern of ids
    explicit Meter(const Address& address, const std::string& plugs = "*",
                   const Options& options = Options())
        : connection_(address, options) {
        plugs_ = split(connection_.ask("METER " + plugs).fields.text("plugs", ""), ',');
    }
    Meter(const Meter&) = delete;
    Meter& operator=(const Meter&) = delete;

    /// Returns the ids of the plugs that it reads.
    const std::vector<std::string>& plugs() const { return plugs_; }

    /// Returns the reading of a plug now.
    MeterReading read(const std::string& id) {
        return readingOf(connection_.ask("READ " + id).fields);
    }
    /// Hears each change of power or count of all plugs from now on.
    void watch() { connection_.ask("WATCH"); }
    void unwatch() { connection_.ask("UNWATCH"); }

    /// Waits for the next reading. \returns false after `timeout` seconds of wall time
    bool nextReading(MeterReading& reading, double timeout) {
        Message message;
        while (connection_.nextEvent(message, timeout)) {
            if (message.word(1) != "meter") continue;
            reading = readingOf(message.fields);
            return true;
        }
        return false;
    }

  private:
    static MeterReading readingOf(const Fields& fields) {
        MeterReading reading;
        reading.plug = fields.text("id");
        reading.time = fields.number("t");
        reading.is_on = fields.text("on") == "1";
        reading.power = fields.number("power");
        reading.energy = fields.number("energy");
        return reading;
    }

    Connection connection_;
    std::vector<std::string> plugs_;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_METER_H
