// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/uwbs: ultra-wideband anchors, which measure the ranges of tags and locate them.
// Uses sense and below.
//
// Anchors of a room share the lists of its tags and anchors. A reading is a function of pose, time,
// frame and seed alone, thread-safe; it costs at most O(slots) rays of ranges, and those of the
// positions, which the anchors of one moment compute once (uwb_ranges.h).
//
//     addUwbs();                                        // before the first scene is read
//     const Sensor sensor = sensorsOf<Uwb>(scene).front();
//     const double range = sensor.as<Uwb>().max_range;  // metres, in line of sight
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/electronic_tag.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/sensor/shared_list.h"

namespace ispace {

struct SensorKind;

}  // namespace ispace

namespace ispace::uwbs {

/// Anchors that locate a tag: those that have it in line of sight, at least.
constexpr std::size_t kMinAnchors = 3;

/// Tags that a bare anchor measures in a round, at most: an exchange takes a millisecond or two,
/// and ten rounds a second leave time for some dozens.
constexpr std::size_t kUwbSlots = 64;

/// The radio of an ultra-wideband anchor. It measures in all directions, and through walls.
struct UwbRadio {
    double min_range = 0, max_range = 50;  ///< in line of sight
    double loss = 6;                       ///< dB that each wall or mover between takes
    RangeNoise noise;                      ///< in line of sight: `bias`, `sigma`, `dropout`
    /// Added by each wall or mover between: the mean of the error, and its standard deviation.
    double blocked_bias = 0, blocked_sigma = 0;

    friend bool operator==(const UwbRadio&, const UwbRadio&) = default;
};

/// An anchor of the room that stands by itself, whose ranges locate tags.
struct UwbAnchor {
    std::string id;
    Pose3 pose;
    UwbRadio radio;
    friend bool operator==(const UwbAnchor&, const UwbAnchor&) = default;
};

/// An ultra-wideband anchor, which measures the ranges of tags.
struct Uwb : UwbRadio {
    std::string model;              ///< "" for the bare anchor
    double rate = 10;               ///< rounds a second
    std::size_t slots = kUwbSlots;  ///< tags that a round has time for; the nearest answer
    SharedList<ElectronicTag> tags;
    SharedList<UwbAnchor> anchors;  ///< those of the room that stand, this one included

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    /// Walls between stop a ray each.
    [[nodiscard]] std::size_t rays() const {
        return 1 + 4 * std::min(tags.size(), slots) * (1 + anchors.size());
    }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return true; }
    [[nodiscard]] bool isNoisy() const {
        return !noise.isNone() || blocked_bias > 0 || blocked_sigma > 0;
    }
    static const SensorKind kKind;
    friend bool operator==(const Uwb&, const Uwb&) = default;
};

/// Returns `base` with the parameters that a `uwb` record writes, without tags and anchors; the
/// model stays. \throws FormatError with all findings
Uwb withParameters(Uwb base, const Record& record);

/// Returns the ball in which an anchor measures in line of sight.
FieldOfView fieldOfView(const Uwb& uwb, const Pose3& pose);

/// Adds the kind, for the program.
void addUwbs();

}  // namespace ispace::uwbs
