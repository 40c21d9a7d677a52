// SPDX-License-Identifier: GPL-3.0-or-later
// `coverage --facing` and `--privacy`.
#pragma once

#include <memory>

#include "cli/coverage_group.h"

namespace ispace::camerarules {

std::unique_ptr<CoverageGroup> makeCoverageRules();

}  // namespace ispace::camerarules
