// SPDX-License-Identifier: GPL-3.0-or-later
// All four follow TrackEval (Luiten and Hoffhues, github.com/JonathonLuiten/TrackEval), down to its
// epsilon and its treatment of empty frames, so that figures can be compared with published ones.
//
// CLEAR keeps pairs of the frame before by a gain of 1000, above any sum of similarities of usual
// frames. HOTA matches once a frame, with gains weighted by how well the two belong together over
// the whole run, and applies its 19 thresholds to that one matching. OSPA(2) is the assignment over
// whole tracks; pairs that never meet gain 0, the cut-off in full.
#include "extensions/judge/track_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"

namespace ispace::judge {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

using Pair = std::pair<std::size_t, std::size_t>;

/// Frames of each truth, and of each track.
struct Counts {
    std::vector<std::size_t> truths, tracks;
};

Counts countsOf(const ScoredRun& run) {
    Counts counts{std::vector<std::size_t>(run.truths), std::vector<std::size_t>(run.tracks)};
    for (const ScoredFrame& frame : run.frames) {
        for (const std::size_t truth : frame.truths) ++counts.truths[truth];
        for (const std::size_t track : frame.tracks) ++counts.tracks[track];
    }
    return counts;
}

void mustBeFew(std::size_t truths, std::size_t tracks) {
    constexpr std::size_t kMostPairs = 20'000'000;
    if (truths != 0 && tracks > kMostPairs / truths)
        throw UsageError(
            std::to_string(truths) + " truths and " + std::to_string(tracks) +
            " tracks make too many pairs: judge a shorter run, or give a track one name "
            "as long as it lasts");
}

/// The truths of a run as CLEAR MOT follows them.
struct Followed {
    std::optional<std::size_t> track, track_before;  ///< the last one, and that of the frame before
    std::size_t frames = 0, matches = 0, begun = 0;
};

/// Matches a frame: pairs of the frame before first.
std::vector<Pair> matchesOf(const ScoredFrame& frame, const std::vector<Followed>& followed) {
    // More than all similarities of a frame can make up for.
    constexpr double kKept = 1000;
    Matrix gains{frame.truths.size(), frame.tracks.size()};
    for (std::size_t i = 0; i < gains.rows; ++i)
        for (std::size_t j = 0; j < gains.columns; ++j) {
            const double similarity = frame.similarity.at(i, j);
            if (similarity < kMatch - kEpsilon) continue;
            const bool is_kept = followed[frame.truths[i]].track_before == frame.tracks[j];
            gains.at(i, j) = (is_kept ? kKept : 0) + similarity;
        }
    std::vector<Pair> pairs = bestAssignment(gains);
    std::erase_if(pairs,
                  [&](const Pair& pair) { return gains.at(pair.first, pair.second) <= kEpsilon; });
    return pairs;
}

/// Divides by the second number, or by 1 if that is 0.
double shareOf(double part, double whole) { return part / std::max(1.0, whole); }

}  // namespace

ClearMot clearMot(const ScoredRun& run) {
    ClearMot result;
    std::vector<Followed> followed(run.truths);
    std::vector<std::size_t> matched_before;
    for (std::size_t f = 0; f < run.frames.size(); ++f) {
        const ScoredFrame& frame = run.frames[f];
        for (const std::size_t truth : frame.truths) ++followed[truth].frames;
        // A frame without truths or without tracks interrupts no pair, as TrackEval has it.
        if (frame.truths.empty() || frame.tracks.empty()) {
            result.misses += frame.truths.size();
            result.false_positives += frame.tracks.size();
            continue;
        }
        const std::vector<Pair> pairs = matchesOf(frame, followed);
        std::vector<std::size_t> matched;
        std::vector<std::optional<std::size_t>> before;
        for (const auto& [i, j] : pairs) {
            Followed& one = followed[frame.truths[i]];
            const std::size_t track = frame.tracks[j];
            const bool is_switch = one.track && *one.track != track;
            result.switches += is_switch ? 1 : 0;
            result.similarity += frame.similarity.at(i, j);
            result.pairs.push_back(
                {f, frame.truths[i], track, frame.similarity.at(i, j), is_switch});
            ++one.matches;
            if (!one.track_before) ++one.begun;
            one.track = track;
            matched.push_back(frame.truths[i]);
        }
        for (const std::size_t truth : matched_before) followed[truth].track_before.reset();
        for (const std::size_t truth : matched)
            followed[truth].track_before = followed[truth].track;
        matched_before = std::move(matched);
        result.matches += pairs.size();
        result.misses += frame.truths.size() - pairs.size();
        result.false_positives += frame.tracks.size() - pairs.size();
    }
    constexpr double kMostly = 0.8, kPartly = 0.2;
    for (const Followed& one : followed) {
        if (one.begun > 1) result.fragments += one.begun - 1;
        if (one.frames == 0) continue;
        const double share = static_cast<double>(one.matches) / static_cast<double>(one.frames);
        ++(share > kMostly    ? result.mostly_tracked
           : share >= kPartly ? result.partly_tracked
                              : result.mostly_lost);
    }
    const auto right = static_cast<double>(result.matches) -
                       static_cast<double>(result.false_positives + result.switches);
    result.mota = shareOf(right, static_cast<double>(result.matches + result.misses));
    return result;
}

Identity identityOf(const ScoredRun& run) {
    mustBeFew(run.truths, run.tracks);
    Matrix common{run.truths, run.tracks};
    for (const ScoredFrame& frame : run.frames)
        for (std::size_t i = 0; i < frame.truths.size(); ++i)
            for (std::size_t j = 0; j < frame.tracks.size(); ++j)
                if (frame.similarity.at(i, j) >= kMatch)
                    common.at(frame.truths[i], frame.tracks[j]) += 1;
    double most = 0;
    for (const auto& [truth, track] : bestAssignment(common)) most += common.at(truth, track);
    Identity result;
    result.true_positives = static_cast<std::size_t>(most);
    std::size_t truths = 0, tracks = 0;
    for (const ScoredFrame& frame : run.frames) {
        truths += frame.truths.size();
        tracks += frame.tracks.size();
    }
    result.misses = truths - result.true_positives;
    result.false_positives = tracks - result.true_positives;
    constexpr double kHalf = 0.5;
    result.idf1 = shareOf(most, most + kHalf * static_cast<double>(result.misses) +
                                    kHalf * static_cast<double>(result.false_positives));
    return result;
}

namespace {

constexpr std::size_t kAlphas = 19;
double alpha(std::size_t index) { return 0.05 + static_cast<double>(index) * 0.05; }

/// How well each truth and each track belong together over the whole run.
std::map<Pair, double> alignments(const ScoredRun& run, const Counts& counts) {
    std::map<Pair, double> shared;
    for (const ScoredFrame& frame : run.frames) {
        const Matrix& similarity = frame.similarity;
        std::vector<double> rows(similarity.rows), columns(similarity.columns);
        for (std::size_t i = 0; i < similarity.rows; ++i)
            for (std::size_t j = 0; j < similarity.columns; ++j) {
                rows[i] += similarity.at(i, j);
                columns[j] += similarity.at(i, j);
            }
        for (std::size_t i = 0; i < similarity.rows; ++i)
            for (std::size_t j = 0; j < similarity.columns; ++j) {
                const double one = similarity.at(i, j), all = rows[i] + columns[j] - one;
                if (one > 0 && all > kEpsilon)
                    shared[{frame.truths[i], frame.tracks[j]}] += one / all;
            }
    }
    for (auto& [pair, value] : shared)
        value /=
            static_cast<double>(counts.truths[pair.first] + counts.tracks[pair.second]) - value;
    return shared;
}

}  // namespace

Hota hotaOf(const ScoredRun& run) {
    const Counts counts = countsOf(run);
    const std::map<Pair, double> aligned = alignments(run, counts);
    std::array<std::size_t, kAlphas> positives{}, misses{}, false_positives{};
    std::array<double, kAlphas> similarity{};
    std::map<Pair, std::array<std::size_t, kAlphas>> frames_of;  // matched, of each pair
    for (const ScoredFrame& frame : run.frames) {
        Matrix gains{frame.truths.size(), frame.tracks.size()};
        for (std::size_t i = 0; i < gains.rows; ++i)
            for (std::size_t j = 0; j < gains.columns; ++j)
                if (const auto at = aligned.find({frame.truths[i], frame.tracks[j]});
                    at != aligned.end())
                    gains.at(i, j) = at->second * frame.similarity.at(i, j);
        const std::vector<Pair> pairs = bestAssignment(gains);
        for (std::size_t a = 0; a < kAlphas; ++a) {
            std::size_t matches = 0;
            for (const auto& [i, j] : pairs) {
                const double one = frame.similarity.at(i, j);
                if (one < alpha(a) - kEpsilon) continue;
                ++matches;
                similarity[a] += one;
                ++frames_of[{frame.truths[i], frame.tracks[j]}][a];
            }
            positives[a] += matches;
            misses[a] += gains.rows - matches;
            false_positives[a] += gains.columns - matches;
        }
    }
    std::array<double, kAlphas> associated{};
    for (const auto& [pair, matched] : frames_of)
        for (std::size_t a = 0; a < kAlphas; ++a) {
            const auto common = static_cast<double>(matched[a]);
            associated[a] +=
                common * shareOf(common, static_cast<double>(counts.truths[pair.first] +
                                                             counts.tracks[pair.second]) -
                                             common);
        }
    Hota mean;
    for (std::size_t a = 0; a < kAlphas; ++a) {
        const auto matches = static_cast<double>(positives[a]);
        const double detection =
            shareOf(matches, matches + static_cast<double>(misses[a] + false_positives[a]));
        const double association = shareOf(associated[a], matches);
        mean.hota += std::sqrt(detection * association) / kAlphas;
        mean.detection += detection / kAlphas;
        mean.association += association / kAlphas;
        mean.localisation += (positives[a] == 0 ? 1 : similarity[a] / matches) / kAlphas;
    }
    return mean;
}

namespace {

/// The mean over the frames with either track.
double distanceOf(const PointTrack& a, const PointTrack& b, double cutoff) {
    double sum = 0;
    std::size_t frames = 0, i = 0, j = 0;
    for (; i < a.frames.size() || j < b.frames.size(); ++frames) {
        const bool has_a =
            i < a.frames.size() && (j == b.frames.size() || a.frames[i] <= b.frames[j]);
        const bool has_b =
            j < b.frames.size() && (i == a.frames.size() || b.frames[j] <= a.frames[i]);
        sum += has_a && has_b ? std::min(cutoff, distance(a.places[i], b.places[j])) : cutoff;
        i += has_a ? 1 : 0;
        j += has_b ? 1 : 0;
    }
    return frames == 0 ? cutoff : sum / static_cast<double>(frames);
}

bool overlap(const PointTrack& a, const PointTrack& b) {
    return !a.frames.empty() && !b.frames.empty() && a.frames.front() <= b.frames.back() &&
           b.frames.front() <= a.frames.back();
}

}  // namespace

double ospa2(std::span<const PointTrack> truths, std::span<const PointTrack> tracks,
             double cutoff) {
    const std::size_t most = std::max(truths.size(), tracks.size());
    if (most == 0) return 0;
    mustBeFew(truths.size(), tracks.size());
    Matrix gains{truths.size(), tracks.size()};
    for (std::size_t i = 0; i < gains.rows; ++i)
        for (std::size_t j = 0; j < gains.columns; ++j)
            gains.at(i, j) = overlap(truths[i], tracks[j])
                                 ? cutoff - distanceOf(truths[i], tracks[j], cutoff)
                                 : 0;
    double sum = cutoff * static_cast<double>(most);
    for (const auto& [i, j] : bestAssignment(gains)) sum -= gains.at(i, j);
    return sum / static_cast<double>(most);
}

}  // namespace ispace::judge
