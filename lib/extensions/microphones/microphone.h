// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/microphones: microphones, which report the level of the sound of speakers.
// Uses sense and below.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/shared_list.h"

namespace ispace {

struct SensorKind;

}  // namespace ispace

namespace ispace::microphones {

/// A speaker that sounds: a point from which sound spreads evenly.
struct SoundSource {
    Point3 at;
    double volume = 0;  ///< sound pressure level at a metre, dB
    friend bool operator==(const SoundSource&, const SoundSource&) = default;
};

/// A microphone that reports the sound pressure level. It hears in all directions.
struct Microphone {
    std::string model;                ///< "" for the bare microphone
    double floor = 30, max = 120;     ///< dB: its own noise, and the loudest sound that it reports
    double loss = 30;                 ///< dB that a wall takes
    double sigma = 0;                 ///< dB, standard deviation of a reading
    double rate = 10;                 ///< readings a second
    double max_range = 0;             ///< it covers no floor
    SharedList<SoundSource> sources;  ///< of the scene

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    /// Walls between stop a ray each.
    [[nodiscard]] std::size_t rays() const { return 1 + 8 * sources.size(); }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return true; }
    [[nodiscard]] bool isNoisy() const { return sigma > 0; }
    static const SensorKind kKind;
    friend bool operator==(const Microphone&, const Microphone&) = default;
};

/// Returns `base` with the parameters that a `microphone` record writes, without sources; the model
/// stays. \throws FormatError with all findings
Microphone withParameters(Microphone base, const Record& record);

/// Adds the kind, for the program.
void addMicrophones();

}  // namespace ispace::microphones
