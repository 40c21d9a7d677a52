// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors of smart rooms: inertia, tags in the field of an RFID reader, light and sound.
#ifndef ISPACE_CLIENT_SMART_ROOM_H
#define ISPACE_CLIENT_SMART_ROOM_H

#include <string>
#include <vector>

#include <ispace_client/error.h>
#include <ispace_client/sensor.h>

namespace ispace {
namespace client {

/// Rates and accelerations of an inertial measurement unit, about and along its axes x, y, z.
struct Inertia : Reading {
    std::vector<double> rates;          ///< three, degrees a second
    std::vector<double> accelerations;  ///< three, m/s^2, with gravity

    static Inertia from(const Message& message) {
        Inertia reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        reading.rates = reading.fields.numbers("rates");
        reading.accelerations = reading.fields.numbers("accelerations");
        if (reading.rates.size() != 3 || reading.accelerations.size() != 3)
            throw ProtocolError("a reading of " + reading.sensor + " is incomplete");
        return reading;
    }
};

/// The tags in the field of an RFID reader.
struct TagList : Reading {
    std::vector<std::string> tags;  ///< texts, sorted

    static TagList from(const Message& message) {
        TagList reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        reading.tags = reading.fields.list("tags");
        return reading;
    }
};

/// The light at a spot.
struct Illuminance : Reading {
    double lux = 0;  ///< whole

    static Illuminance from(const Message& message) {
        Illuminance reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        reading.lux = reading.fields.number("lux");
        return reading;
    }
};

/// The sound at a microphone.
struct SoundLevel : Reading {
    double level = 0;  ///< sound pressure level, dB, in tenths

    static SoundLevel from(const Message& message) {
        SoundLevel reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        reading.level = reading.fields.number("level");
        return reading;
    }
};

using Imu = SensorOf<Inertia>;
using Rfid = SensorOf<TagList>;
using Lux = SensorOf<Illuminance>;
using Microphone = SensorOf<SoundLevel>;

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_SMART_ROOM_H
