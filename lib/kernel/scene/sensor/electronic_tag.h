// SPDX-License-Identifier: GPL-3.0-or-later
// Electronic tags of people, robots and things: one list that RFID readers and UWB anchors share.
// Metres, in the frame of the room.
#pragma once

#include <cstddef>
#include <string>

#include "geom/point.h"
#include "scene/sensor/shared_list.h"

namespace ispace {

struct RoomRecords;

/// The key `tag` of a person, a robot or a thing, which radios read or range.
struct ElectronicTag {
    enum class Carrier { Thing, Robot, Person };

    std::string text;
    Carrier carrier = Carrier::Thing;
    std::size_t mover = 0;    ///< index among the scene's robots or people
    Point3 at;                ///< of a thing: above the middle of its top
    bool is_in_hand = false;  ///< of a thing that the person `mover` carries
    friend bool operator==(const ElectronicTag&, const ElectronicTag&) = default;
};

/// Returns the tags of a room, one list for all its sensors.
SharedList<ElectronicTag> sharedTags(const RoomRecords& room);

}  // namespace ispace
