// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/added_reading.h"

namespace ispace {

AddedReading readingOf(const AddedSensor& sensor, const Moment& now) {
    const SensorKind& kind = sensor.kind();
    AddedReading reading{.time = now.time, .frame = now.frame, .pose = now.pose, .kind = &kind};
    if (kind.measure != nullptr) reading.value = kind.measure(now);
    return reading;
}

void follow(const AddedReading& before, AddedReading& now) {
    if (before.kind != now.kind || now.kind->follow == nullptr) return;
    now.kind->follow(before, now);
}

}  // namespace ispace
