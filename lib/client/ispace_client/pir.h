// SPDX-License-Identifier: GPL-3.0-or-later
// Passive infrared sensors.
//
//     Pir pir("127.0.0.1:7001", "hall-pir");
//     pir.stream();
//     while (!pir.next(60).motion) {
//     }
#ifndef ISPACE_CLIENT_PIR_H
#define ISPACE_CLIENT_PIR_H

#include <ispace_client/sensor.h>

namespace ispace {
namespace client {

/// The output of a passive infrared sensor: a switch, without number or place of the people.
struct Presence : Reading {
    bool motion = false;  ///< people move in its sight, or did within the hold time

    static Presence from(const Message& message) {
        Presence reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        reading.motion = reading.fields.flag("motion");
        return reading;
    }
};

using Pir = SensorOf<Presence>;

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_PIR_H
