// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/proofs/poses: an upper bound of the floor that sensors with range and field of
// view see together, over all poses. Uses geom and base.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/part_file.h"
#include "base/shard.h"
#include "extensions/proofs/poses/certificate.h"
#include "extensions/proofs/poses/outer_bound.h"
#include "geom/pose.h"

namespace ispace::proofs {

/// Poses of all sensors, and the area that they see, m2.
struct PosedLayout {
    double area = 0;
    std::vector<Pose2> poses = {};  ///< empty: those that were known before the search
};

/// Divides the search among processes, and continues an earlier run.
///
/// The state holds boxes without views, which are computed anew for those of open tuples; it is
/// stored when that is due and when the search is stopped.
///
/// All shards search the same tuples until there are enough, deal these out in turn by their
/// bounds, and each continues with its share. A shard stores its best layout and a bound of its
/// subtrees that holds even if it was cut short; the merge takes the best layout and the highest
/// bound.
struct PoseShare {
    JobResults* results = nullptr;  ///< null: do not store steps
    std::optional<Shard> own = {};  ///< search its share alone
    int joined = 0;                 ///< of a merge: the number of shards
};

struct PoseSearchOptions {
    int sensors = 1;
    int times = 1;     ///< floor counts if this many of the sensors see it
    double found = 0;  ///< m2 that some layout sees: what no layout can exceed is not searched
    double gap = 0;    ///< ends once the bound exceeds the layout found by this share of the bound
    std::size_t max_bytes = std::size_t{8} << 30U;  ///< of boxes and tuples
    std::size_t singles = 20'000;  ///< boxes that bound single views before all else, at most
    /// Computes a layout near these poses; null: layouts are not improved. Called by one thread.
    std::function<PosedLayout(std::span<const poses::PoseBox>)> improve = {};
    PoseCertificate* certificate = nullptr;  ///< receives the proof; null: it is not wanted
    PoseShare share = {};
};

struct PoseBound {
    double bound = 0;                   ///< m2: no poses of the sensors see more
    PosedLayout found;                  ///< the best layout known
    std::size_t boxes = 0, tuples = 0;  ///< computed
    bool is_complete = true;            ///< false: cut short by progress or memory
};

/// Largest number of sensors of boundOverPoses().
constexpr int kMaxPosed = 4;

/// Bounds the area that equal sensors see together, or that several of them see, at any poses on
/// the floor, by branch and bound over tuples of boxes of poses, one box for each sensor.
///
/// All that the poses of a tuple see lies in the union of its fat views (outerBoundOf()). No sensor
/// adds more than the largest single view in its box, which its subdivision bounds; what sensors
/// see in any poses of their boxes, their cores (innerBoundOf()), is counted once. So the bound of
/// a tuple is the least, over all subsets of the sensors, of their known areas, and in each cell
/// the lesser of the fat views of the others and the floor less all of their cores. In cells that
/// several views share in part, the union counts the sum of the parts, up to the floor in the cell.
/// MultipleBound has the bound for several times, SumBound another one by the parts of each box.
///
/// Deterministic for any number of threads, unless stopped. With a share a stopped search continues
/// to the result of one that was not. \throws FormatError for a state or a part that is damaged
/// \pre 1 <= times <= sensors <=
/// kMaxPosed
PoseBound boundOverPoses(const poses::PoseFloor& floor, const poses::Sector& sector,
                         const PoseSearchOptions& options, Progress& progress);

}  // namespace ispace::proofs
