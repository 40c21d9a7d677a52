// SPDX-License-Identifier: GPL-3.0-or-later
// The list of kinds, from which the tables of all folders follow.
//
//     const SensorModel model = modelOf(Laser());
//     if (const Laser* const laser = tryModel<Laser>(model)) beams += laser->beams;
#pragma once

#include <type_traits>
#include <utility>
#include <variant>

#include "scene/sensor/added_sensor.h"
#include "scene/sensor/camera.h"
#include "scene/sensor/floor_sensor.h"
#include "scene/sensor/laser.h"
#include "scene/sensor/ranger.h"
#include "scene/sensor/ultrasound.h"

namespace ispace {

/// Parameters of a sensor of any kind; those on the floor are last. Reports and manuals list kinds
/// in this order, and behind them those that extensions add, in the order in which they are added.
/// Only this header, the sources of the kinds and the computation of readings distinguish kinds.
using SensorModel = std::variant<Laser, Ranger, Receiver, Tag, Camera, AddedSensor, Mat, Gate>;

/// True for parameters in the list, false for those of a kind that an extension adds.
template <typename Model, typename Models = SensorModel>
constexpr bool kIsListedKind = false;
template <typename Model, typename... Models>
constexpr bool kIsListedKind<Model, std::variant<Models...>> = (std::is_same_v<Model, Models> ||
                                                                ...);

/// Returns parameters of any kind as a model.
template <typename Model>
SensorModel modelOf(Model parameters) {
    if constexpr (kIsListedKind<Model>)
        return parameters;
    else
        return AddedSensor(std::move(parameters));
}
/// Returns the parameters of a model; null for another kind.
template <typename Model>
const Model* tryModel(const SensorModel& model) {
    if constexpr (kIsListedKind<Model>) {
        return std::get_if<Model>(&model);
    } else {
        const auto* const added = std::get_if<AddedSensor>(&model);
        return added == nullptr ? nullptr : added->tryAs<Model>();
    }
}

}  // namespace ispace
