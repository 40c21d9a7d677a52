// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cover/coverage.h"
#include "cover/run_sight.h"

namespace ispace {

/// One JSON object and a newline, schema ispace-coverage/1; with a member `run` unless that is
/// null.
std::string coverageJson(const CoverageReport& report, const RunSight* run = nullptr);
/// The report as aligned lines of text.
std::string coverageText(const CoverageReport& report);

}  // namespace ispace
