// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage of recorded motion: the sensors that saw each robot and person, moment by moment.
//
//     const RunCoverage run = measureRun(start, reader, {});
//     const double unseen = run.all.time_shares[0];  // share of the time that no sensor saw one
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "geom/point.h"
#include "scene/run/run_changes.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"
#include "sense/detection.h"

namespace ispace::runs {

/// The longest unseen interval of a mover.
struct UnseenInterval {
    double begin = 0, end = 0;  ///< seconds
    Point2 from, to;            ///< positions at which sight was lost, and restored
};

/// Metrics of how one mover, or all together, were seen in a run.
struct RunCoverageMetrics {
    std::string id = {};  ///< "" for all together
    bool is_person = false;
    double duration = 0, length = 0;  ///< time that it was present, s, and length of its way, m
    /// [k]: share of that time and of that way on which exactly k sensors saw it. way_shares is
    /// empty if it did not move.
    std::vector<double> time_shares = {}, way_shares = {};
    std::size_t losses = 0;  ///< number of times that sight was lost
    std::optional<UnseenInterval> longest_gap = {};
};

/// A piece of a mover's way seen by a constant number of sensors.
struct SeenPath {
    std::size_t member = 0;  ///< index in RunCoverage::members
    std::size_t sensors = 0;
    std::vector<Point2> points = {};  ///< a single one if it stood there
};

/// A point at which sight of a mover was lost.
struct TrackLoss {
    std::size_t member = 0;
    /// Seconds; until the end of the run if sight was not restored.
    double begin = 0, duration = 0;
    Point2 place;
    std::string room = {};  ///< of the place, in the sum of several; else ""
};

/// A target that a mover gave up to reach.
struct UnreachedTarget {
    std::string id, to = {};        ///< to: a storey, a zone or an element, or ""
    std::optional<Point2> at = {};  ///< of that storey, or of the room
    double first = 0;               ///< seconds
    std::size_t times = 0;
};

/// Collisions of a mover with one thing or mover.
struct RunContact {
    std::string id, other;
    Point2 at;         ///< where the mover was at the first one
    double first = 0;  ///< seconds
    std::size_t times = 0;
};

/// Coverage of a recorded run (the second valuation of the thesis, section 3.1): the number of
/// sensors that saw each mover, and its unseen intervals.
struct RunCoverage {
    std::string name = {};  ///< of the recorded file
    double begin = 0, end = 0;
    std::vector<RunCoverageMetrics> members;
    RunCoverageMetrics all;
    std::vector<SeenPath> ways = {};
    std::vector<TrackLoss> losses = {};           ///< sorted by duration, the longest first
    std::vector<UnreachedTarget> unreached = {};  ///< in the order of their first times
    std::vector<RunContact> contacts = {};        ///< likewise
};

/// Computes the coverage of a recorded run by DetectionMonitor. Samples moments at least 0.02 s
/// apart and holds each result until the next sample. Deterministic for any number of threads.
/// O(moments x people x sensors); memory for the ways, thinned to 0.02 m. \throws FormatError as
/// the reader, for a record without a moment, and for a mover at its start that is not in the scene
/// \param changes of the world during the run, which are replayed; null: the world is static
/// \param advance moves WatchOptions::outside to a time in seconds, and returns true if its answer
///        is another one; empty: it has one answer
RunCoverage measureRun(const Scene& start, RunReader& reader, const WatchOptions& options,
                       RunChanges* changes = nullptr,
                       const std::function<bool(double time)>& advance = {});

}  // namespace ispace::runs
