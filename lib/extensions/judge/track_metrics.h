// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/judge: measures tracks against the truth of a run: CLEAR MOT, IDF1, HOTA, OSPA(2),
// where and why tracks were lost. Reads records of simrun; draws only what the report of
// coverage does not.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "extensions/judge/assignment.h"
#include "geom/point.h"

namespace ispace::judge {

/// What is compared at one time: the truths and tracks there, by their indices in the run, and how
/// similar each pair is, from 0 to 1 (rows: truths).
struct ScoredFrame {
    std::vector<std::size_t> truths, tracks;
    Matrix similarity;
};

/// A run cut into frames.
struct ScoredRun {
    std::size_t truths = 0, tracks = 0;  ///< numbers of different ones
    std::vector<ScoredFrame> frames;
};

/// A pair is a match from this similarity on, in CLEAR and IDF1.
constexpr double kMatch = 0.5;

/// A truth of a frame, and its track. \see clearMot
struct FrameMatch {
    std::size_t frame = 0, truth = 0, track = 0;  ///< indices of ScoredRun
    double similarity = 0;
    bool is_switch = false;  ///< its last match was another track
};

/// CLEAR MOT (Bernardin, Stiefelhagen 2008) by the rules of TrackEval: a pair of the frame before
/// is kept while it is a match, the rest are matched for the largest similarity.
struct ClearMot {
    std::size_t matches = 0, misses = 0, false_positives = 0, switches = 0;
    std::size_t fragments = 0;  ///< interruptions of matched truths
    /// Truths that are matched in more than 80 % of their frames, in 20 % or more, in fewer.
    std::size_t mostly_tracked = 0, partly_tracked = 0, mostly_lost = 0;
    double similarity = 0;  ///< sum over the matches
    /// 1 - (misses + false positives + switches) / truths; below 0 if there are more errors than
    /// truths.
    double mota = 0;
    std::vector<FrameMatch> pairs;  ///< all matches, by frame and truth
};
ClearMot clearMot(const ScoredRun& run);

/// IDF1 (Ristani et al. 2016): whole tracks are matched with whole truths for the most common
/// frames.
struct Identity {
    std::size_t true_positives = 0, false_positives = 0, misses = 0;
    double idf1 = 0;
};
/// O(n^2 m) for n truths and m tracks, n <= m. \throws UsageError for more than 20 million pairs
Identity identityOf(const ScoredRun& run);

/// HOTA (Luiten et al. 2021): means over the similarities 0.05, 0.10 ... 0.95.
struct Hota {
    double hota = 0, detection = 0, association = 0, localisation = 0;
};
Hota hotaOf(const ScoredRun& run);

/// The position of each truth or track at each frame where it exists.
struct PointTrack {
    std::vector<std::size_t> frames;  ///< ascending
    std::vector<Point2> places;       ///< as many
};

/// OSPA(2) of order 1 over a whole run (Beard, Vo, Vo 2020), in metres, at most `cutoff`: tracks
/// are matched as wholes; the distance of two is the mean over the frames with either of
/// min(cutoff, distance), and cutoff where only one exists. 0 if there are neither truths nor
/// tracks. \throws UsageError as identityOf
double ospa2(std::span<const PointTrack> truths, std::span<const PointTrack> tracks, double cutoff);

}  // namespace ispace::judge
