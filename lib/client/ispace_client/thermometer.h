// SPDX-License-Identifier: GPL-3.0-or-later
// Thermometers.
//
//     const double celsius = Thermometer("127.0.0.1:7001", "t1").scan().celsius;
#ifndef ISPACE_CLIENT_THERMOMETER_H
#define ISPACE_CLIENT_THERMOMETER_H

#include <ispace_client/sensor.h>

namespace ispace {
namespace client {

/// The temperature of a zone.
struct Temperature : Reading {
    double celsius = 0;  ///< degrees Celsius, rounded to 0.1

    static Temperature from(const Message& message) {
        Temperature reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        reading.celsius = reading.fields.number("celsius");
        return reading;
    }
};

using Thermometer = SensorOf<Temperature>;

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_THERMOMETER_H
