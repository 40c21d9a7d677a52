// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef ISPACE_CLIENT_SENSOR_H
#define ISPACE_CLIENT_SENSOR_H

#include <string>

#include <ispace_client/connection.h>
#include <ispace_client/reading.h>

namespace ispace {
namespace client {

/// A sensor of the room or on a robot; any number of clients may read one. T is what it reads.
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
    /// What the server said of it: kind, rate, and the figures of its kind.
    const Fields& info() const { return info_; }

    /// The newest reading, up to a period old.
    T scan() { return T::from(connection_.ask("SCAN")); }

    /// From now on the server sends every new reading whose number is a multiple of `every`; a
    /// client that does not keep up gets the newest.
    void stream(int every = 1) { connection_.ask("STREAM every=" + std::to_string(every)); }
    /// The next reading of the stream.
    /// \param timeout seconds of wall time
    /// \throws Timeout
    T next(double timeout) {
        Message message;
        if (!connection_.nextScan(message, timeout)) throw Timeout("no reading of " + id_);
        return T::from(message);
    }
    T next() { return next(connection_.options().timeout); }
    /// Ends the stream; readings that are on their way are dropped.
    void stop() {
        connection_.ask("STOP");
        connection_.dropScans();
    }

    /// Whether frames come as bytes behind their line, or as text in it. Both are understood; bytes
    /// are several times as fast.
    void binary(bool on) { connection_.ask(on ? "BINARY on" : "BINARY off"); }
    /// Cameras: png, jpeg, rgb. Rangers: depth32, depth16, cloud, png.
    void format(const std::string& name) { connection_.ask("FORMAT " + name); }

    /// For requests that this class has no function for.
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

/// Of any kind, see Reading::fields.
using Sensor = SensorOf<Reading>;
using Camera = SensorOf<Picture>;
/// In the formats depth32 and depth16.
using Ranger = SensorOf<Depths>;
using Ultrasound = SensorOf<Burst>;
using Tag = SensorOf<Fix>;
using Mat = SensorOf<Load>;
using Gate = SensorOf<Passages>;

/// A ranger whose points are wanted.
class CloudSensor : public SensorOf<Cloud> {
  public:
    CloudSensor(const Address& address, const std::string& id, const Options& options = Options())
        : SensorOf<Cloud>(address, id, options) {
        format("cloud");
    }
};

/// A laser range finder (role LASER). Its scans come as bytes unless binary(false) says otherwise.
class LaserSensor : public SensorOf<Scan> {
  public:
    LaserSensor(const Address& address, const std::string& id, const Options& options = Options())
        : SensorOf<Scan>("LASER", address, id, options) {
        binary(true);
    }
    double rangeMin() const { return info().number("range_min"); }  ///< m
    double rangeMax() const { return info().number("range_max"); }  ///< m
    double rate() const { return info().number("rate"); }           ///< scans a simulated second
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_SENSOR_H
