// SPDX-License-Identifier: GPL-3.0-or-later
// Motes: nodes that report light and the motes that they hear.
#ifndef ISPACE_CLIENT_MOTE_H
#define ISPACE_CLIENT_MOTE_H

#include <string>
#include <vector>

#include <ispace_client/error.h>
#include <ispace_client/sensor.h>

namespace ispace {
namespace client {

/// The light on a mote, and the motes that it hears.
struct MoteReport : Reading {
    double lux = 0;                       ///< whole
    std::vector<std::string> neighbours;  ///< ids
    std::vector<double> margins;          ///< of each: dB above the weakest signal that is heard

    static MoteReport from(const Message& message) {
        MoteReport reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        reading.lux = reading.fields.number("lux");
        reading.neighbours = reading.fields.list("neighbours");
        reading.margins = reading.fields.numbers("margins");
        if (reading.neighbours.size() != reading.margins.size())
            throw ProtocolError("a reading of " + reading.sensor + " is incomplete");
        return reading;
    }
};

using Mote = SensorOf<MoteReport>;

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_MOTE_H
