// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "geom/point.h"
#include "scene/run/run_changes.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"
#include "sense/detection.h"

namespace ispace {

/// The longest time that somebody was seen by no sensor.
struct UnseenInterval {
    double begin = 0, end = 0;  ///< seconds
    Point2 from, to;            ///< where sight was lost, and found again
};

/// How well one robot or person was seen in a run, or all of them together.
struct RunSightMetrics {
    std::string id = {};  ///< "" of all together
    bool is_person = false;
    double duration = 0, length = 0;  ///< it was there, s, and its way, m
    /// [k]: share of that time and of that way on which exactly k sensors saw it. The way is empty
    /// of who did not move.
    std::vector<double> time_shares = {}, way_shares = {};
    std::size_t losses = 0;  ///< how often it was seen and then no more
    std::optional<UnseenInterval> longest_gap = {};
};

/// A piece of somebody's way on which the same number of sensors saw it.
struct SeenWay {
    std::size_t who = 0;  ///< index in RunCoverage::members
    std::size_t sensors = 0;
    std::vector<Point2> points = {};  ///< one if it stood there
};

/// Where somebody who was seen was lost.
struct TrackLoss {
    std::size_t who = 0;
    double begin = 0, duration = 0;  ///< seconds; to the end of the run if it was not found again
    Point2 place;
};

/// What a layout achieved in a run (the second valuation of the thesis, section 3.1): by how many
/// sensors everybody was seen, and where nobody saw.
struct RunCoverage {
    std::string name = {};  ///< of the record
    double begin = 0, end = 0;
    std::vector<RunSightMetrics> members;
    RunSightMetrics all;
    std::vector<SeenWay> ways = {};
    std::vector<TrackLoss> losses = {};  ///< the longest first
};

/// What is seen is told by Watch. Moments at least 0.02 s apart are looked at; what was seen at one
/// lasts until the next. Deterministic for any number of threads. O(moments x people x sensors);
/// memory for the ways, thinned to 0.02 m.
/// \throws FormatError as the reader does, for a record without a moment, and for who was there at
///         its beginning and is not in the scene
/// \param changes of the world in the run, which are made again; null: none
RunCoverage measureRun(const Scene& start, RunReader& reader, const WatchOptions& options,
                       RunChanges* changes = nullptr);

}  // namespace ispace
