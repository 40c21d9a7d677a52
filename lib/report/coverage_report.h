// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "coverage/run_coverage.h"

namespace ispace {

/// One JSON object and a newline, schema ispace-coverage/1; with a member `run` unless that is
/// null.
std::string coverageJson(const CoverageReport& report, const RunCoverage* run = nullptr);
/// The report as aligned lines of text.
std::string coverageText(const CoverageReport& report);

/// A row of a table in text.
using TextRow = std::vector<std::string>;

/// Columns as wide as their longest cell, two blanks apart; `sides` has an r for those of numbers,
/// whose last letter counts on.
std::string aligned(const std::vector<TextRow>& rows, const std::string& sides);

/// A share with so many decimals: 0.974 is "97.40%" with two.
std::string percentText(double share, int decimals = 2);

}  // namespace ispace
