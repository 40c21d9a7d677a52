// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "coverage/run_coverage.h"

namespace ispace {

class JsonWriter;

/// Writes the metrics of a run as aligned lines of text.
std::string runText(const RunCoverage& run);
/// Writes the member `run` of coverageJson().
void writeRun(JsonWriter& json, const RunCoverage& run);

}  // namespace ispace
