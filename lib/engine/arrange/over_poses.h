// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/check_guards.h"
#include "arrange/poses/certificate.h"
#include "arrange/poses/outer_bound.h"
#include "arrange/sensor_group.h"
#include "base/error.h"
#include "scene/scene.h"

namespace ispace {

/// Finds the fewest lasers that see the whole free floor at their height, over all poses, with a
/// proof (ArrangeOptions::over_poses).
/// \throws UsageError unless it is an art gallery: lasers of one kind that turn all around, level,
///         with a range beyond the room; straight walls; all of the floor as target
Arrangement arrangeOverPoses(const Scene& scene, const std::vector<SensorGroup>& groups,
                             const ArrangeOptions& options, Progress& progress);

/// Checks by other code that the lasers of a scene see its floor, and that fewer do not.
/// \throws UsageError as arrangeOverPoses() \throws FormatError as checkGuards()
GuardCheck checkGuarded(const Scene& scene, const GuardCertificate& certificate,
                        const std::string& name);

class CoverageModel;

/// Gap at which a bound of coverage over all poses is close enough, unless another is given.
constexpr double kPosesGap = 0.005;

/// Divides zones into convex pieces of one weight.
poses::FloorWeighting weightingOf(const FloorWeights& weights);

/// Validates before a search that boundOfPoses() can follow it.
/// \throws UsageError unless the sensors are level lasers of one kind that stand alone in a room of
///         straight walls, few enough for the proof
void mustBeBoundable(const Scene& scene, const std::vector<SensorGroup>& groups,
                     const ArrangeOptions& options);

/// Bounds the coverage of the arranged sensors over all poses (Arrangement::poses_bound), and moves
/// them if a better layout is found on the way.
void boundOfPoses(CoverageModel& model, Arrangement& arrangement, Progress& progress);

/// A bound of coverage over all poses that was checked, m2.
struct CheckedPoses {
    std::size_t sensors = 0;
    double found = 0;  ///< seen by the sensors of the scene, by exact area and weight
    double floor = 0;  ///< all that counts
    CertificateCheck check;
};

/// Checks a certificate for the sensors of a scene: computes all areas anew, by other code than
/// that of the search, but the area of the layout by weight, or that several sensors see, as
/// refinement does.
/// \param weights, times the goal of its search
/// \throws UsageError unless these are level lasers of one kind, as for mustBeBoundable()
/// \throws FormatError as checkCertificate()
CheckedPoses checkPoses(const Scene& scene, const FloorWeights& weights, int times,
                        const PoseCertificate& certificate, const std::string& name);

}  // namespace ispace
