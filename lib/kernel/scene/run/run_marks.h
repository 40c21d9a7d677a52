// SPDX-License-Identifier: GPL-3.0-or-later
// The events of recorded runs that a viewer's time line shows. A read holds one line at a time, and
// all marks of the records.
//
//     for (const RunMark& mark : recordedMarks({"run1", "run2"})) draw(mark.time, mark.kind);
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ispace {

/// A remarkable event of a recorded run, for the time line of its replay.
struct RunMark {
    double time = 0;         ///< seconds
    std::string kind = {};   ///< collision, unreached, mark or change
    std::string id = {};     ///< of a mover; "" for marks and changes
    std::string other = {};  ///< what it ran into, or the target that it gave up
    std::string text = {};   ///< of a mark; a changed record
    bool operator==(const RunMark&) const = default;
};

/// Reads the marks of records that are replayed together from their events.csv, in the order of
/// time. If there are more than `most`, returns the first one of each of `most` equal spans of
/// time. \throws FormatError if such a file holds no events or a time is invalid,
/// std::system_error
std::vector<RunMark> recordedMarks(const std::vector<std::string>& folders, std::size_t most = 500);

}  // namespace ispace
