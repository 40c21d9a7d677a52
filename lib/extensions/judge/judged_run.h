// SPDX-License-Identifier: GPL-3.0-or-later
// A record of simrun beside a file of tracks: both on one row of frames, and what went wrong in
// them.
//
// The reader goes once through the record; memory grows with the frames, of which there are at most
// two million.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "extensions/judge/track_file.h"
#include "extensions/judge/track_metrics.h"
#include "scene/run/run_reader.h"

namespace ispace::judge {

/// Which movers of a record are truths.
enum class TruthKind { All, People, Robots };

/// A truth at a frame.
struct TruthPlace {
    std::size_t truth = 0;  ///< index in JudgedRun::truths
    Point2 place;
    std::optional<std::size_t> sensors = {};  ///< number of those that see it, if known
};

/// A recorded run beside the tracks of a tracker, cut into frames.
struct JudgedRun {
    double interval = 0;              ///< seconds from frame to frame
    std::vector<double> times;        ///< of the frames, seconds
    std::vector<RunMember> truths;    ///< people and robots
    std::vector<std::string> tracks;  ///< names
    /// By frame, and ascending in it.
    std::vector<std::vector<TruthPlace>> truth_places;
    std::vector<std::vector<TruthPlace>> track_places;  ///< of tracks, by their index
    std::size_t rows_outside = 0;                       ///< of the file, before or after the run
};

struct FrameChoice {
    std::optional<double> rate;  ///< frames a second; empty: that of the file
    TruthKind truths = TruthKind::All;
};

/// Lays frames over the run at the times of the file, extended to its beginning and end, or at a
/// rate from the run's beginning; between recorded moments truths are interpolated. A track has at
/// most one row in a frame, the nearest one within half an interval; later rows of a faster file
/// are left out. \param every seconds between recorded moments, of which MOT files without a rate
/// count theirs \throws UsageError for more than two million frames; FormatError as the reader, and
/// for a run without truths
JudgedRun judgedRun(RunReader& run, const TrackFile& file, const FrameChoice& choice, double every);

/// Returns 1 - d / 1 m, at least 0, for each truth and track of each frame; 0 for a person and a
/// track of a robot. \param kinds of the tracks, as in TrackFile
ScoredRun scored(const JudgedRun& run, const std::vector<std::string>& kinds);

/// Returns each truth's, or each track's, places.
std::vector<PointTrack> pointTracks(const std::vector<std::vector<TruthPlace>>& places,
                                    std::size_t count);

/// Why a truth was lost.
enum class LossReason { Entry, Unseen, Crossing, Other };
/// Returns "entry", "unseen", "crossing" or "other".
std::string_view nameOf(LossReason reason);

/// A truth without its track, or with another one.
struct Loss {
    double begin = 0,
           end = 0;  ///< seconds: of the first frame without a match, and of the next one with one
    std::size_t truth = 0;
    Point2 place;  ///< of the truth at the begin
    LossReason reason = LossReason::Other;
    std::optional<std::size_t> before, after;  ///< tracks
};

/// Figures of the truths in a class of circumstances.
struct ClassFigures {
    std::string name;
    std::size_t truths = 0, matches = 0, switches = 0;
    double distance = 0;  ///< sum over the matches, metres
};

/// Finds the losses: intervals without a match while the truth is there, and switches. The first
/// reason that holds counts: unseen, if it is known that no sensor sees the place at the begin;
/// entry, if the truth was never matched before; crossing, if another truth is within kNearTruths
/// of it there. In the order of their begins, then of truths.
std::vector<Loss> lossesOf(const JudgedRun& run, const ClearMot& clear);

/// Sorts the truths of all frames into classes: `classify` returns an index below that of `names`,
/// or more for none.
std::vector<ClassFigures> figuresBy(
    const JudgedRun& run, const ClearMot& clear, std::vector<std::string> names,
    const std::function<std::size_t(std::size_t frame, const TruthPlace& truth)>& classify);

/// Returns the delay, in seconds, that explains most of the matches' errors: that of tracks which
/// tell where their truths were then; below 0 if they are ahead. Empty if matched truths stand
/// still.
std::optional<double> latencyOf(const JudgedRun& run, const ClearMot& clear);

/// Truths nearer to each other than this cross, and crowd.
constexpr double kNearTruths = 1;
/// Returns the number of other truths of a frame within kNearTruths.
std::size_t neighboursOf(const JudgedRun& run, std::size_t frame, const TruthPlace& truth);

}  // namespace ispace::judge
