// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/advice: changes of a scene that would help, coverage --suggest and simrun
// --suggest.
#pragma once

#include <memory>

#include "cli/coverage_group.h"
#include "cli/record_group.h"

namespace ispace::advice {

/// Makes the options of `coverage`.
std::unique_ptr<CoverageGroup> makeAdvice();
/// Makes the option of `simrun`: changes after which sensors see more of the movers of a run.
std::unique_ptr<RecordGroup> makeRunAdvice();

}  // namespace ispace::advice
