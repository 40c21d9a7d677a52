// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/sensor/rfid.h"
#include "sense/moment.h"

namespace ispace {

struct ReadingKind;

/// One round of inventory of an RFID reader.
struct RfidTags {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;
    std::vector<std::string> tags;  ///< sorted, each once

    static const ReadingKind kKind;
};

/// Returns the owner of the bodies of the mover with a tag, of a thing in its hand, too.
std::uint32_t ownerOf(const RfidTag& tag);

/// Returns where the tag of a thing in a person's hand is: above the middle of its top. Empty
/// without a body of the person. \pre tag.is_in_hand
std::optional<Point3> placeInHand(const RfidTag& tag, const MovingBodies& bodies);

/// Lists the tags in the field of a reader that neither a solid body nor another mover hides. The
/// tag of a mover is read where sightingsOf() (sense/sighting.h) finds the mover, and that of a
/// thing in its hand where the thing is.
///
/// With noise, a tag is read with the probability `read`, which depends on seed, sensor, frame and
/// tag alone.
RfidTags readingOf(const Rfid& rfid, const Moment& now);

}  // namespace ispace
