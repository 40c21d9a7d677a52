// SPDX-License-Identifier: GPL-3.0-or-later
// The tags that an RFID reader lists in one round. Thread-safe; noise depends on its key alone,
// never on the order of calls.
#pragma once

#include <string>
#include <vector>

#include "extensions/rfids/rfid.h"
#include "sense/added_reading.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::rfids {

/// One round of inventory of an RFID reader.
struct RfidTags {
    std::vector<std::string> tags;  ///< sorted, each once

    static const ReadingKind kKind;
};

/// Lists the tags in the field of a reader that neither a solid body nor another mover hides. The
/// tag of a mover is read where sightingsOf() (sense/sighting.h) finds the mover, and that of a
/// thing in its hand where the thing is.
///
/// With noise, a tag is read with the probability `read`, which depends on seed, sensor, frame and
/// tag alone.
RfidTags readingOf(const Rfid& rfid, const Moment& now);

}  // namespace ispace::rfids
