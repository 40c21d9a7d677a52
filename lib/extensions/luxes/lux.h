// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/luxes: light meters, which report the light of lamps and projectors on a spot.
// Uses sense and below.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "env/projector_beam.h"
#include "geom/pose.h"
#include "record/record.h"
#include "record/schema.h"
#include "scene/sensor/shared_list.h"

namespace ispace {

struct RoomRecords;
struct SensorKind;

}  // namespace ispace

namespace ispace::luxes {

/// A light meter: the illuminance by lamps and projectors at a spot that faces along its axis.
struct Lux {
    /// A lamp that is on.
    struct Light {
        Point2 at;
        double lumens = 0;
        Vec2 along{1, 0};  ///< unit vector along two of its sides
        friend bool operator==(const Light&, const Light&) = default;
    };

    std::string model;         ///< "" for the bare meter
    double max = 100'000;      ///< lux: greatest value that it reports
    double resolution = 0;     ///< lux, with noise; 0: exact
    double error = 0;          ///< spread of its constant factor, with noise
    double rate = 1;           ///< readings a second
    double max_range = 0;      ///< it covers no floor
    SharedList<Light> lights;  ///< of the scene
    SharedList<ProjectorBeam> beams;

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] std::size_t rays() const { return 16 * (1 + lights.size()) + beams.size(); }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return false; }
    [[nodiscard]] bool isNoisy() const { return resolution > 0 || error > 0; }
    static const SensorKind kKind;
    friend bool operator==(const Lux&, const Lux&) = default;
};

/// Returns `base` with the parameters that a `lux` record writes, without lights; the model stays.
Lux withParameters(Lux base, const Record& record);

/// Adds the keys `max`, `resolution` and `error`.
void addLightKeys(std::vector<KeySpec>& keys);
/// Looks up the lights of a room, lists that all its meters share.
void lookUpLights(Lux& lux, const RoomRecords& room);

/// Adds the kind, for the program.
void addLuxes();

}  // namespace ispace::luxes
