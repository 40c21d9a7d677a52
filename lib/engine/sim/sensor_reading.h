// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of a running world, and the periods in which sensors are read.
//
//     const Periods periods(30);
//     const SimTime second = periods.begin(1);          // 33 333 334 ns: the first in period 1
//     const std::int64_t k = periods.newest(second);    // 1
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "scene/sensor/sensor.h"
#include "sense/reading.h"
#include "sim/sim_time.h"

namespace ispace {

struct ReadingView;

/// Computes the periods of a sensor: period k begins at k / rate seconds, in exact arithmetic. A
/// rate with up to nine decimals counts as written, any other as the double it is.
class Periods {
  public:
    /// \pre rate > 0
    explicit Periods(double rate);
    /// Returns the latest period that has begun.
    [[nodiscard]] std::int64_t newest(SimTime time) const;
    /// Returns the first nanosecond of period k; a time beyond any run if that is after a hundred
    /// years.
    [[nodiscard]] SimTime begin(std::int64_t k) const;

  private:
    // Periods per nanosecond, as a fraction; a numerator of 0: only the first period.
    __int128 numerator_ = 0, denominator_ = 1;
};

/// Returns the periods per second: of a swept laser, single scans.
double periodRate(const Sensor& sensor);
/// Returns true for rangers and cameras: they are read only on request.
bool isHeavy(const Sensor& sensor);

/// The latest reading of a sensor. Times within it are that of its step; frames count periods
/// from 0.
struct SensorReading {
    SimTime time{};
    std::int64_t seq = 0;  ///< of the period
    Pose3 pose;            ///< of the sensor at that time
    ReadingValue value;

    /// \pre it is a laser's
    [[nodiscard]] const Scan& scan() const { return std::get<Scan>(value); }
};

/// Returns a view of a reading for its fields, see reading_fields.h.
ReadingView viewOf(const Sensor& sensor, const SensorReading& reading,
                   std::span<const Sensor> receivers = {});

}  // namespace ispace
