// SPDX-License-Identifier: GPL-3.0-or-later
// Weights on floors, beds and chairs: kilograms in sum, newtons by cell.
#ifndef ISPACE_CLIENT_FLOOR_H
#define ISPACE_CLIENT_FLOOR_H

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <ispace_client/connection.h>

namespace ispace {
namespace client {

/// A reading of a floor_sensor or a seat_sensor.
struct Pressure {
    std::string sensor;
    double time = 0;    ///< seconds
    double weight = 0;  ///< kilograms
    bool is_occupied = false;
    std::size_t columns = 0, rows = 0;  ///< of a floor
    std::map<std::size_t, double>
        cells;  ///< newtons by index, row * columns + column; others feel 0
};

/// Floors, beds and chairs of a room that feel weights (role FLOOR).
///
///     Floor floor("127.0.0.1:7001");
///     floor.watch();
///     for (Pressure reading; floor.nextReading(reading, 60);) draw(reading.cells);
class Floor {
  public:
    /// \param sensors those that it reads, a pattern of ids
    explicit Floor(const Address& address, const std::string& sensors = "*",
                   const Options& options = Options())
        : connection_(address, options) {
        sensors_ = split(connection_.ask("FLOOR " + sensors).fields.text("sensors", ""), ',');
    }
    Floor(const Floor&) = delete;
    Floor& operator=(const Floor&) = delete;

    /// Returns the ids of the sensors that it reads.
    const std::vector<std::string>& sensors() const { return sensors_; }

    /// Returns the newest reading of a sensor.
    Pressure read(const std::string& id) {
        return pressureOf(connection_.ask("READ " + id).fields);
    }
    /// Hears each reading of all sensors from now on.
    void watch() { connection_.ask("WATCH"); }
    void unwatch() { connection_.ask("UNWATCH"); }

    /// Waits for the next reading. \returns false after `timeout` seconds of wall time
    bool nextReading(Pressure& reading, double timeout) {
        Message message;
        while (connection_.nextEvent(message, timeout)) {
            if (message.word(1) != "floor") continue;
            reading = pressureOf(message.fields);
            return true;
        }
        return false;
    }

  private:
    static Pressure pressureOf(const Fields& fields) {
        Pressure reading;
        reading.sensor = fields.text("id");
        reading.time = fields.number("t");
        reading.weight = fields.number("weight");
        reading.is_occupied = fields.text("occupied") == "1";
        reading.columns = countOf(fields.text("columns", "0"));
        reading.rows = countOf(fields.text("rows", "0"));
        for (const std::string& cell : split(fields.text("cells", ""), ',')) {
            const std::size_t colon = cell.find(':');
            if (colon == std::string::npos) throw ProtocolError("the server sent `" + cell + "`");
            reading.cells[countOf(cell.substr(0, colon))] = numberOf(cell.substr(colon + 1));
        }
        return reading;
    }

    Connection connection_;
    std::vector<std::string> sensors_;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_FLOOR_H
