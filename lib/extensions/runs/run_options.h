// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/runs: the coverage of recorded motion, as a section of reports: coverage --run,
// and simrun --report.
#pragma once

#include <memory>

#include "cli/coverage_group.h"
#include "cli/record_group.h"

namespace ispace::runs {

/// Makes the option of `coverage`.
std::unique_ptr<CoverageGroup> makeRunGroup();
/// Makes the section of `simrun --report`.
std::unique_ptr<RecordGroup> makeRunReport();

}  // namespace ispace::runs
