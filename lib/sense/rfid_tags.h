// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

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

/// Lists the tags in the field of a reader that neither a solid body nor another mover hides. The
/// tag of a mover is read where sightingsOf() (sense/sighting.h) finds the mover.
///
/// With noise, a tag is read with the probability `read`, which depends on seed, sensor, frame and
/// tag alone.
RfidTags readingOf(const Rfid& rfid, const Moment& now);

}  // namespace ispace
