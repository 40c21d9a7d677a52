// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/rfids: RFID readers, which list the tags in their fields. Uses sense and below.
#pragma once

#include <cstddef>
#include <string>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/electronic_tag.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/shared_list.h"

namespace ispace {

struct SensorKind;

}  // namespace ispace

namespace ispace::rfids {

/// An RFID reader with its antenna, which lists the tags in its field.
struct Rfid {
    std::string model;  ///< "" for the bare reader
    double min_range = 0, max_range = 3;
    Angle fov_x = Angle::degrees(70), fov_y = Angle::degrees(70);  ///< full angles
    double rate = 10;                                              ///< rounds of inventory a second
    double read = 1;  ///< share of the rounds that read a tag in the field, with noise
    SharedList<ElectronicTag> tags;  ///< of the scene

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] std::size_t rays() const { return 1 + tags.size(); }
    [[nodiscard]] bool isNoisy() const { return read < 1; }
    [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const {
        return fov_x >= Angle::degrees(360) && mount.isLevel();
    }
    static const SensorKind kKind;
    friend bool operator==(const Rfid&, const Rfid&) = default;
};

/// Returns `base` with the parameters that an `rfid` record writes, without tags; the model stays.
/// \throws FormatError with all findings
Rfid withParameters(Rfid base, const Record& record);

/// Returns the field of the antenna at a pose, without occlusion.
FieldOfView fieldOfView(const Rfid& rfid, const Pose3& pose);

/// Adds the kind, for the program.
void addRfids();

}  // namespace ispace::rfids
