// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include <vector>

#include "cover/trace_file.h"
#include "place/scene_problem.h"

namespace ispace {

/// Every candidate with the share of what counts that it would add to what stands and, for a laser,
/// its slice area (eq. 4.4) by the thesis' scan of the pose.
std::vector<TriedPose> triedPoses(SceneProblem& model, const std::vector<Choice>& chosen);

}  // namespace ispace
