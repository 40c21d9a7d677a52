// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sense/depth.h"
#include "sense/photo.h"
#include "sense/scan.h"
#include "sense/ultrasound.h"
#include "sensor/sensor.h"
#include "sim/floor_sensors.h"
#include "sim/sim_time.h"

namespace ispace {

/// What a run reads: a sensor (tags too, whose bursts receivers hear), a mat or a gate, where it
/// is at the start.
struct RunSensor {
    std::string id;
    std::variant<Sensor, Mat, Gate> what;

    /// Null for mats and gates.
    [[nodiscard]] const Sensor* sensor() const { return std::get_if<Sensor>(&what); }
    /// Its model, if it is of that kind; else null.
    template <typename Model>
    [[nodiscard]] const Model* model() const {
        return sensor() == nullptr ? nullptr : std::get_if<Model>(&sensor()->model);
    }
    /// Of its records.
    [[nodiscard]] std::string_view keyword() const;
    /// Readings a second; of a swept laser single scans.
    [[nodiscard]] double rate() const;
    /// Depth frames and pictures: taken only if somebody wants them.
    [[nodiscard]] bool isHeavy() const;
    /// Where a mat or a gate lies. \pre sensor() is null
    [[nodiscard]] Pose3 floorPose() const;
    /// True if it is on this robot.
    [[nodiscard]] bool isOn(std::size_t robot) const;
};

/// What a receiver hears of one tag.
struct HeardTag {
    std::string tag;
    std::optional<double> time_of_flight;  ///< seconds; empty: not heard
};

/// What a receiver hears: all tags, in the order of the scene.
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
