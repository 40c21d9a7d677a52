// SPDX-License-Identifier: GPL-3.0-or-later
// Pressure mats and light gates: sensors on the floor, which detect the movers on or between them
// and cast no rays. Metres; the states are MatState and GateState in sense/reading.h.
#pragma once

#include <cstddef>
#include <string>

#include "geom/polygon.h"
#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

struct SensorKind;

/// A sensor on the floor that detects movers on or over it. It has no rays.
struct FloorSensor {
    std::string model;  ///< always ""
    double rate = 10;   ///< readings a second
    double max_range = 0;
    Pose2 pose;

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] static std::size_t rays() { return 0; }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return false; }
    [[nodiscard]] static bool isNoisy() { return false; }
    friend bool operator==(const FloorSensor&, const FloorSensor&) = default;
};

/// A pressure mat.
struct Mat : FloorSensor {
    double half_length = 0, half_width = 0;
    static const SensorKind kKind;
    friend bool operator==(const Mat&, const Mat&) = default;
};

/// A light gate: a level beam between two posts. The pose is that of the middle; `in` is the
/// direction of the heading.
struct Gate : FloorSensor {
    double half_width = 0;
    double height = 0;  ///< of the beam: lower movers pass below it

    /// Returns the posts, the left one first.
    [[nodiscard]] Segment2 beam() const {
        return {pose * Point2{0, half_width}, pose * Point2{0, -half_width}};
    }
    static const SensorKind kKind;
    friend bool operator==(const Gate&, const Gate&) = default;
};

/// Reads the parameters of a `mat` or a `gate` record, except for the pose.
Mat matOf(const Record& record);
Gate gateOf(const Record& record);

}  // namespace ispace
