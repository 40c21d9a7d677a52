// SPDX-License-Identifier: GPL-3.0-or-later
// The list of kinds: their parameters, and their rows in the table of sensor.h in the same order.
#pragma once

#include <cstddef>
#include <variant>

#include "scene/sensor/camera.h"
#include "scene/sensor/contact.h"
#include "scene/sensor/floor_sensor.h"
#include "scene/sensor/laser.h"
#include "scene/sensor/pir.h"
#include "scene/sensor/radar.h"
#include "scene/sensor/ranger.h"
#include "scene/sensor/ultrasound.h"

namespace ispace {

/// Parameters of a sensor of any kind. Only this header, the sources of the kinds and the
/// computation of readings distinguish kinds.
using SensorModel =
    std::variant<Laser, Ranger, Receiver, Tag, Camera, Radar, Pir, Contact, Mat, Gate>;

/// The rows, sorted as the alternatives of SensorModel. Reports list kinds in this order.
inline constexpr const SensorKind* kSensorKinds[] = {
    &kLaserKind, &kRangerKind, &kUltrasoundKind, &kTagKind, &kCameraKind,
    &kRadarKind, &kPirKind,    &kContactKind,    &kMatKind, &kGateKind};
/// Number of the last kinds that lie on the floor.
inline constexpr std::size_t kFloorKinds = 2;
/// The order in which manuals list their records.
inline constexpr const SensorKind* kManualOrder[] = {&kLaserKind,      &kRangerKind, &kCameraKind,
                                                     &kUltrasoundKind, &kTagKind,    &kRadarKind,
                                                     &kPirKind,        &kContactKind};

}  // namespace ispace
