// SPDX-License-Identifier: GPL-3.0-or-later
// Checks paths of a scene before a run: `--check` names legs that a mover would give up.
//
// Walks are those of a run without noise and other movers, with steps of 5 ms: at most four million
// of these, in which the time to prepare walks counts, too.
#pragma once

#include <vector>

#include "scene/findings/findings.h"
#include "scene/scene.h"

namespace ispace {

/// Finds the legs of recorded paths that robots and people give up. Each leg that is not along a
/// free straight line is walked by the world of a run with default options, by the mover alone,
/// from rest; a mover that would give up its point there is a finding, which names the first body
/// on the straight line. A leg begins where the one before it ends, or was given up if its point is
/// not free. Points outside the room are no findings: checkScene() names them. Movers that stand
/// outside or in a body are left out. Stops at Diagnostics::kMax findings, and after some ten
/// seconds of work, which is a finding, too.
std::vector<Finding> checkCourses(const Scene& scene);

}  // namespace ispace
