// SPDX-License-Identifier: GPL-3.0-or-later
// The list of kinds, from which the tables of all folders follow.
#pragma once

#include <variant>

#include "scene/sensor/camera.h"
#include "scene/sensor/contact.h"
#include "scene/sensor/floor_sensor.h"
#include "scene/sensor/imu.h"
#include "scene/sensor/laser.h"
#include "scene/sensor/lux.h"
#include "scene/sensor/microphone.h"
#include "scene/sensor/mote.h"
#include "scene/sensor/pir.h"
#include "scene/sensor/radar.h"
#include "scene/sensor/ranger.h"
#include "scene/sensor/rfid.h"
#include "scene/sensor/thermometer.h"
#include "scene/sensor/ultrasound.h"
#include "scene/sensor/uwb.h"

namespace ispace {

/// Parameters of a sensor of any kind; those on the floor are last. Reports and manuals list kinds
/// in this order. Only this header, the sources of the kinds and the computation of readings
/// distinguish kinds.
using SensorModel = std::variant<Laser, Ranger, Receiver, Tag, Camera, Radar, Pir, Contact, Rfid,
                                 Uwb, Microphone, Lux, Imu, Mote, Thermometer, Mat, Gate>;

}  // namespace ispace
