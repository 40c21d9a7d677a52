// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of SensorKind that several kinds share, those of extensions too.
//
// They require functions beside the parameters: withParameters(Parameters, const Record&), and
// fieldOfView(const Parameters&, const Pose3&).
//
//     const SensorKind Sonar::kKind = {.keyword = "sonar", .read = readModel<Sonar>, /* ... */};
#pragma once

#include <utility>

#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

template <typename Parameters>
SensorModel readModel(const Record& record, const Record* device) {
    return modelOf(parametersOf<Parameters>(record, device));
}

/// Changes the parameters of a model by `change`, a function of a reference to them.
template <typename Parameters, typename Change>
void changeModel(SensorModel& model, Change change) {
    Parameters parameters = *tryModel<Parameters>(model);
    change(parameters);
    model = modelOf(std::move(parameters));
}

template <typename Parameters>
FieldOfView fieldOfViewOf(const Sensor& sensor) {
    return fieldOfView(sensor.as<Parameters>(), sensor.pose);
}

/// The bearings of a sensor that sees an interval of `fov_x` about its axis.
template <typename Parameters>
BearingSpan windowBearings(const SensorModel& model) {
    const auto& window = *tryModel<Parameters>(model);
    return {-0.5 * window.fov_x, 0.5 * window.fov_x, window.max_range};
}

/// The surface of such a field of view, with elevations of `fov_y`.
template <typename Parameters>
Mesh windowViewOf(const Sensor& sensor, double reach) {
    const auto& window = sensor.as<Parameters>();
    return windowView(window.fov_x, window.fov_y,
                      viewLimits(window.min_range, window.max_range, reach));
}

}  // namespace ispace
