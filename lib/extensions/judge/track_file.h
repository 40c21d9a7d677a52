// SPDX-License-Identifier: GPL-3.0-or-later
// Files of trackers: CSV, JSON lines, MOT, MCAP. Metres in the frame of the room, seconds of the
// run.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/point.h"

namespace ispace::judge {

/// A position that a tracker told.
struct TrackRow {
    double time = 0;        ///< seconds; of MOT files the number of the frame
    std::size_t track = 0;  ///< index in TrackFile::tracks
    Point2 place;
    int line = 0;  ///< of the file; of MCAP the number of the message
};

/// What a tracker told of a run.
struct TrackFile {
    std::vector<std::string> tracks;  ///< names, in the order of their first rows
    /// "person" or "robot" if all rows of the track say so, by "kind"; else "".
    std::vector<std::string> kinds;
    std::vector<TrackRow> rows;  ///< by time, then by track
    bool counts_frames = false;  ///< a MOT file: times are numbers of frames, from 1 on
};

/// Reads a file of tracks, known by its content:
/// - CSV with a line of heads: t, track, x, y and perhaps kind, in any order, beside other columns;
/// - JSONL, an object a line with these keys; `track` is a text or a number;
/// - MOT, 9 or 10 numbers a line without heads: frame, track, four of a box, confidence, x, y[, z]
/// in metres;
/// - MCAP, markers (visualization_msgs/MarkerArray) of a topic /tracks, or of the only one of this
/// type: NS/ID is the track, the stamp its time, a text `person` or `robot` its kind.
/// Empty lines and those that begin with # are skipped. \throws FormatError with the line or byte:
/// missing columns, bad numbers, a track twice at one time, no row
TrackFile readTracks(std::string_view bytes, const std::string& name);

/// Returns the interval from row to row of a track: the smallest one of all, or the mean of all if
/// they are multiples of it but for rounding. Empty for a file of one time. \pre rows are sorted
std::optional<double> intervalOf(const TrackFile& file);

}  // namespace ispace::judge
