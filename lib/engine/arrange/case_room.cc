// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/case_room.h"

#include <utility>

#include "arrange/objective.h"

namespace ispace {

CaseRoom::CaseRoom(Scene in, const ArrangeOptions& options, std::size_t room, std::size_t number)
    : scene(std::move(in)),
      worlds(scene.environment),
      sight(scene.environment, options.plane, &worlds),
      errors(options.cases->errorsIn(scene.environment, room, number)) {
    for (Sensor& sensor : scene.sensors) {
        limitCovered(sensor.model, options);
        sensor = mounted(std::move(sensor));
    }
}

Sensor CaseRoom::mounted(Sensor sensor) const {
    if (errors != nullptr && !sensor.mount && !sensor.person) sensor.pose = errors->actual(sensor);
    return sensor;
}

}  // namespace ispace
