// SPDX-License-Identifier: GPL-3.0-or-later
// lib/arrange/poses: an upper bound of the floor that sensors with range and field of view see
// together, over all poses. Uses geom and base.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "arrange/poses/certificate.h"
#include "arrange/poses/fat_view.h"
#include "base/error.h"

namespace ispace {

struct PoseSearchOptions {
    int sensors = 1;
    int times = 1;     ///< floor counts if this many of the sensors see it
    double found = 0;  ///< m2 that some layout sees: what no layout can exceed is not searched
    double gap = 0;    ///< ends once the bound exceeds the layout found by this share of the bound
    std::size_t max_bytes = std::size_t{8} << 30U;  ///< of boxes and tuples
    /// Computes the area, m2, of a layout near these poses; null: layouts are not improved. Called
    /// by one thread.
    std::function<double(std::span<const poses::PoseBox>)> improve = {};
    PoseCertificate* certificate = nullptr;  ///< receives the proof; null: it is not wanted
};

struct PoseBound {
    double bound = 0;                   ///< m2: no poses of the sensors see more
    double found = 0;                   ///< m2, the best layout known
    std::size_t boxes = 0, tuples = 0;  ///< computed
    bool is_complete = true;            ///< false: cut short by progress or memory
};

/// Largest number of sensors of boundOverPoses().
constexpr int kMostPosed = 4;

/// Bounds the area that equal sensors see together, or that several of them see, at any poses on
/// the floor, by branch and bound over tuples of boxes of poses, one box for each sensor.
///
/// All that the poses of a tuple see lies in the union of its fat views (fatViewOf()). No sensor
/// adds more than the largest single view in its box, which its subdivision bounds, and no two more
/// than the largest view of a pair; what two sensors see in any poses of their boxes, their cores
/// (coreViewOf()), is counted once. So the bound of a tuple is the least, over all subsets of the
/// sensors, of their known areas, and in each cell the lesser of the fat views of the others and
/// the floor less all of their cores. In cells that several views share in part, the union counts
/// the sum of the parts, up to the floor in the cell. MultipleBound has the bound for several
/// times.
///
/// Deterministic for any number of threads, unless stopped. \pre 1 <= times <= sensors <=
/// kMostPosed
PoseBound boundOverPoses(const poses::PoseFloor& floor, const poses::Sector& sector,
                         const PoseSearchOptions& options, Progress& progress);

}  // namespace ispace
