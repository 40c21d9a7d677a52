// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/shared_list.h"

namespace ispace {

struct RoomRecords;
struct SensorKind;

/// The key `tag` of a person, a robot or a thing, which `rfid` and `uwb` read.
struct RfidTag {
    enum class Carrier { Thing, Robot, Person };

    std::string text;
    Carrier carrier = Carrier::Thing;
    std::size_t mover = 0;    ///< index among the scene's robots or people
    Point3 at;                ///< of a thing: above the middle of its top
    bool is_in_hand = false;  ///< of a thing that the person `mover` carries
    friend bool operator==(const RfidTag&, const RfidTag&) = default;
};

/// An RFID reader with its antenna, which lists the tags in its field.
struct Rfid {
    std::string model;  ///< "" for the bare reader
    double min_range = 0, max_range = 3;
    Angle fov_x = Angle::degrees(70), fov_y = Angle::degrees(70);  ///< full angles
    double rate = 10;                                              ///< rounds of inventory a second
    double read = 1;           ///< share of the rounds that read a tag in the field, with noise
    SharedList<RfidTag> tags;  ///< of the scene

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

/// Returns the tags of a room, one list for all its sensors.
SharedList<RfidTag> sharedTags(const RoomRecords& room);

/// Returns the field of the antenna at a pose, without occlusion.
FieldOfView fieldOfView(const Rfid& rfid, const Pose3& pose);

}  // namespace ispace
