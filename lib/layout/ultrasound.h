// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "geom/pose.h"
#include "layout/devices.h"
#include "layout/laser.h"
#include "layout/noise.h"
#include "record/record.h"

namespace ispace {

/// An ultrasonic receiver: hears a tag that is in reach, within a cone about its axis, and in
/// sight.
struct Receiver {
    std::string model;  ///< "" for the bare receiver
    double min_range = 0, max_range = 8;
    Angle fov = Angle::degrees(120);  ///< full angle of the cone
    double rate = 10;                 ///< measurements a second
    RangeNoise noise;                 ///< of the distance that the time of flight means
    friend bool operator==(const Receiver&, const Receiver&) = default;
};

/// An ultrasonic emitter.
struct Tag {
    std::string model;                ///< "" for the bare tag
    double rate = 10;                 ///< bursts a second
    Angle fov = Angle::degrees(360);  ///< full angle of the cone into which it emits
    /// Located by the thesis' simple model, eq. (3.7)-(3.10): its true x and y with independent
    /// noise of this standard deviation. Else from times of flight.
    bool is_simple = false;
    double simple_sigma = 0.1;
    friend bool operator==(const Tag&, const Tag&) = default;
};

struct PlacedReceiver {
    std::string id;
    Receiver receiver;
    Pose3 pose;
    std::optional<Mount> mount = {};
};
struct PlacedTag {
    std::string id;
    Tag tag;
    Pose3 pose;
    std::optional<Mount> mount = {};
};

/// Figures of an `ultrasound` record: its explicit keys, else its model's, else the bare one's.
/// \throws FormatError with all findings
Receiver receiverOf(const Record& record, const DeviceCatalogue& devices);
Receiver withFigures(Receiver base, const Record& record);
/// The same of a `tag` record.
Tag tagOf(const Record& record, const DeviceCatalogue& devices);
Tag withFigures(Tag base, const Record& record);

}  // namespace ispace
