// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of kinds that extensions add, behind one type: a value that the kind's `measure`
// returned, and its time and pose. Copies copy the value.
//
//     const int entered = reading.as<DoorCount>().entered;
#pragma once

#include <any>

#include "sense/moment.h"

namespace ispace {

struct ReadingKind;

/// A reading of a sensor of a kind that an extension adds.
struct AddedReading {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;
    const SensorKind* kind = nullptr;
    std::any value = {};  ///< what SensorKind::measure returned

    /// \pre the value has this type
    template <typename Value>
    [[nodiscard]] const Value& as() const {
        return *std::any_cast<Value>(&value);
    }
    template <typename Value>
    [[nodiscard]] Value& as() {
        return *std::any_cast<Value>(&value);
    }
    static const ReadingKind kKind;  ///< of no reading: a row for the list of kinds
};

/// SensorKind::measure of a kind with a function `VALUE readingOf(const Parameters&, const
/// Moment&)`.
template <typename Parameters>
std::any measureBy(const Moment& now) {
    return readingOf(now.sensor.as<Parameters>(), now);
}

/// Measures by SensorKind::measure.
AddedReading readingOf(const AddedSensor& sensor, const Moment& now);

/// Continues from an earlier reading by SensorKind::follow.
void follow(const AddedReading& before, AddedReading& now);

}  // namespace ispace
