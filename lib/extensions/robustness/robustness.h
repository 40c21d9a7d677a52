// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/robustness: coverage with sensors mounted off their poses, without those that
// fail, and among people: coverage --perturb, --failures and --crowd.
#pragma once

#include <memory>

#include "cli/coverage_group.h"

namespace ispace::robustness {

/// Makes the options of `coverage`.
std::unique_ptr<CoverageGroup> makeRobustness();

}  // namespace ispace::robustness
