// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of sensors as values. Metres, degrees and simulated seconds; an infinite range is no
// return.
//
//     const Scan scan = LaserSensor("127.0.0.1:7001", "l1").scan();
//     for (std::size_t i = 0; i < scan.ranges.size(); ++i)
//         if (std::isfinite(scan.ranges[i])) draw(scan.angle_min + i * scan.step, scan.ranges[i]);
#ifndef ISPACE_CLIENT_READING_H
#define ISPACE_CLIENT_READING_H

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <ispace_client/message.h>

namespace ispace {
namespace client {

/// Common part of all readings; used alone for a sensor of any kind. Readings are values: they do
/// not refer to the connection. from() throws ProtocolError for a message that is incomplete.
struct Reading {
    std::string sensor;  ///< id
    double time = 0;     ///< simulated seconds
    long seq = 0;        ///< number of the reading; gaps show missed readings
    Fields fields;
    std::string data;  ///< bytes of the frame, if any

    static Reading from(const Message& message) {
        Reading reading;
        reading.sensor = message.word(1);
        reading.time = message.fields.number("t");
        reading.seq = message.fields.integer("seq");
        reading.fields = message.fields;
        reading.data = message.data;
        return reading;
    }
    /// Returns the sensor's pose in the room, from `pose=x,y,z,heading,tilt,roll`.
    Pose3 pose() const {
        const std::vector<double> v = fields.numbers("pose");
        if (v.size() != 6)
            throw ProtocolError("a pose of " + std::to_string(v.size()) + " numbers");
        Pose3 pose;
        pose.x = v[0], pose.y = v[1], pose.z = v[2];
        pose.heading = v[3], pose.tilt = v[4], pose.roll = v[5];
        return pose;
    }
    /// Converts the data from little-endian float32, on a host of any byte order; drops a rest of
    /// less than four bytes.
    std::vector<float> floats() const {
        std::vector<float> values(data.size() / 4);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::uint32_t bits = byte(4 * i) | byte(4 * i + 1) << 8U |
                                       byte(4 * i + 2) << 16U | byte(4 * i + 3) << 24U;
            std::memcpy(&values[i], &bits, sizeof bits);
        }
        return values;
    }
    std::uint32_t byte(std::size_t i) const { return static_cast<unsigned char>(data[i]); }
};

/// One scan of a laser, in its own frame. It is of one moment, unless the laser spins: then `time`
/// is that of the beam which is measured first.
struct Scan : Reading {
    double angle_min = 0, angle_max = 0,
           step = 0;            ///< degrees, counter-clockwise from straight ahead
    std::vector<float> ranges;  ///< m; infinity: no return

    double angle(std::size_t k) const { return angle_min + static_cast<double>(k) * step; }

    static Scan from(const Message& message) {
        Scan scan;
        static_cast<Reading&>(scan) = Reading::from(message);
        scan.angle_min = scan.fields.number("angle_min");
        scan.angle_max = scan.fields.number("angle_max");
        scan.step = scan.fields.number("step");
        if (scan.fields.has("r")) {
            for (const double range : scan.fields.numbers("r"))
                scan.ranges.push_back(static_cast<float>(range));
        } else {
            scan.ranges = scan.floats();
        }
        if (static_cast<long>(scan.ranges.size()) != scan.fields.integer("n"))
            throw ProtocolError("a scan of " + scan.sensor + " has " +
                                std::to_string(scan.ranges.size()) +
                                " ranges, says n=" + scan.fields.text("n"));
        return scan;
    }
};

/// A camera's picture, or a ranger's depths as a picture.
struct Picture : Reading {
    std::string format;  ///< png, jpeg or rgb (8 bits each, rows from the top)
    int width = 0, height = 0;

    static Picture from(const Message& message) {
        Picture picture;
        static_cast<Reading&>(picture) = Reading::from(message);
        picture.format = picture.fields.text("format");
        picture.width = static_cast<int>(picture.fields.integer("width"));
        picture.height = static_cast<int>(picture.fields.integer("height"));
        return picture;
    }
};

/// Depths of a ranger (formats depth32 and depth16), rows from the top: along its axis, or, if its
/// projection is spherical, distances.
struct Depths : Reading {
    int width = 0, height = 0;
    std::vector<float> depths;  ///< m; infinity: no return

    float at(int column, int row) const {
        return depths.at(static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(column));
    }

    static Depths from(const Message& message) {
        Depths frame;
        static_cast<Reading&>(frame) = Reading::from(message);
        frame.width = static_cast<int>(frame.fields.integer("width"));
        frame.height = static_cast<int>(frame.fields.integer("height"));
        const std::string& format = frame.fields.text("format");
        if (format == "depth32") {
            frame.depths = frame.floats();
        } else if (format == "depth16") {
            for (std::size_t i = 0; i + 1 < frame.data.size(); i += 2) {
                const std::uint32_t mm = frame.byte(i) | frame.byte(i + 1) << 8U;
                frame.depths.push_back(mm == 0 ? std::numeric_limits<float>::infinity()
                                               : static_cast<float>(mm) / 1000.0F);
            }
        } else {
            throw ProtocolError("depths come as depth32 or depth16, found " + format);
        }
        if (static_cast<long>(frame.depths.size()) != static_cast<long>(frame.width) * frame.height)
            throw ProtocolError("a frame of " + frame.sensor + " is incomplete");
        return frame;
    }
};

/// A point for each pixel of a ranger (format cloud), in the sensor's frame: x ahead, y left, z up;
/// metres, NaN without return.
struct Cloud : Reading {
    struct Point3 {
        float x = 0, y = 0, z = 0;
    };
    std::vector<Point3> points;

    static Cloud from(const Message& message) {
        Cloud cloud;
        static_cast<Reading&>(cloud) = Reading::from(message);
        const std::vector<float> values = cloud.floats();
        for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
            Point3 point;
            point.x = values[i], point.y = values[i + 1], point.z = values[i + 2];
            cloud.points.push_back(point);
        }
        return cloud;
    }
};

/// Times of flight from each tag to an ultrasonic receiver. The speed of sound is
/// 331.3 + 0.606 T m/s at T degrees Celsius, see scan(1).
struct Burst : Reading {
    std::vector<std::string> tags;
    std::vector<double> times_of_flight;  ///< s, in the order of tags; infinity: not heard

    static Burst from(const Message& message) {
        Burst burst;
        static_cast<Reading&>(burst) = Reading::from(message);
        burst.tags = burst.fields.list("tags");
        burst.times_of_flight = burst.fields.numbers("tof");
        if (burst.times_of_flight.size() != burst.tags.size())
            throw ProtocolError("a burst of " + burst.sensor + " has " +
                                std::to_string(burst.times_of_flight.size()) + " times for " +
                                std::to_string(burst.tags.size()) + " tags");
        return burst;
    }
};

/// Position of a tag computed from the receivers.
struct Fix : Reading {
    int heard = 0;        ///< receivers that heard it
    bool solved = false;  ///< false: too few receivers; the figures are 0
    /// Position in the room, and the root mean square of measured less computed distances, m.
    double x = 0, y = 0, z = 0, residual = 0;

    static Fix from(const Message& message) {
        Fix fix;
        static_cast<Reading&>(fix) = Reading::from(message);
        fix.heard = static_cast<int>(fix.fields.integer("heard"));
        fix.solved = fix.fields.text("x") != "-";
        if (fix.solved) {
            fix.x = fix.fields.number("x");
            fix.y = fix.fields.number("y");
            fix.z = fix.fields.number("z");
            fix.residual = fix.fields.number("residual");
        }
        return fix;
    }
};

/// People with a leg on a mat, and robots with their body above it.
struct Load : Reading {
    std::vector<std::string> on;  ///< ids

    static Load from(const Message& message) {
        Load load;
        static_cast<Reading&>(load) = Reading::from(message);
        load.on = load.fields.list("on");
        return load;
    }
};

/// Movers that have passed a gate since the start of the run, along its heading (in) or against it.
/// A mover counts when its centre crosses the line; one lower than the beam does not.
struct Passages : Reading {
    long in = 0, out = 0;
    std::string last;     ///< id of the last one; empty: no passage yet
    std::string way;      ///< its way, in or out
    bool broken = false;  ///< the beam is interrupted now

    static Passages from(const Message& message) {
        Passages passages;
        static_cast<Reading&>(passages) = Reading::from(message);
        passages.in = passages.fields.integer("in");
        passages.out = passages.fields.integer("out");
        passages.last = passages.fields.text("last");
        if (passages.last == "-") passages.last.clear();
        passages.way = passages.fields.text("way");
        if (passages.way == "-") passages.way.clear();
        passages.broken = passages.fields.flag("broken");
        return passages;
    }
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_READING_H
