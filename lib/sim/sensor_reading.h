// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/sensor/sensor.h"
#include "sense/depth.h"
#include "sense/photo.h"
#include "sense/scan.h"
#include "sense/ultrasound.h"
#include "sim/robot_sensors.h"
#include "sim/sim_time.h"

namespace ispace {

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

/// A sensor that a run reads: one of the scene (including tags, whose bursts receivers hear), a mat
/// or a gate, with its start pose.
struct RunSensor {
    std::string id;
    std::variant<Sensor, Mat, Gate> what;

    /// Returns null for mats and gates.
    [[nodiscard]] const Sensor* sensor() const { return std::get_if<Sensor>(&what); }
    /// Returns its model if it is of that kind, else null.
    template <typename Model>
    [[nodiscard]] const Model* model() const {
        return sensor() == nullptr ? nullptr : std::get_if<Model>(&sensor()->model);
    }
    /// Returns the keyword of its records.
    [[nodiscard]] std::string_view keyword() const;
    /// Returns readings per second; of a swept laser, single scans.
    [[nodiscard]] double rate() const;
    /// Returns true for rangers and cameras: they are read only on request.
    [[nodiscard]] bool isHeavy() const;
    /// Returns the pose of a mat or a gate. \pre sensor() is null
    [[nodiscard]] Pose3 floorPose() const;
    /// Returns true if this robot carries it.
    [[nodiscard]] bool isOn(std::size_t robot) const;
};

/// Signal of one tag at a receiver.
struct HeardTag {
    std::string tag;
    std::optional<double> time_of_flight;  ///< seconds; empty: not heard
};

/// Signals at a receiver: all tags, in the order of the scene.
struct Hearings {
    std::vector<HeardTag> tags;
};

/// The latest reading of a sensor. Times within it are that of its step; frames count periods
/// from 0.
struct SensorReading {
    SimTime time{};
    std::int64_t seq = 0;  ///< of the period
    Pose3 pose;            ///< of the sensor at that time
    /// By kind: laser, ranger, camera, tag, ultrasound, mat, gate.
    std::variant<Scan, DepthFrame, Photo, Burst, Hearings, MatState, GateState> value;

    /// \pre it is a laser's
    [[nodiscard]] const Scan& scan() const { return std::get<Scan>(value); }
};

}  // namespace ispace
