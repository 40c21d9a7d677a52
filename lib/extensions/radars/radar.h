// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/radars: millimetre-wave radars, which detect robots and people that move. Uses
// sense and below.
//
// A reading is a function of pose, time, frame and seed alone, thread-safe; it costs a few rays for
// each mover in the field of view.
//
//     addRadars();                                        // before the first scene is read
//     const Sensor sensor = sensorsOf<Radar>(scene).front();
//     const double least = sensor.as<Radar>().min_speed;  // m/s, along the line of sight
#pragma once

#include <cstddef>
#include <string>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

struct SensorKind;

}  // namespace ispace

namespace ispace::radars {

/// A millimetre-wave radar that reports movers: frequency-modulated, with antennas in both
/// directions, such as the modules at 60 GHz. Its own filter removes the echoes of the room.
struct Radar {
    std::string model;  ///< "" for the bare radar
    double min_range = 0, max_range = 9;
    Angle fov_x = Angle::degrees(120), fov_y = Angle::degrees(60);  ///< full angles
    double rate = 10;                                               ///< readings a second
    int detections = 64;                                            ///< at most in a reading
    /// Radial speeds in m/s: slower movers count as the room; speeds are known modulo twice the
    /// maximum (0: in full).
    double min_speed = 0.1, max_speed = 0;
    /// Movers that differ by less than these, and by less than noise.resolution in range, are one
    /// detection. 0: all are told apart.
    Angle angle_resolution;
    double speed_resolution = 0;  ///< m/s; with noise, speeds are whole multiples of it
    double speed_sigma = 0;       ///< m/s, standard deviation of a radial speed
    RangeNoise noise;             ///< angle_sigma counts for bearing and elevation

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] std::size_t rays() const { return static_cast<std::size_t>(detections); }
    [[nodiscard]] bool isNoisy() const {
        return speed_sigma > 0 || speed_resolution > 0 || !noise.isNone();
    }
    [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const {
        return fov_x >= Angle::degrees(360) && mount.isLevel();
    }
    static const SensorKind kKind;
    friend bool operator==(const Radar&, const Radar&) = default;
};

/// Returns `base` with the parameters that a `radar` record writes; the model stays. One number in
/// `fov` keeps the other angle. \throws FormatError with all findings
Radar withParameters(Radar base, const Record& record);

/// Returns true if it detects a person in view, by the radial speed.
/// \param velocity m/s over the floor \param direction unit vector from the radar to the person
bool senses(const Radar& radar, Vec2 velocity, Vec3 direction);

/// Returns the field of view at a pose, without occlusion: intervals of bearings and elevations.
FieldOfView fieldOfView(const Radar& radar, const Pose3& pose);

/// Adds the kind, for the program.
void addRadars();

}  // namespace ispace::radars
