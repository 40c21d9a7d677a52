// SPDX-License-Identifier: GPL-3.0-or-later
// lib/place: candidates and optimisers that place sensors. Uses cover and below; TBB inside.
#pragma once

#include <vector>

#include "base/progress.h"
#include "cover/coverage.h"
#include "layout/laser.h"

namespace ispace {

/// Density of the thesis' Ordinary Grid (section 4.4.2).
struct GridSearch {
    int x = 1, y = 1;  ///< interior grid lines along x and y
    int headings = 8;  ///< 360/headings apart, the first 0
};

/// Eq. (4.1) and (4.2) with seg = 5, rounded down, at least 1; 8 headings.
GridSearch defaultGridSearch(const Box2& limits, double max_range);

/// The x * y crossings x_i = xmin + i (xmax - xmin) / (X + 1), i = 1..X, likewise y; y runs
/// slowest.
std::vector<Point2> gridPlaces(const Box2& limits, const GridSearch& search);

/// True if a sensor at this height may stand at p: strictly indoors (Insider Judge), in no solid.
bool isStandable(const Environment& environment, const Slice& slice, Point2 p);

/// The places where isStandable holds, in their order; shared out over all cores.
std::vector<Point2> standablePlaces(const Environment& environment, const Slice& slice,
                                    const std::vector<Point2>& places, Progress& progress);

/// A place and heading a sensor may take, with the cells of the target it would see.
struct Candidate {
    Pose3 pose;
    CellSet seen;  ///< a subset of the target's cells
};

/// Every place with every heading, each scanned once, in the order of places and then headings.
///
/// `mount` gives height, tilt and roll of the sensor. `target` are the cells that count. Work is
/// shared out over all cores; the result does not depend on their number. Memory: one bit a cell
/// and candidate.
std::vector<Candidate> makeCandidates(const Grid& grid, const CellSet& target,
                                      const Environment& environment, const Laser& laser,
                                      const Pose3& mount, const std::vector<Point2>& places,
                                      int headings, Progress& progress);

}  // namespace ispace
