// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors of a room or on a robot: one class template, and a name for each kind.
#ifndef ISPACE_CLIENT_SENSOR_H
#define ISPACE_CLIENT_SENSOR_H

#include <string>

#include <ispace_client/connection.h>
#include <ispace_client/reading.h>

namespace ispace {
namespace client {

/// A sensor of the room or on a robot; shared by any number of clients. T is its reading. The
/// constructor throws as Connection does, and Refused (404) for an unknown id; a reading that lacks
/// what T holds is a ProtocolError.
///
/// Frames of cameras and rangers are computed on request, and scan() blocks until they are. In real
/// time the world goes on meanwhile and skips frames; all other clocks wait for the frame.
///
///     Camera camera("127.0.0.1:7001", "c1");
///     camera.stream();
///     for (;;) show(camera.next(1).data);
template <class T>
class SensorOf {
  public:
    SensorOf(const Address& address, const std::string& id, const Options& options = Options())
        : SensorOf("SENSOR", address, id, options) {}
    SensorOf(const SensorOf&) = delete;
    SensorOf& operator=(const SensorOf&) = delete;

    const std::string& id() const { return id_; }
    /// The server's description: kind, rate, and the figures of its kind.
    const Fields& info() const { return info_; }

    /// Returns the newest reading, up to a period old.
    T scan() { return T::from(connection_.ask("SCAN")); }

    /// Starts a stream: the server sends each new reading with a number divisible by `every`; a
    /// slow client receives the newest.
    void stream(int every = 1) { connection_.ask("STREAM every=" + std::to_string(every)); }
    /// Returns the next reading of the stream.
    /// \param timeout seconds of wall time
    /// \throws Timeout
    T next(double timeout) {
        Message message;
        if (!connection_.nextScan(message, timeout)) throw Timeout("no reading of " + id_);
        return T::from(message);
    }
    T next() { return next(connection_.options().timeout); }
    /// Ends the stream; drops readings under way.
    void stop() {
        connection_.ask("STOP");
        connection_.dropScans();
    }

    /// Selects frames as bytes after their line, or as text in it. The library reads both; bytes
    /// are several times as fast, and the ranges of a laser's text are whole millimetres.
    void binary(bool on) { connection_.ask(on ? "BINARY on" : "BINARY off"); }
    /// Cameras: png, jpeg, rgb. Rangers: depth32, depth16, cloud, png.
    void format(const std::string& name) { connection_.ask("FORMAT " + name); }

    /// For requests without a function in this class.
    Connection& connection() { return connection_; }

  protected:
    SensorOf(const std::string& role, const Address& address, const std::string& id,
             const Options& options)
        : connection_(address, options), id_(id) {
        info_ = connection_.ask(role + " " + id).fields;
    }

  private:
    Connection connection_;
    std::string id_;
    Fields info_;
};

/// A sensor of any kind, see Reading::fields.
using Sensor = SensorOf<Reading>;
using Camera = SensorOf<Picture>;
/// A ranger in the formats depth32 and depth16.
using Ranger = SensorOf<Depths>;
using Ultrasound = SensorOf<Burst>;
using Tag = SensorOf<Fix>;
using Mat = SensorOf<Load>;
using Gate = SensorOf<Passages>;

/// A ranger that returns points.
class CloudSensor : public SensorOf<Cloud> {
  public:
    CloudSensor(const Address& address, const std::string& id, const Options& options = Options())
        : SensorOf<Cloud>(address, id, options) {
        format("cloud");
    }
};

/// A laser range finder (role LASER). Requests scans as bytes unless binary(false) is called.
class LaserSensor : public SensorOf<Scan> {
  public:
    LaserSensor(const Address& address, const std::string& id, const Options& options = Options())
        : SensorOf<Scan>("LASER", address, id, options) {
        binary(true);
    }
    double rangeMin() const { return info().number("range_min"); }  ///< m
    double rangeMax() const { return info().number("range_max"); }  ///< m
    double rate() const { return info().number("rate"); }           ///< scans per simulated second
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_SENSOR_H
